//! The location of the dock: measured by docking, or reported by a person.
//!
//! A person points at the map by eye, so a *reported* location is off by some decimetres. When the robot then docks with a
//! reliable pose, the location is *measured*. The contacts close even when the robot is askew by some degrees, so the measured
//! location is the mean of the first dockings.

use crate::model::geometry::{Pose2, normalize_rad};

/// A report this close to the measured location revokes the earlier report. Metres and radians.
const SAME_M: f64 = 0.01;
const SAME_RAD: f64 = 0.01;
/// After this many measurements the mean no longer changes.
const DOCKINGS_MAX: u8 = 6;

/// The location of the dock, as the pose of a docked robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DockLocation {
    measured: Option<MeasuredDock>,
    reported: Option<Pose2>,
}

/// A dock location from the robot's own dockings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredDock {
    /// Mean pose of the docked robot.
    pub pose: Pose2,
    /// Number of dockings in the mean, from 1.
    pub times: u8,
}

impl DockLocation {
    /// A location that is known for good, for instance because the map begins there.
    #[must_use]
    pub fn converged(pose: Pose2) -> Self {
        Self {
            measured: Some(MeasuredDock {
                pose,
                times: DOCKINGS_MAX,
            }),
            reported: None,
        }
    }

    pub(super) fn from_parts(measured: Option<MeasuredDock>, reported: Option<Pose2>) -> Self {
        Self { measured, reported }
    }

    pub(super) fn measured(self) -> Option<MeasuredDock> {
        self.measured
    }

    pub(super) fn reported(self) -> Option<Pose2> {
        self.reported
    }

    /// Pose of a docked robot, if known. A report overrides an earlier measurement.
    #[must_use]
    pub fn pose(self) -> Option<Pose2> {
        self.reported.or(self.measured.map(|measured| measured.pose))
    }

    /// Whether the location is only a person's report.
    #[must_use]
    pub fn is_reported(self) -> bool {
        self.reported.is_some()
    }

    /// Whether further measurements no longer improve the location.
    #[must_use]
    pub fn is_converged(self) -> bool {
        self.reported.is_none()
            && self
                .measured
                .is_some_and(|measured| measured.times >= DOCKINGS_MAX)
    }

    /// A person reports that the dock is there now. A report of the measured location revokes the earlier report.
    pub(super) fn report(&mut self, pose: Pose2) {
        let is_measured_there = self.measured.is_some_and(|measured| {
            measured.pose.position().distance_m(pose.position()) < SAME_M
                && normalize_rad(measured.pose.heading_rad - pose.heading_rad).abs() < SAME_RAD
        });
        self.reported = (!is_measured_there).then_some(pose);
    }

    /// The robot is docked at `pose`. After a report the mean begins anew.
    pub(super) fn measure(&mut self, pose: Pose2) {
        let measured = match self.measured.filter(|_| !self.is_reported()) {
            None => MeasuredDock { pose, times: 1 },
            Some(before) => before.averaged(pose),
        };
        *self = Self {
            measured: Some(measured),
            reported: None,
        };
    }
}

impl MeasuredDock {
    /// The mean with one more docking.
    fn averaged(self, pose: Pose2) -> Self {
        let times = self.times.saturating_add(1).min(DOCKINGS_MAX);
        Self {
            pose: self.pose.towards(pose, 1.0 / f64::from(times)),
            times,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DOCKINGS_MAX, DockLocation};
    use crate::model::geometry::Pose2;
    use core::f64::consts::PI;

    fn at(x_m: f64) -> Pose2 {
        Pose2 {
            x_m,
            ..Pose2::IDENTITY
        }
    }

    #[test]
    fn a_report_counts_until_the_robot_docks_or_the_report_is_revoked() {
        let mut dock = DockLocation::converged(at(1.0));
        dock.report(at(3.0));
        assert_eq!((dock.pose(), dock.is_reported()), (Some(at(3.0)), true));
        let mut revoked = dock;
        revoked.report(at(1.000_001));
        assert_eq!(revoked, DockLocation::converged(at(1.0)));
        dock.measure(at(3.2));
        assert_eq!((dock.pose(), dock.is_reported()), (Some(at(3.2)), false));
        assert!(!dock.is_converged(), "one docking is not enough");
    }

    #[test]
    fn an_unmeasured_dock_can_be_reported() {
        let mut dock = DockLocation::default();
        assert_eq!(dock.pose(), None);
        dock.report(at(2.0));
        assert_eq!((dock.pose(), dock.is_reported()), (Some(at(2.0)), true));
    }

    #[test]
    fn the_location_is_the_mean_of_the_first_dockings() {
        let mut dock = DockLocation::default();
        for times in 1..=DOCKINGS_MAX {
            assert!(!dock.is_converged());
            let side = if times % 2 == 0 { 1.0 } else { -1.0 };
            dock.measure(Pose2 {
                x_m: 2.0 + 0.02 * side,
                y_m: 0.0,
                // On both sides of the wrap at pi.
                heading_rad: side * (PI - 0.1),
            });
        }
        assert!(dock.is_converged());
        let pose = dock.pose().unwrap();
        assert!((pose.x_m - 2.0).abs() < 1e-9, "{pose:?}");
        assert!(pose.heading_rad.abs() > PI - 0.01, "{pose:?}");
    }
}
