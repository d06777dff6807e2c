//! A widening spiral to the left, for open floor.

use core::f64::consts::TAU;

use crate::coverage::parameters::SPIRAL;
use crate::model::action::Motion;
use crate::navigation::Situation;

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
        let radius_m = SPIRAL.radius_m.start + SPIRAL.spacing * config.body.swath_m * self.turned_rad / TAU;
        if !situation.is_free() || radius_m > SPIRAL.radius_m.end {
            return None;
        }
        let speeds = config.speeds;
        let speed_m_per_s = speeds
            .cruise_m_per_s
            .min(SPIRAL.turn_share * speeds.turn_max_rad_per_s * radius_m);
        Some(Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: speed_m_per_s / radius_m,
        })
    }
}
