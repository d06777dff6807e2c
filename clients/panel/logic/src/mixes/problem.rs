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
        let told = &words.mix;
        match self {
            Self::Name(error) => told.no_name.fill([&error.0]),
            Self::Source(error) => source_problem_text(words, error),
            Self::Milliseconds(text) => told.no_time.fill([text]),
            Self::Point(text) => told.no_point.fill([text]),
            Self::OneSwitch(text) => told.one_switch.fill([text]),
            Self::TwoSwitches(text) => told.two_switches.fill([text]),
        }
    }
}

fn source_problem_text(words: &Words, error: &SourceError) -> String {
    let told = &words.mix;
    match error {
        SourceError::Unknown(text) => told.no_input.fill([text]),
        SourceError::Number { text, found, below } => told.number_high.fill([text, found, below]),
        SourceError::Name(error) => told.no_name.fill([&error.0]),
    }
}

/// What the mixer does not take, for people. In English it says it itself.
#[must_use]
pub fn profile_problem_text(words: &Words, error: &ProfileError) -> String {
    if words.language == Language::English {
        return error.to_string();
    }
    let told = &words.mix;
    match error {
        ProfileError::TooLarge { bytes } => told.too_large.fill([bytes, &PROFILE_BYTES_MAX]),
        ProfileError::Syntax { line, column, what } => told.syntax.fill([line, column, what]),
        ProfileError::Version { found } => told.other_version.fill([found, &VERSION]),
        ProfileError::Range {
            place,
            found,
            low,
            high,
        } => told.range.fill([place, found, low, high]),
        ProfileError::Order { place } => told.rising.fill([place]),
        ProfileError::Failsafe { place, found } => told.must_rest.fill([place, found]),
        ProfileError::Slow { place, found } => told.slow.fill([place, found]),
        ProfileError::Curve { place } => told.points.fill([place, &POINTS_MAX]),
        ProfileError::TooMany { place, found, most } => told.too_many.fill([place, found, most]),
        ProfileError::Twice { place } => told.twice.fill([place]),
        ProfileError::NoSwitch { place, name } => told.no_switch.fill([place, name]),
        ProfileError::JoinsNone { place } => told.joins_none.fill([place]),
    }
}
