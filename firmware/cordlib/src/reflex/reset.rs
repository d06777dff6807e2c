//! S4: three resets within 60 s keep the robot from moving; latched. The board counts resets in memory that survives
//! them; once the firmware has run for 60 s the count starts again.

use crate::board::ResetRecord;
use crate::rules::reset::{RESETS_MAX, SOUND_MS};
use crate::timing::Deadline;
use rvac_units::Tick;

/// Recent resets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResetRule {
    young: Deadline,
}

impl ResetRule {
    /// Reads the record; returns the rule and whether the resets form a loop.
    pub(crate) fn new<R: ResetRecord>(record: &mut R, now: Tick) -> (Self, bool) {
        let young = Deadline::at(now.after(SOUND_MS));
        (Self { young }, record.recent() >= RESETS_MAX)
    }

    /// Clears the record when the firmware has run long enough.
    pub(crate) fn update<R: ResetRecord>(&mut self, record: &mut R, now: Tick) {
        if self.young.has_come(now) {
            record.forget_recent();
        }
    }

    /// Whether the firmware has not yet run long enough to end the loop.
    pub(crate) const fn is_young(&self) -> bool {
        self.young.is_running()
    }
}
