//! Stopping before what is seen ahead instead of running into it.
//!
//! The way leads to where the map shows nothing; the sensors see it first. Dark things reflect little and look farther away than they
//! are: a robot that touches what it saw farther ahead stops earlier for a while, since walls of one home mostly look alike.

use crate::model::advance::Advance;
use crate::navigation::caution::Ahead;

/// Nearer than this to something that looks like a wall it stops, metres: what stands there is swept by the way beside it.
const STOP_M: f64 = 0.02;
/// So much earlier it stops after a touch of what it saw farther away, metres.
const DARK_M: f64 = 0.01;
/// Earliest, metres.
const DARK_MAX_M: f64 = 0.03;
/// What looked farther away than this when it was touched is another thing, metres.
const SAME_M: f64 = 0.05;
/// Way on which a step of `DARK_M` is forgotten, metres.
const FORGET_M: f64 = 10.0;

/// Where it stops.
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

    /// Something was touched while this was seen ahead.
    pub(super) fn touched(&mut self, ahead: Option<Ahead>) {
        if ahead.is_some_and(|ahead| ahead.clear_m < SAME_M) {
            self.dark_m = (self.dark_m + DARK_M).min(DARK_MAX_M);
        }
    }

    /// Whether the robot stands before this now.
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
    fn what_was_touched_too_early_is_stopped_for_earlier_and_forgotten_on_the_way() {
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
    fn a_touch_of_what_no_sensor_shows_changes_nothing_and_many_touches_do_not_stop_it_far_away() {
        let mut standoff = Standoff::default();
        standoff.touched(None);
        standoff.touched(Some(at(0.2)));
        assert!(!standoff.is_reached(at(0.021)));
        (0..20).for_each(|_| standoff.touched(Some(at(0.03))));
        assert!(!standoff.is_reached(at(0.06)));
    }
}
