//! Stops before obstacles that are seen ahead instead of running into them.
//!
//! The path leads to where the map shows nothing; the sensors see the obstacle first. Dark objects reflect little and
//! appear farther away than they are. After touching an object that appeared farther ahead the robot stops earlier for a
//! while, since the walls of one home are mostly alike.

use crate::model::advance::Advance;
use crate::navigation::caution::Ahead;

/// Distance at which it stops before an apparent wall, metres: the path along the wall sweeps the rest.
const STOP_M: f64 = 0.02;
/// Additional distance after a touch of something that appeared farther away, metres.
const DARK_M: f64 = 0.01;
/// Upper limit of the additional distance, metres.
const DARK_MAX_M: f64 = 0.03;
/// What appeared farther away than this at the touch is a different object, metres.
const SAME_M: f64 = 0.05;
/// Distance after which a step of `DARK_M` is forgotten, metres.
const FORGET_M: f64 = 10.0;

/// The current stopping distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standoff {
    dark_m: f64,
}

impl Standoff {
    /// The robot has moved on.
    pub(super) fn follow(&mut self, advance: Advance) {
        let forgotten_m = DARK_M * advance.distance_m.max(0.0) / FORGET_M;
        self.dark_m = (self.dark_m - forgotten_m).max(0.0);
    }

    /// Records a touch while this was seen ahead.
    pub(super) fn touched(&mut self, ahead: Option<Ahead>) {
        if ahead.is_some_and(|ahead| ahead.clear_m < SAME_M) {
            self.dark_m = (self.dark_m + DARK_M).min(DARK_MAX_M);
        }
    }

    /// Whether the robot must stop before this now.
    pub(super) fn is_reached(self, ahead: Ahead) -> bool {
        ahead.clear_m < STOP_M + self.dark_m
    }
}

#[cfg(test)]
mod tests {
    use super::{FORGET_M, Standoff};
    use crate::model::advance::Advance;
    use crate::model::geometry::Point2;
    use crate::navigation::caution::Ahead;

    fn at(clear_m: f64) -> Ahead {
        Ahead {
            clear_m,
            at: Point2 { x_m: 0.2, y_m: 0.0 },
        }
    }

    #[test]
    fn an_early_touch_makes_it_stop_earlier_for_a_distance() {
        let mut standoff = Standoff::default();
        assert!(standoff.is_reached(at(0.019)) && !standoff.is_reached(at(0.025)));
        standoff.touched(Some(at(0.028)));
        assert!(standoff.is_reached(at(0.025)));
        standoff.follow(Advance {
            distance_m: 2.0 * FORGET_M,
            ..Advance::default()
        });
        assert!(!standoff.is_reached(at(0.025)));
    }

    #[test]
    fn unseen_touches_change_nothing_and_the_additional_distance_is_limited() {
        let mut standoff = Standoff::default();
        standoff.touched(None);
        standoff.touched(Some(at(0.2)));
        assert!(!standoff.is_reached(at(0.021)));
        (0..20).for_each(|_| standoff.touched(Some(at(0.03))));
        assert!(!standoff.is_reached(at(0.06)));
    }
}
