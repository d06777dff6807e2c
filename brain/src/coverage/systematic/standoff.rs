//! Stops before obstacles that are seen ahead instead of running into them.
//!
//! The path leads to where the map shows nothing; the sensors see the obstacle first. Dark objects reflect little and
//! appear farther away than they are. After touching an object that appeared farther ahead the robot stops earlier for a
//! while, since the walls of one home are mostly alike.

use super::parameters::STANDOFF;
use crate::model::advance::Advance;
use crate::navigation::caution::Ahead;

/// The current stopping distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standoff {
    dark_m: f64,
}

impl Standoff {
    /// The robot has moved on.
    pub(super) fn follow(&mut self, advance: Advance) {
        let forgotten_m = STANDOFF.dark_step_m * advance.distance_m.max(0.0) / STANDOFF.dark_forget_m;
        self.dark_m = (self.dark_m - forgotten_m).max(0.0);
    }

    /// Records a touch while this was seen ahead.
    pub(super) fn touched(&mut self, ahead: Option<Ahead>) {
        if ahead.is_some_and(|ahead| ahead.clear_m < STANDOFF.same_object_m) {
            self.dark_m = (self.dark_m + STANDOFF.dark_step_m).min(STANDOFF.dark_max_m);
        }
    }

    /// Whether the robot must stop before this now.
    pub(super) fn is_reached(self, ahead: Ahead) -> bool {
        ahead.clear_m < STANDOFF.stop_m + self.dark_m
    }
}

#[cfg(test)]
mod tests {
    use super::{STANDOFF, Standoff};
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
            distance_m: 2.0 * STANDOFF.dark_forget_m,
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
