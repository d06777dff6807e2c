//! Values of sensors that see light.

use std::time::Duration;

use crate::arithmetic::{Rises, between, brightest, follows, rises};
use crate::bench::Bench;
use crate::error::CalibrationError;
use crate::screen::{Shown, Task};

/// The light supply of unknown purpose, which the firmware offers as a light after the eight known ones while it is unknown
/// what lights the cliff sensors.
const UNKNOWN_SUPPLY: u8 = 8;
/// Time in which receivers follow the light, and a person's hand gets away.
const SETTLE: Duration = Duration::from_millis(300);
const CLIFFS: [&str; 3] = ["cliff-left", "cliff-middle", "cliff-right"];
/// Proximity sensors in the order of the multiplexer.
const PROXIMITY: [&str; 7] = [
    "right",
    "middle right",
    "front right",
    "front",
    "front left",
    "middle left",
    "left",
];
/// The line of all proximity sensors.
const RECEIVE: &str = "proximity-receive";
/// Readings in which each of seven sensors, dark and lit, is seen about ten times.
const SWEEP: usize = 140;

impl Bench<'_> {
    /// 1 if the cliff sensors see the supply of unknown purpose.
    pub(super) fn cliff_line(&mut self) -> Result<i64, CalibrationError> {
        self.enter(Task::LightFloor)?;
        let dark = self.cliffs(false)?;
        let lit = self.cliffs(true);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        Ok(follows(rises(dark, lit?))?)
    }

    /// Half of the least rise from a drop to the darkest floor.
    pub(super) fn cliff_floor(&mut self) -> Result<i64, CalibrationError> {
        let on = self.needed("cliff-emitter-line")? == 1;
        self.enter(Task::DarkFloor)?;
        let floor = self.cliffs(on)?;
        self.enter(Task::Drop)?;
        let drop = self.cliffs(on);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        let Rises { least, greatest } = rises(drop?, floor);
        let note = format!("the floor stands {least} to {greatest} counts above the drop");
        self.screen.show(Shown::Note(&note))?;
        Ok(between(least)?)
    }

    /// The greatest level over a drop.
    pub(super) fn cliff_drop(&mut self) -> Result<i64, CalibrationError> {
        self.enter(Task::Drop)?;
        let on = self.needed("cliff-emitter-line")? == 1;
        let drop = self.cliffs(on);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        let greatest = rises([0; 3], drop?).greatest;
        Ok(greatest)
    }

    /// The brightest of all sensors with nothing before them.
    pub(super) fn proximity_none(&mut self) -> Result<i64, CalibrationError> {
        self.enter(Task::FreeFront)?;
        Ok(brightest(&self.line(RECEIVE, 2 * SWEEP)?)?)
    }

    /// The dimmest of all sensors with paper at it.
    pub(super) fn proximity_touching(&mut self) -> Result<i64, CalibrationError> {
        let mut least = i64::MAX;
        for (number, name) in PROXIMITY.iter().enumerate() {
            self.enter(Task::Paper {
                number: number + 1,
                sensor: name,
                of: PROXIMITY.len(),
            })?;
            let seen = brightest(&self.line(RECEIVE, SWEEP)?)?;
            self.screen.show(Shown::Note(&format!("{name}: {seen}")))?;
            least = least.min(seen);
        }
        Ok(least)
    }

    /// Levels of the three cliff sensors with the supply of unknown purpose on or off.
    fn cliffs(&mut self, on: bool) -> Result<[i64; 3], CalibrationError> {
        if self.robot.lights() <= UNKNOWN_SUPPLY {
            return Err(CalibrationError::CliffsKnown);
        }
        self.robot.light(UNKNOWN_SUPPLY, on)?;
        self.robot.pass(SETTLE)?;
        self.three(CLIFFS)
    }
}
