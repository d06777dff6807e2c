//! The parts of trims and flight modes that a person can set: from and to text.

use mixer::{FlightMode, OutputKind, OutputName, Trim, TrimValue};

use super::FieldError;
use super::parts::{milliseconds, name, number};

/// A setting of a trim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TrimPart {
    /// What it trims.
    Output,
    /// The button for more.
    Up,
    /// The button for less.
    Down,
    /// What a press adds.
    Step,
    /// What it begins with.
    Value,
}

/// A setting of a flight mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ModePart {
    /// Its name.
    Name,
    /// Its switch.
    When,
    /// Time to go over into it.
    FadeMs,
    /// Trims of its own.
    Trims,
}

/// What can be trimmed.
pub(super) fn trimmable() -> impl Iterator<Item = OutputName> {
    OutputName::ALL
        .into_iter()
        .filter(|name| name.kind() == OutputKind::Motion)
}

impl TrimPart {
    /// All, in the order of the form.
    pub const ALL: [Self; 5] = [Self::Output, Self::Up, Self::Down, Self::Step, Self::Value];

    pub(super) fn text(self, trim: &Trim) -> String {
        match self {
            Self::Output => trim.output.to_string(),
            Self::Up => trim.up.to_string(),
            Self::Down => trim.down.to_string(),
            Self::Step => trim.step.to_string(),
            Self::Value => trim.value.to_string(),
        }
    }

    pub(super) fn set(self, trim: &mut Trim, text: &str) -> Result<(), FieldError> {
        match self {
            Self::Output => {
                if let Some(output) = trimmable().find(|output| output.name() == text) {
                    trim.output = output;
                }
            }
            Self::Up => trim.up = text.parse().map_err(FieldError::Source)?,
            Self::Down => trim.down = text.parse().map_err(FieldError::Source)?,
            Self::Step => trim.step = number(text),
            Self::Value => trim.value = number(text),
        }
        Ok(())
    }
}

impl ModePart {
    /// All, in the order of the form.
    pub const ALL: [Self; 4] = [Self::Name, Self::When, Self::FadeMs, Self::Trims];

    pub(super) fn text(self, mode: &FlightMode) -> String {
        match self {
            Self::Name => mode.name.to_string(),
            Self::When => mode.when.to_string(),
            Self::FadeMs => mode.fade_ms.to_string(),
            Self::Trims => trims_text(&mode.trims),
        }
    }

    pub(super) fn set(self, mode: &mut FlightMode, text: &str) -> Result<(), FieldError> {
        match self {
            Self::Name => mode.name = name(text)?,
            Self::When => mode.when = name(text)?,
            Self::FadeMs => mode.fade_ms = milliseconds(text)?,
            Self::Trims => mode.trims = trims(text)?,
        }
        Ok(())
    }
}

fn trims_text(trims: &[TrimValue]) -> String {
    let texts: Vec<String> = trims
        .iter()
        .map(|trim| format!("{} {}", trim.output, trim.value))
        .collect();
    texts.join(", ")
}

/// Values as `turn 0.05, forward 0`.
fn trims(text: &str) -> Result<Vec<TrimValue>, FieldError> {
    let pairs = text.split(',').map(str::trim).filter(|pair| !pair.is_empty());
    pairs
        .map(|pair| {
            let words: Vec<&str> = pair.split_whitespace().collect();
            let output = words
                .first()
                .and_then(|word| trimmable().find(|output| output.name() == *word));
            match (output, words.as_slice()) {
                (Some(output), [_, value]) => Ok(TrimValue {
                    output,
                    value: number(value),
                }),
                _ => Err(FieldError::Trim(pair.to_owned())),
            }
        })
        .collect()
}
