//! The share of its way on which a robot that nobody has carried was lost.
//!
//! Who begins on a dock knows the place. If the robot loses it and does not find it again for most of the job, the map does not show this
//! home: it is mirrored, of another home, or of this one before everything was moved.

use crate::model::advance::Advance;

/// When a map is to blame.
struct LostShareParameters {
    /// Distance driven before that is judged, metres: the search for a place takes four metres and more each time.
    driven_min_m: f64,
    /// Greatest share of the way on which a robot with a right map is lost. With maps of other homes it was 0.83 to 0.97 in seven homes.
    /// In fourteen homes whose chairs, sofa, rug and doors had moved, with people walking about, it was 0.57 at most.
    lost_above: f64,
}

const PARAMETERS: LostShareParameters = LostShareParameters {
    driven_min_m: 80.0,
    lost_above: 0.7,
};

/// How far the robot drove since it was on its dock, and how far of it lost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LostShare {
    since_dock: Option<Way>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Way {
    driven_m: f64,
    lost_m: f64,
}

impl LostShare {
    /// The robot is on its dock.
    pub(super) fn begin(&mut self) {
        self.since_dock.get_or_insert_default();
    }

    /// Somebody has lifted the robot, so it may be lost in the best of maps until it docks.
    pub(super) fn end(&mut self) {
        self.since_dock = None;
    }

    /// Takes a step.
    pub(super) fn follow(&mut self, advance: Advance, is_lost: bool) {
        if let Some(way) = &mut self.since_dock {
            let distance_m = advance.distance_m.abs();
            way.driven_m += distance_m;
            way.lost_m += if is_lost { distance_m } else { 0.0 };
        }
    }

    /// The share, if the map is to blame for it.
    pub(super) fn doubt(&self) -> Option<f64> {
        let Way { driven_m, lost_m } = self.since_dock?;
        let share = lost_m / driven_m.max(1.0);
        (driven_m >= PARAMETERS.driven_min_m && share > PARAMETERS.lost_above).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::LostShare;
    use crate::model::advance::Advance;

    fn ahead(distance_m: f64) -> Advance {
        Advance {
            distance_m,
            ..Advance::default()
        }
    }

    fn from_dock(known_m: f64, lost_m: f64) -> LostShare {
        let mut share = LostShare::default();
        share.begin();
        share.follow(ahead(known_m), false);
        share.follow(ahead(-lost_m), true);
        share
    }

    #[test]
    fn who_is_lost_for_most_of_a_long_way_doubts_the_map() {
        assert_eq!(from_dock(0.0, 79.0).doubt(), None, "not far enough");
        assert_eq!(from_dock(40.0, 60.0).doubt(), None, "as among people");
        assert_eq!(from_dock(20.0, 80.0).doubt(), Some(0.8));
    }

    #[test]
    fn a_dock_on_the_way_changes_nothing_and_who_was_lifted_has_an_excuse() {
        let mut share = from_dock(20.0, 80.0);
        share.begin();
        assert_eq!(share.doubt(), Some(0.8));
        share.end();
        share.follow(ahead(100.0), true);
        assert_eq!(share.doubt(), None);
        share.begin();
        share.follow(ahead(100.0), true);
        assert_eq!(share.doubt(), Some(1.0));
    }
}
