//! The parts of lines, outputs and calibrations that a person can set: from and to text.

use mixer::{Calibration, Line, Mix, Name, Output};

use super::FieldError;
use crate::decimal::read_decimal;

/// A setting of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LinePart {
    /// Its name.
    Name,
    /// The input.
    Input,
    /// Turned round.
    Invert,
    /// Factor.
    Weight,
    /// Added.
    Offset,
    /// Bend.
    Expo,
    /// Points.
    Curve,
    /// How it joins.
    Mix,
    /// Its switch.
    When,
    /// The flight modes in which it counts.
    Modes,
    /// Delay.
    DelayMs,
    /// Rise a second.
    SlowUp,
    /// Fall a second.
    SlowDown,
}

/// A setting of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum OutputPart {
    /// Lower limit.
    Low,
    /// Value at rest.
    Centre,
    /// Upper limit.
    High,
    /// Value after a loss.
    Failsafe,
    /// Turned round.
    Reverse,
}

/// A setting of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum InputPart {
    /// Which input.
    Input,
    /// Reading at the lower end.
    Low,
    /// Reading at rest.
    Centre,
    /// Reading at the upper end.
    High,
    /// Share that counts as rest.
    DeadBand,
}

impl LinePart {
    /// All, in the order of the form.
    pub const ALL: [Self; 13] = [
        Self::Name,
        Self::Input,
        Self::Invert,
        Self::Weight,
        Self::Offset,
        Self::Expo,
        Self::Curve,
        Self::Mix,
        Self::When,
        Self::Modes,
        Self::DelayMs,
        Self::SlowUp,
        Self::SlowDown,
    ];

    pub(super) fn text(self, line: &Line) -> String {
        match self {
            Self::Name => line.name.to_string(),
            Self::Input => line.input.to_string(),
            Self::Invert => line.invert.to_string(),
            Self::Weight => line.weight.to_string(),
            Self::Offset => line.offset.to_string(),
            Self::Expo => line.expo.to_string(),
            Self::Curve => points_text(&line.curve),
            Self::Mix => mix_text(line.mix).to_owned(),
            Self::When => line.when.as_ref().map(Name::to_string).unwrap_or_default(),
            Self::Modes => names_text(&line.modes.iter().collect::<Vec<_>>()),
            Self::DelayMs => line.delay_ms.to_string(),
            Self::SlowUp => line.slow_up_per_s.to_string(),
            Self::SlowDown => line.slow_down_per_s.to_string(),
        }
    }

    pub(super) fn set(self, line: &mut Line, text: &str) -> Result<(), FieldError> {
        match self {
            Self::Name => line.name = name(text)?,
            Self::Input => line.input = text.parse().map_err(FieldError::Source)?,
            Self::Invert => line.invert = text == "true",
            Self::Weight => line.weight = number(text),
            Self::Offset => line.offset = number(text),
            Self::Expo => line.expo = number(text),
            Self::Curve => line.curve = points(text)?,
            Self::Mix => line.mix = mix(text),
            Self::When => {
                line.when = if text.is_empty() { None } else { Some(name(text)?) };
            }
            Self::Modes => line.modes = names(text)?,
            Self::DelayMs => line.delay_ms = milliseconds(text)?,
            Self::SlowUp => line.slow_up_per_s = number(text),
            Self::SlowDown => line.slow_down_per_s = number(text),
        }
        Ok(())
    }
}

impl OutputPart {
    /// All, in the order of the form.
    pub const ALL: [Self; 5] = [Self::Low, Self::Centre, Self::High, Self::Failsafe, Self::Reverse];

    pub(super) fn text(self, output: &Output) -> String {
        match self {
            Self::Low => output.low.to_string(),
            Self::Centre => output.centre.to_string(),
            Self::High => output.high.to_string(),
            Self::Failsafe => output.failsafe.to_string(),
            Self::Reverse => output.reverse.to_string(),
        }
    }

    pub(super) fn set(self, output: &mut Output, text: &str) {
        match self {
            Self::Low => output.low = number(text),
            Self::Centre => output.centre = number(text),
            Self::High => output.high = number(text),
            Self::Failsafe => output.failsafe = number(text),
            Self::Reverse => output.reverse = text == "true",
        }
    }
}

impl InputPart {
    /// All, in the order of the form.
    pub const ALL: [Self; 5] = [Self::Input, Self::Low, Self::Centre, Self::High, Self::DeadBand];

    pub(super) fn text(self, calibration: &Calibration) -> String {
        match self {
            Self::Input => calibration.input.to_string(),
            Self::Low => calibration.low.to_string(),
            Self::Centre => calibration.centre.to_string(),
            Self::High => calibration.high.to_string(),
            Self::DeadBand => calibration.dead_band.to_string(),
        }
    }

    pub(super) fn set(self, calibration: &mut Calibration, text: &str) -> Result<(), FieldError> {
        match self {
            Self::Input => calibration.input = text.parse().map_err(FieldError::Source)?,
            Self::Low => calibration.low = number(text),
            Self::Centre => calibration.centre = number(text),
            Self::High => calibration.high = number(text),
            Self::DeadBand => calibration.dead_band = number(text),
        }
        Ok(())
    }
}

pub(super) fn name(text: &str) -> Result<Name, FieldError> {
    Name::new(text.trim()).map_err(FieldError::Name)
}

/// Names with commas between.
pub(super) fn names(text: &str) -> Result<Vec<Name>, FieldError> {
    let texts = text.split(',').map(str::trim).filter(|text| !text.is_empty());
    texts.map(name).collect()
}

pub(super) fn names_text(names: &[&Name]) -> String {
    let names: Vec<&str> = names.iter().map(|name| name.as_str()).collect();
    names.join(", ")
}

/// What is no number becomes one that the mixer refuses, with its own sentence.
pub(super) fn number(text: &str) -> f64 {
    read_decimal(&text.trim().replace(',', ".")).unwrap_or(f64::NAN)
}

pub(super) fn milliseconds(text: &str) -> Result<u16, FieldError> {
    let whole = text.trim().parse();
    whole.map_err(|_| FieldError::Milliseconds(text.to_owned()))
}

const fn mix_text(mix: Mix) -> &'static str {
    match mix {
        Mix::Add => "add",
        Mix::Multiply => "multiply",
        Mix::Replace => "replace",
    }
}

fn mix(text: &str) -> Mix {
    match text {
        "multiply" => Mix::Multiply,
        "replace" => Mix::Replace,
        _ => Mix::Add,
    }
}

fn points_text(points: &[[f64; 2]]) -> String {
    let points: Vec<String> = points.iter().map(|[at, value]| format!("{at} {value}")).collect();
    points.join(", ")
}

/// Points as `-1 -1, 0 0.2, 1 1`.
fn points(text: &str) -> Result<Vec<[f64; 2]>, FieldError> {
    let pairs = text.split(',').map(str::trim).filter(|pair| !pair.is_empty());
    pairs
        .map(|pair| {
            let numbers: Vec<f64> = pair.split_whitespace().map(number).collect();
            <[f64; 2]>::try_from(numbers).map_err(|_| FieldError::Point(pair.to_owned()))
        })
        .collect()
}
