//! Checks motors against the true state of the pack (S16, S17).

use crate::causes::{Drives, stand};
use crate::charging::Charging;

/// 0.9 and 1.0 V a cell of twelve, less what a divider of 1 % and a converter with four counts of gain error and two of offset
/// do not see.
const EMPTY_MV: i32 = 10_800 - READING_MV;
const WEAK_MV: i32 = 12_000 - READING_MV;
const READING_MV: i32 = 230;
/// Tenths of a degree.
const HOT_DC: i32 = 550;

/// Milliseconds for which motors were driven although the pack does not allow it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PackTimes {
    pub(crate) empty_ms: u32,
    pub(crate) weak_ms: u32,
    pub(crate) hot_ms: u32,
}

impl PackTimes {
    /// Takes the next millisecond.
    pub(crate) fn update(&mut self, pack: &Charging, drives: &Drives) {
        let runs = !drives.is_off();
        // Nothing can be asked of a robot that does not measure its pack; its board leaves the voltage at 0.
        let is_measured = pack.pack_mv > 0;
        stand(&mut self.empty_ms, runs && is_measured && pack.pack_mv < EMPTY_MV);
        stand(
            &mut self.weak_ms,
            drives.cleaners_on() && is_measured && pack.pack_mv < WEAK_MV,
        );
        stand(&mut self.hot_ms, runs && pack.temperature_dc > HOT_DC);
    }
}
