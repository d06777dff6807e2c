//! What a person sees and is asked.

use calibration_values::Item;

use crate::error::CalibrationError;
use crate::procedure::{Danger, Side};

/// Where it is shown: a terminal or a page.
pub trait Screen {
    /// Shows it.
    ///
    /// # Errors
    /// Nobody sees it any more.
    fn show(&mut self, shown: Shown<'_>) -> Result<(), CalibrationError>;
}

/// What is shown. Those that say so wait for a line among the robot's events.
#[derive(Clone, Copy, Debug)]
pub enum Shown<'a> {
    /// The next value.
    Value {
        /// Its number among those that are measured, from 1.
        number: usize,
        /// How many those are.
        of: usize,
        /// The value.
        item: &'a Item,
        /// What the file holds of it.
        kept: Option<i64>,
    },
    /// It is not measured, because another one makes it needless.
    NotNeeded,
    /// Waits: whether the person is ready. Empty = yes, `s` = skip, `q` = end.
    Ready(Option<Danger>),
    /// Waits until the person has done it.
    Do(Task),
    /// Waits for a whole number.
    Ask(Question<'a>),
    /// What was typed is no answer.
    Malformed(&'a str),
    /// Waits until the person holds the robot's motors on.
    HoldOn,
    /// So many readings of so many, and the newest.
    Progress {
        /// Taken.
        done: usize,
        /// Wanted.
        of: usize,
        /// The newest, in counts.
        reading: i64,
    },
    /// What both wheels have counted so far while a person moves them.
    Counts {
        /// Left wheel.
        left: i64,
        /// Right wheel.
        right: i64,
    },
    /// Duty at which motors are tried.
    Duty(i32),
    /// Something worth knowing on the way.
    Note(&'a str),
    /// Waits: whether the value is kept. Empty = yes, `a` = again, `s` = skip, `q` = end.
    Keep {
        /// Of which.
        item: &'a Item,
        /// What was found.
        value: i64,
    },
    /// Waits: whether to try again. Empty or `a` = again, `s` = skip, `q` = end.
    Failed(&'a CalibrationError),
    /// The value is in the file.
    Kept {
        /// Of which.
        item: &'a Item,
        /// What was found.
        value: i64,
    },
}

/// What a person does with the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Push it along a measure.
    Push,
    /// Turn it ten times.
    Spin,
    /// Turn a wheel forward.
    Roll(Side),
    /// Put it on a light floor.
    LightFloor,
    /// Put it on the darkest floor.
    DarkFloor,
    /// Hold it over a drop.
    Drop,
    /// Leave its front free.
    FreeFront,
    /// Hold paper against a sensor.
    Paper {
        /// Which, from the right, from 1.
        number: usize,
        /// Its name.
        sensor: &'static str,
        /// How many there are.
        of: usize,
    },
    /// Hold the left wheel, while an ammeter is read.
    HoldWheelRead,
    /// Hold the left wheel for two seconds.
    HoldWheel,
}

/// What a person reads off and types.
#[derive(Clone, Copy, Debug)]
pub enum Question<'a> {
    /// How far the robot was pushed, mm.
    DistanceMm,
    /// Ammeter at rest, mA.
    AtRestMa,
    /// Ammeter while the wheel pulled, mA.
    PulledMa,
    /// Multimeter, mV.
    PackMv,
    /// Thermometer of the room, tenths of a degree.
    RoomDc,
    /// The value itself.
    Value(&'a Item),
}
