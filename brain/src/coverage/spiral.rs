//! A widening spiral to the left, for open floor.

use core::f64::consts::TAU;

use crate::model::action::Motion;
use crate::navigation::Situation;

/// Radius of curvature at the start of a spiral and at its end, metres.
const RADIUS_M: (f64, f64) = (0.08, 1.0);
/// Spacing of the turns of a spiral, as a share of the swath.
const SPACING: f64 = 0.9;
/// Share of the maximum turn rate that a spiral uses.
const TURN_SHARE: f64 = 0.8;

/// A spiral in progress.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spiral {
    turned_rad: f64,
}

impl Spiral {
    /// The next motion; `None` when an obstacle stops it or the spiral is wide enough.
    pub(super) fn step(&mut self, situation: &Situation<'_>) -> Option<Motion> {
        self.turned_rad += situation.advance.turn_rad.max(0.0);
        let config = situation.config;
        let radius_m = RADIUS_M.0 + SPACING * config.body.swath_m * self.turned_rad / TAU;
        if !situation.is_free() || radius_m > RADIUS_M.1 {
            return None;
        }
        let speeds = config.speeds;
        let speed_m_per_s = speeds
            .cruise_m_per_s
            .min(TURN_SHARE * speeds.turn_max_rad_per_s * radius_m);
        Some(Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: speed_m_per_s / radius_m,
        })
    }
}
