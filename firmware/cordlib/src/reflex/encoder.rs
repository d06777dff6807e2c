//! S13: an encoder that for 500 ms shows the wrong direction or less than a fifth of the set speed is a fault; latched.

use rvac_units::Tick;

use crate::motion::WheelStatus;
use crate::rules::encoder::{DISAGREEMENT_MS, SET_POINT_MIN_UM_PER_S};
use crate::timing::HoldTimer;

/// Plausibility of one encoder.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EncoderRule {
    disagreement: HoldTimer,
}

impl EncoderRule {
    /// Returns whether the encoder disagrees.
    pub(crate) fn update(&mut self, wheel: WheelStatus, now: Tick) -> bool {
        let set_point = wheel.set_point_um_per_s.unwrap_or(0);
        let along = wheel.speed_um_per_s.saturating_mul(set_point.signum());
        let disagrees = wheel.duty != 0
            && set_point.saturating_abs() >= SET_POINT_MIN_UM_PER_S
            && along < set_point.saturating_abs() / 5;
        self.disagreement.for_at_least(disagrees, now, DISAGREEMENT_MS)
    }
}
