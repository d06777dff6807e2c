//! How long a robot has stood: where a long stand ends, what was learnt of its gyro on the way before is of yesterday.

use crate::model::advance::Advance;

/// After a stand of so long, seconds, its rests have told more of the gyro's bias than was learnt on the way before.
const LONG_STAND_S: f64 = 60.0;

/// The present stand.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standstill {
    stood_s: f64,
}

impl Standstill {
    /// Whether a long stand ends with this advance of a robot that has a gyro.
    pub(super) fn ends_long(&mut self, advance: Advance) -> bool {
        if advance.stands() {
            self.stood_s += advance.time_s;
            return false;
        }
        let stood_s = core::mem::take(&mut self.stood_s);
        stood_s >= LONG_STAND_S && advance.gyro_turn_rad.is_some()
    }
}
