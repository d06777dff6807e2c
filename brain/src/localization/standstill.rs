//! Detects the end of a long standstill, after which the bias that was learned while driving is out of date.

use crate::model::advance::Advance;

/// After a standstill of so long, seconds, zero-velocity updates know the gyro's bias better than the particles do.
const LONG_STAND_S: f64 = 60.0;

/// The present standstill.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standstill {
    stood_s: f64,
}

impl Standstill {
    /// Whether a long standstill ends with this advance of a robot that has a gyro.
    pub(super) fn ends_long(&mut self, advance: Advance) -> bool {
        if advance.is_stationary() {
            self.stood_s += advance.time_s;
            return false;
        }
        let stood_s = core::mem::take(&mut self.stood_s);
        stood_s >= LONG_STAND_S && advance.gyro_turn_rad.is_some()
    }
}
