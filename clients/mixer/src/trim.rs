//! Trims: what a person adds to the centre of an output by a button for more and one for less, while driving.
//!
//! A trim corrects what pulls to one side. Like the centre it counts only while something is held, so it never drives by itself.

use serde::{Deserialize, Serialize};

use crate::left_out::is_zero;
use crate::readings::PRESSED;
use crate::{FlightMode, OutputName, Source};

/// Furthest that a trim goes to either side.
pub const TRIM_MAX: f64 = 0.25;

/// A trim and its two buttons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Trim {
    /// What it trims: an output that moves the robot.
    pub output: OutputName,
    /// Each press adds a step.
    pub up: Source,
    /// Each press takes a step away.
    pub down: Source,
    /// The step, 0.001..=0.1.
    #[serde(default = "usual_step", skip_serializing_if = "is_usual_step")]
    pub step: f64,
    /// What it begins with, within [`TRIM_MAX`].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub value: f64,
}

/// The value of a trim in a flight mode of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct TrimValue {
    /// Of the trim of this output.
    pub output: OutputName,
    /// Within [`TRIM_MAX`].
    pub value: f64,
}

const fn usual_step() -> f64 {
    0.01
}

// Serde wants references.
fn is_usual_step(value: &f64) -> bool {
    *value == usual_step()
}

/// The two buttons of a trim: a press counts once the button was seen free.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TrimButtons {
    up_is_free: bool,
    down_is_free: bool,
}

impl TrimButtons {
    /// Steps that were pressed just now: 1, -1 or none. An absent button was not pressed, and must be seen free again.
    pub(crate) fn rise(&mut self, trim: &Trim, value: impl Fn(&Source) -> Option<f64>) -> f64 {
        let up = rises(&mut self.up_is_free, value(&trim.up));
        let down = rises(&mut self.down_is_free, value(&trim.down));
        f64::from(i8::from(up) - i8::from(down))
    }
}

fn rises(is_free: &mut bool, value: Option<f64>) -> bool {
    let is_pressed = value.is_some_and(|value| value > PRESSED);
    let rises = is_pressed && *is_free;
    *is_free = value.is_some() && !is_pressed;
    rises
}

/// Adds steps to the value of a trim: that of the flight mode, if it has its own, else that of all others.
pub(crate) fn press(trim: &mut Trim, mode: Option<&mut FlightMode>, steps: f64) {
    let own = mode.and_then(|mode| mode.trims.iter_mut().find(|own| own.output == trim.output));
    let value = own.map_or(&mut trim.value, |own| &mut own.value);
    *value = (*value + steps * trim.step).clamp(-TRIM_MAX, TRIM_MAX);
}

/// The value of a trim in a flight mode.
pub(crate) fn value_in(trim: &Trim, mode: Option<&FlightMode>) -> f64 {
    let own = mode.and_then(|mode| mode.trims.iter().find(|own| own.output == trim.output));
    own.map_or(trim.value, |own| own.value)
}
