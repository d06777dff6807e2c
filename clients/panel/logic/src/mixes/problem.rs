//! What can be wrong with a mix, and how it is said.

use mixer::{NameError, POINTS_MAX, PROFILE_BYTES_MAX, ProfileError, SourceError, VERSION};

use crate::words::{Language, Words};

/// Why a text cannot be put into a field.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldError {
    /// It is no name.
    Name(NameError),
    /// It is no input.
    Source(SourceError),
    /// It is no time.
    Milliseconds(String),
    /// Part of it is no point of a curve.
    Point(String),
    /// Part of it is no value of a trim.
    Trim(String),
    /// It does not name one switch.
    OneSwitch(String),
    /// It does not name two switches.
    TwoSwitches(String),
}

/// What is wrong with a mix.
#[derive(Clone, Debug, PartialEq)]
pub enum MixProblem {
    /// A text that is none for its field.
    Field(FieldError),
    /// The mixer does not take it.
    Profile(ProfileError),
}

impl MixProblem {
    /// For people.
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        match self {
            Self::Field(error) => error.text(words),
            Self::Profile(error) => profile_problem_text(words, error),
        }
    }
}

impl FieldError {
    /// For people.
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        let texts = &words.mix;
        match self {
            Self::Name(error) => texts.no_name.fill([&error.0]),
            Self::Source(error) => source_problem_text(words, error),
            Self::Milliseconds(text) => texts.no_time.fill([text]),
            Self::Point(text) => texts.no_point.fill([text]),
            Self::Trim(text) => texts.no_trim_value.fill([text]),
            Self::OneSwitch(text) => texts.one_switch.fill([text]),
            Self::TwoSwitches(text) => texts.two_switches.fill([text]),
        }
    }
}

fn source_problem_text(words: &Words, error: &SourceError) -> String {
    let texts = &words.mix;
    match error {
        SourceError::Unknown(text) => texts.no_input.fill([text]),
        SourceError::Number { text, found, below } => texts.number_high.fill([text, found, below]),
        SourceError::Name(error) => texts.no_name.fill([&error.0]),
    }
}

/// What the mixer does not take, for people. In English it says it itself.
#[must_use]
pub fn profile_problem_text(words: &Words, error: &ProfileError) -> String {
    // What was typed is no number; the mixer would call it NaN.
    if let ProfileError::Range {
        place,
        found,
        low,
        high,
    } = error
        && found.is_nan()
    {
        return words.mix.no_number.fill([place, low, high]);
    }
    if words.language == Language::English {
        return error.to_string();
    }
    let texts = &words.mix;
    match error {
        ProfileError::TooLarge { bytes } => texts.too_large.fill([bytes, &PROFILE_BYTES_MAX]),
        ProfileError::Syntax { line, column, what } => texts.syntax.fill([line, column, what]),
        ProfileError::Version { found } => texts.other_version.fill([found, &VERSION]),
        ProfileError::Range {
            place,
            found,
            low,
            high,
        } => texts.range.fill([place, found, low, high]),
        ProfileError::Order { place } => texts.rising.fill([place]),
        ProfileError::Failsafe { place, found } => texts.must_rest.fill([place, found]),
        ProfileError::Slow { place, found } => texts.slow.fill([place, found]),
        ProfileError::Curve { place } => texts.points.fill([place, &POINTS_MAX]),
        ProfileError::TooMany { place, found, most } => texts.too_many.fill([place, found, most]),
        ProfileError::Twice { place } => texts.twice.fill([place]),
        ProfileError::NoSwitch { place, name } => texts.no_switch.fill([place, name]),
        ProfileError::NoMode { place, name } => texts.no_mode.fill([place, name]),
        ProfileError::NoTrim { place, output } => texts.no_trim.fill([place, output]),
        ProfileError::NotTrimmed { place } => texts.not_trimmed.fill([place]),
        ProfileError::JoinsNone { place } => texts.joins_none.fill([place]),
    }
}
