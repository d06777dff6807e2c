//! Values of sensors that see light.

use std::time::Duration;

use anyhow::bail;

use super::arithmetic::{Rises, between, brightest, follows, rises};
use super::dialog::Dialog;
use super::procedure::Bench;

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
    pub(super) fn cliff_line(&mut self) -> anyhow::Result<i64> {
        Dialog::enter(self.robot, "Put it on a light floor, then press Enter.")?;
        let dark = self.cliffs(false)?;
        let lit = self.cliffs(true);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        Ok(follows(rises(dark, lit?))?)
    }

    /// Half of the least rise from a drop to the darkest floor.
    pub(super) fn cliff_floor(&mut self) -> anyhow::Result<i64> {
        let on = self.needed("cliff-emitter-line")? == 1;
        Dialog::enter(
            self.robot,
            "Put it on the darkest floor you have, then press Enter.",
        )?;
        let floor = self.cliffs(on)?;
        Dialog::enter(
            self.robot,
            "Hold all three sensors over the edge of a table, or lift it to your chest, then press Enter.",
        )?;
        let drop = self.cliffs(on);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        let Rises { least, greatest } = rises(drop?, floor);
        Dialog::say(&format!(
            "  the floor stands {least} to {greatest} counts above the drop"
        ))?;
        Ok(between(least)?)
    }

    /// The greatest level over a drop.
    pub(super) fn cliff_drop(&mut self) -> anyhow::Result<i64> {
        Dialog::enter(
            self.robot,
            "Hold all three sensors over the edge of a table, or lift it to your chest, then press Enter.",
        )?;
        let on = self.needed("cliff-emitter-line")? == 1;
        let drop = self.cliffs(on);
        self.robot.light(UNKNOWN_SUPPLY, false)?;
        let greatest = rises([0; 3], drop?).greatest;
        Ok(greatest)
    }

    /// The brightest of all sensors with nothing before them.
    pub(super) fn proximity_none(&mut self) -> anyhow::Result<i64> {
        Dialog::enter(
            self.robot,
            "Leave a metre free around its front and step back, then press Enter.",
        )?;
        Ok(brightest(&self.line(RECEIVE, 2 * SWEEP)?)?)
    }

    /// The dimmest of all sensors with paper at it.
    pub(super) fn proximity_touching(&mut self) -> anyhow::Result<i64> {
        let mut least = i64::MAX;
        for (number, name) in PROXIMITY.iter().enumerate() {
            let wish = format!(
                "Hold white paper flat against the {name} sensor ({} of {}, from the right), then press Enter.",
                number + 1,
                PROXIMITY.len()
            );
            Dialog::enter(self.robot, &wish)?;
            let seen = brightest(&self.line(RECEIVE, SWEEP)?)?;
            Dialog::say(&format!("  {name}: {seen}"))?;
            least = least.min(seen);
        }
        Ok(least)
    }

    /// Levels of the three cliff sensors with the supply of unknown purpose on or off.
    fn cliffs(&mut self, on: bool) -> anyhow::Result<[i64; 3]> {
        if self.robot.lights() <= UNKNOWN_SUPPLY {
            bail!(
                "this robot already knows its cliff sensors and switches their light itself; to measure again, program it \
                 without a calibration"
            );
        }
        self.robot.light(UNKNOWN_SUPPLY, on)?;
        self.robot.pass(SETTLE)?;
        self.three(CLIFFS)
    }
}
