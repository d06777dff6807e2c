//! Dead reckoning from the dock: where a robot is by odometry alone since it left a dock whose place is known.
//!
//! The particle filter fits its pose to the map, so in a wrong map it ends at a wrong pose or at none, and cannot say that the map is
//! to blame. For the first tens of metres odometry alone says well enough what a map of the home would have to show.

use super::gyro_estimate::GyroEstimate;
use crate::model::advance::Advance;
use crate::model::geometry::{Pose2, normalize_rad};

/// How far dead reckoning is believed.
struct Reach {
    /// Distance since the dock, metres. In fourteen simulated homes the mean error was 0.04 to 0.19 m up to here, and up to 0.37 m from
    /// here to 40 m, where it made two right maps of homes in which people live look wrong.
    distance_m: f64,
    /// Standard deviation that the gyro's errors may give the heading, radians: a patch of the map check at two metres from the dock.
    heading_sigma_rad: f64,
}

const REACH: Reach = Reach {
    distance_m: 20.0,
    heading_sigma_rad: 0.1,
};

/// The pose by odometry alone.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DeadReckoning {
    /// `None` = the robot was not on its dock, was lifted since, or went too far.
    since_dock: Option<WayFromDock>,
}

/// A robot that has left its dock.
#[derive(Clone, Copy, Debug)]
struct WayFromDock {
    pose: Pose2,
    distance_m: f64,
    /// Sum of all turns, radians: those to the left less those to the right.
    turned_rad: f64,
    time_s: f64,
}

impl WayFromDock {
    fn is_within_reach(&self, gyro: GyroEstimate) -> bool {
        let sigma_rad = gyro.scale_sigma * self.turned_rad.abs() + gyro.bias_sigma_rad_per_s * self.time_s;
        self.distance_m <= REACH.distance_m && sigma_rad <= REACH.heading_sigma_rad
    }
}

impl DeadReckoning {
    /// The robot is on its dock.
    pub(super) fn begin_at(&mut self, dock: Pose2) {
        self.since_dock = Some(WayFromDock {
            pose: dock,
            distance_m: 0.0,
            turned_rad: 0.0,
            time_s: 0.0,
        });
    }

    /// The robot is somewhere else than odometry says.
    pub(super) fn end(&mut self) {
        self.since_dock = None;
    }

    /// Takes a step of odometry. The wheels alone do not tell the heading well enough.
    pub(super) fn follow(&mut self, advance: Advance, gyro: GyroEstimate) {
        if advance.is_stationary() {
            return;
        }
        let before = self.since_dock.filter(|_| advance.gyro_turn_rad.is_some());
        self.since_dock = before
            .map(|before| WayFromDock {
                pose: before.pose.after_arc(advance.distance_m, advance.turn_rad),
                distance_m: before.distance_m + advance.distance_m.abs(),
                turned_rad: before.turned_rad + advance.turn_rad,
                time_s: before.time_s + advance.time_s,
            })
            .filter(|way| way.is_within_reach(gyro));
    }

    /// The pose, while odometry alone knows it.
    pub(super) fn pose(&self) -> Option<Pose2> {
        self.since_dock.map(|way| Pose2 {
            heading_rad: normalize_rad(way.pose.heading_rad),
            ..way.pose
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{DeadReckoning, REACH};
    use crate::localization::gyro_estimate::GyroEstimate;
    use crate::model::advance::Advance;
    use crate::model::geometry::Pose2;

    const KNOWN_GYRO: GyroEstimate = GyroEstimate {
        scale: 0.0,
        scale_sigma: 0.002,
        bias_rad_per_s: 0.0,
        bias_sigma_rad_per_s: 1e-5,
    };

    fn ahead(distance_m: f64) -> Advance {
        Advance {
            time_s: distance_m / 0.25,
            distance_m,
            gyro_turn_rad: Some(0.0),
            ..Advance::default()
        }
    }

    fn turn(turn_rad: f64) -> Advance {
        Advance {
            time_s: turn_rad.abs(),
            turn_rad,
            gyro_turn_rad: Some(turn_rad),
            ..Advance::default()
        }
    }

    fn from_dock() -> DeadReckoning {
        let mut reckoning = DeadReckoning::default();
        reckoning.begin_at(Pose2 {
            x_m: 1.0,
            y_m: 2.0,
            heading_rad: core::f64::consts::FRAC_PI_2,
        });
        reckoning
    }

    #[test]
    fn it_goes_on_from_the_dock_and_ends_out_of_reach() {
        let mut reckoning = from_dock();
        reckoning.follow(ahead(3.0), KNOWN_GYRO);
        let pose = reckoning.pose().unwrap();
        assert!(
            (pose.x_m - 1.0).abs() < 1e-9 && (pose.y_m - 5.0).abs() < 1e-9,
            "{pose:?}"
        );
        reckoning.follow(ahead(REACH.distance_m - 3.0), KNOWN_GYRO);
        assert!(reckoning.pose().is_some());
        reckoning.follow(ahead(0.1), KNOWN_GYRO);
        assert_eq!(reckoning.pose(), None);
        reckoning.follow(ahead(-0.1), KNOWN_GYRO);
        assert_eq!(reckoning.pose(), None, "it does not come back");
    }

    #[test]
    fn a_gyro_that_is_hardly_known_ends_it_early_and_turns_to_both_sides_cancel() {
        let hardly_known = GyroEstimate {
            scale_sigma: 0.008,
            ..KNOWN_GYRO
        };
        let mut reckoning = from_dock();
        for _ in 0..50 {
            reckoning.follow(turn(1.5), hardly_known);
            reckoning.follow(turn(-1.5), hardly_known);
        }
        assert!(reckoning.pose().is_some());
        reckoning.follow(turn(13.0), hardly_known);
        assert_eq!(reckoning.pose(), None);
    }

    #[test]
    fn without_a_gyro_or_a_dock_there_is_none() {
        let mut reckoning = DeadReckoning::default();
        reckoning.follow(ahead(1.0), KNOWN_GYRO);
        assert_eq!(reckoning.pose(), None);
        let mut reckoning = from_dock();
        reckoning.follow(Advance::default(), KNOWN_GYRO);
        assert!(reckoning.pose().is_some(), "it rests");
        let by_wheels = Advance {
            gyro_turn_rad: None,
            ..ahead(1.0)
        };
        reckoning.follow(by_wheels, KNOWN_GYRO);
        assert_eq!(reckoning.pose(), None);
        let mut reckoning = from_dock();
        reckoning.end();
        assert_eq!(reckoning.pose(), None);
    }
}
