//! One line of an output.

use serde::{Deserialize, Serialize};

use crate::left_out::{is_none_ms, is_zero};
use crate::{Name, Source};

/// How a line joins what the lines before it have made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mix {
    /// Its value is added.
    #[default]
    Add,
    /// What is there is multiplied by its value.
    Multiply,
    /// Its value takes the place of what is there.
    Replace,
}

impl Mix {
    /// The value with which a line changes nothing; a line that replaces is left out instead.
    pub(crate) const fn rest(self) -> f64 {
        match self {
            Self::Add | Self::Replace => 0.0,
            Self::Multiply => 1.0,
        }
    }
}

/// From one input to a part of an output. What is not written has the value that changes nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Line {
    /// For people.
    pub name: Name,
    /// Which input.
    pub input: Source,
    /// Turned round.
    #[serde(default, skip_serializing_if = "is_false")]
    pub invert: bool,
    /// Bend of the curve, -1..=1.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub expo: f64,
    /// Points of a curve after the bend, as pairs of -1..=1; none for a straight line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<[f64; 2]>,
    /// Factor, -2..=2.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub weight: f64,
    /// Added after the factor, -1..=1.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: f64,
    /// How it joins the lines before it.
    #[serde(default, skip_serializing_if = "is_add")]
    pub mix: Mix,
    /// The switch that must be on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when: Option<Name>,
    /// The flight modes in which it counts; all of them when none is named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<Name>,
    /// The input must be away from rest for so long before the line follows it; back to rest it follows at once.
    #[serde(default, skip_serializing_if = "is_none_ms")]
    pub delay_ms: u16,
    /// Most that its value rises in a second; 0 is at once.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub slow_up_per_s: f64,
    /// Most that its value falls in a second; 0 is at once.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub slow_down_per_s: f64,
}

impl Line {
    /// A straight line from an input.
    #[must_use]
    pub const fn new(name: Name, input: Source) -> Self {
        Self {
            name,
            input,
            invert: false,
            expo: 0.0,
            curve: Vec::new(),
            weight: 1.0,
            offset: 0.0,
            mix: Mix::Add,
            when: None,
            modes: Vec::new(),
            delay_ms: 0,
            slow_up_per_s: 0.0,
            slow_down_per_s: 0.0,
        }
    }

    /// Whether somebody switches it on, by a switch or by the one of a flight mode.
    pub(crate) fn is_switched(&self) -> bool {
        self.when.is_some() || !self.modes.is_empty()
    }

    /// Whether it counts in this flight mode; `None` = no mode holds.
    pub(crate) fn counts_in(&self, mode: Option<&Name>) -> bool {
        self.modes.is_empty() || mode.is_some_and(|mode| self.modes.contains(mode))
    }

    /// Whether it is on without anybody doing anything: such a line moves nothing by itself.
    pub(crate) fn is_background(&self) -> bool {
        self.input == Source::Always && !self.is_switched()
    }
}

const fn one() -> f64 {
    1.0
}

// Serde wants references.
fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn is_false(value: &bool) -> bool {
    !*value
}

fn is_add(mix: &Mix) -> bool {
    *mix == Mix::Add
}
