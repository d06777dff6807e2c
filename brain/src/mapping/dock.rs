//! Where the dock stands: where the robot has felt it, and where a person says that it stands since.
//!
//! A person points at a place by eye, so the robot stands on a dock that it was *told* of within some decimetres of it. Once it
//! has docked there with a pose that it may trust, the dock is *felt* there. The contacts close on a robot that stands askew by up
//! to some degrees, so the place is the mean of what was felt the first times.

use crate::model::geometry::{Pose2, normalize_rad};

/// A place that is told nearer than this to the one that was felt is that one: somebody takes back what he said. Metres and
/// radians.
const SAME_M: f64 = 0.01;
const SAME_RAD: f64 = 0.01;
/// After so many times the dock's place does not change any more.
const TIMES_MAX: u8 = 6;

/// Poses of a robot that stands on the dock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DockPlace {
    felt: Option<Felt>,
    told: Option<Pose2>,
}

/// Where the robot has stood on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// The mean of the poses in which it was felt.
    pub pose: Pose2,
    /// How often it was felt there, from 1.
    pub times: u8,
}

impl DockPlace {
    /// Of a dock whose place is known for good, for instance because the map begins there.
    #[must_use]
    pub fn sure(pose: Pose2) -> Self {
        Self {
            felt: Some(Felt {
                pose,
                times: TIMES_MAX,
            }),
            told: None,
        }
    }

    pub(super) fn from_parts(felt: Option<Felt>, told: Option<Pose2>) -> Self {
        Self { felt, told }
    }

    pub(super) fn felt(self) -> Option<Felt> {
        self.felt
    }

    pub(super) fn told(self) -> Option<Pose2> {
        self.told
    }

    /// Pose of a robot that stands on it, as far as that is known.
    #[must_use]
    pub fn pose(self) -> Option<Pose2> {
        self.told.or(self.felt.map(|felt| felt.pose))
    }

    /// Whether nobody but a person says that it stands there.
    #[must_use]
    pub fn is_told(self) -> bool {
        self.told.is_some()
    }

    /// Whether the place does not get any better by being felt once more.
    #[must_use]
    pub fn is_sure(self) -> bool {
        self.told.is_none() && self.felt.is_some_and(|felt| felt.times >= TIMES_MAX)
    }

    /// A person says that it stands there now. Who says the place where it was felt takes back what was told.
    pub(super) fn tell(&mut self, pose: Pose2) {
        let is_felt_there = self.felt.is_some_and(|felt| {
            felt.pose.position().distance_m(pose.position()) < SAME_M
                && normalize_rad(felt.pose.heading_rad - pose.heading_rad).abs() < SAME_RAD
        });
        self.told = (!is_felt_there).then_some(pose);
    }

    /// The robot stands on it there: for the first time where it was told to be, else once more.
    pub(super) fn feel(&mut self, pose: Pose2) {
        let felt = match self.felt.filter(|_| !self.is_told()) {
            None => Felt { pose, times: 1 },
            Some(before) => before.and(pose),
        };
        *self = Self {
            felt: Some(felt),
            told: None,
        };
    }
}

impl Felt {
    /// The mean with another time.
    fn and(self, pose: Pose2) -> Self {
        let times = self.times.saturating_add(1).min(TIMES_MAX);
        Self {
            pose: self.pose.towards(pose, 1.0 / f64::from(times)),
            times,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DockPlace, TIMES_MAX};
    use crate::model::geometry::Pose2;
    use core::f64::consts::PI;

    fn at(x_m: f64) -> Pose2 {
        Pose2 {
            x_m,
            ..Pose2::IDENTITY
        }
    }

    #[test]
    fn what_is_told_counts_until_the_robot_feels_it_or_it_is_taken_back() {
        let mut dock = DockPlace::sure(at(1.0));
        dock.tell(at(3.0));
        assert_eq!((dock.pose(), dock.is_told()), (Some(at(3.0)), true));
        let mut taken_back = dock;
        taken_back.tell(at(1.000_001));
        assert_eq!(taken_back, DockPlace::sure(at(1.0)));
        dock.feel(at(3.2));
        assert_eq!((dock.pose(), dock.is_told()), (Some(at(3.2)), false));
        assert!(!dock.is_sure(), "once is not often");
    }

    #[test]
    fn a_dock_that_was_never_felt_can_be_told() {
        let mut dock = DockPlace::default();
        assert_eq!(dock.pose(), None);
        dock.tell(at(2.0));
        assert_eq!((dock.pose(), dock.is_told()), (Some(at(2.0)), true));
    }

    #[test]
    fn its_place_is_the_mean_of_the_first_times_and_then_stays() {
        let mut dock = DockPlace::default();
        for times in 1..=TIMES_MAX {
            assert!(!dock.is_sure());
            let side = if times % 2 == 0 { 1.0 } else { -1.0 };
            dock.feel(Pose2 {
                x_m: 2.0 + 0.02 * side,
                y_m: 0.0,
                // On both sides of the turn.
                heading_rad: side * (PI - 0.1),
            });
        }
        assert!(dock.is_sure());
        let pose = dock.pose().unwrap();
        assert!((pose.x_m - 2.0).abs() < 1e-9, "{pose:?}");
        assert!(pose.heading_rad.abs() > PI - 0.01, "{pose:?}");
    }
}
