//! S4: three resets within 60 s keep the robot from moving; latched. The board counts resets in memory that survives
//! them; once the firmware has run for 60 s the count starts again.

use crate::board::ResetRecord;
use crate::timing::Until;
use rvac_units::Tick;

const RESETS_MAX: u8 = 3;
const SOUND_MS: u32 = 60_000;

/// Resets of late.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResetRule {
    young: Until,
}

impl ResetRule {
    /// Looks at the record; returns the rule and whether the resets form a loop.
    pub(crate) fn new<R: ResetRecord>(record: &mut R, now: Tick) -> (Self, bool) {
        let young = Until::at(now.after(SOUND_MS));
        (Self { young }, record.recent() >= RESETS_MAX)
    }

    /// Forgets the resets when the firmware has run long enough.
    pub(crate) fn update<R: ResetRecord>(&mut self, record: &mut R, now: Tick) {
        if self.young.has_come(now) {
            record.forget_recent();
        }
    }

    /// Whether the start was too short a time ago to call the loop over.
    pub(crate) const fn is_young(&self) -> bool {
        self.young.is_running()
    }
}
