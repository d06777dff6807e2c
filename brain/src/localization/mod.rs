//! Where the robot believes to be.
//!
//! Frames follow REP-105: *odom* is smooth and drifts, *map* is right on average and may jump; `pose = map_from_odom *
//! odom_from_base`. Odometry makes the second factor. A better estimator (wall segments, a particle filter, the dock)
//! works on the first one and hands it in through [`Localization::correct`].

mod estimate;
mod gyro_bias;
mod odometry;
mod retreat;

use estimate::Drift;
pub use estimate::PoseEstimate;
pub use odometry::Advance;
use odometry::Odometry;
use retreat::Retreat;

use crate::geometry::Pose2;
use crate::mapping::Map;
use crate::observation::Observation;

/// Pose estimate.
#[derive(Clone, Debug)]
pub struct Localization {
    odometry: Odometry,
    map_from_odom: Pose2,
    retreat: Retreat,
    drift: Drift,
}

impl Localization {
    /// At the origin of the map, for wheels `track_m` apart that turn at most `rim_max_m_per_s` fast.
    #[must_use]
    pub fn new(track_m: f64, rim_max_m_per_s: f64) -> Self {
        Self {
            odometry: Odometry::new(track_m, rim_max_m_per_s),
            map_from_odom: Pose2::IDENTITY,
            retreat: Retreat::default(),
            drift: Drift::default(),
        }
    }

    /// Takes in an observation and says how far the robot moved since the last one.
    pub fn update(&mut self, observation: &Observation) -> Advance {
        let advance = self.odometry.update(observation);
        self.retreat.follow(advance);
        self.drift.grow(advance);
        advance
    }

    /// Compares what was perceived with the map, and corrects [`Self::pose`]. Without a map to compare with it does nothing.
    pub(crate) fn refine(&mut self, _map: &Map, _observation: &Observation, _advance: Advance) {}

    /// Pose in the map and how sure it is. A robot that only counts its wheels is never lost: it has no map to be lost in.
    #[must_use]
    pub fn estimate(&self) -> PoseEstimate {
        PoseEstimate {
            pose: self.pose(),
            sigma_m: self.drift.sigma_m,
            sigma_rad: self.drift.sigma_rad,
            lost: false,
        }
    }

    /// Way back in metres that no way forward has made good, 0..=0.15: ground that nothing has seen.
    #[must_use]
    pub fn backed_m(&self) -> f64 {
        self.retreat.backed_m()
    }

    /// Way in metres for which backing may still be commanded before the robot has driven forward again.
    #[must_use]
    pub fn way_back_m(&self) -> f64 {
        self.retreat.left_m()
    }

    /// Takes up what [`Self::backed_m`] said before a restart.
    pub fn resume_backed(&mut self, backed_m: f64) {
        self.retreat = Retreat::resumed(backed_m);
    }

    /// Pose in the map.
    #[must_use]
    pub fn pose(&self) -> Pose2 {
        self.map_from_odom * self.odometry.odom_from_base()
    }

    /// Sets the transform that a better estimator has found.
    pub fn correct(&mut self, map_from_odom: Pose2) {
        self.map_from_odom = map_from_odom;
    }

    /// Declares that the robot now stands at `pose` in the map.
    pub fn place_at(&mut self, pose: Pose2) {
        self.correct(pose * self.odometry.odom_from_base().inverse());
        self.drift = Drift::default();
    }
}

#[cfg(test)]
mod tests {
    use super::Localization;
    use crate::geometry::Pose2;
    use crate::observation::Observation;

    #[test]
    fn a_placed_robot_goes_on_from_there() {
        let mut localization = Localization::new(0.23, 0.5);
        localization.update(&Observation {
            time_us: 0,
            travel_left_m: 7.0,
            travel_right_m: 7.0,
            ..Observation::default()
        });
        let place = Pose2 {
            x_m: 1.0,
            y_m: 2.0,
            heading_rad: core::f64::consts::FRAC_PI_2,
        };
        localization.place_at(place);
        localization.update(&Observation {
            time_us: 1_000_000,
            travel_left_m: 7.2,
            travel_right_m: 7.2,
            ..Observation::default()
        });
        let pose = localization.pose();
        assert!(
            (pose.y_m - 2.2).abs() < 1e-9 && (pose.x_m - 1.0).abs() < 1e-9,
            "{pose:?}"
        );
    }
}
