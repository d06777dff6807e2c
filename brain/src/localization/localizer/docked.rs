//! What docking tells about the robot's pose, and the pose about the dock.
//!
//! A dock whose position only a person has given tells the robot's pose roughly. A robot that is sure of its pose tells where the
//! dock is.

use super::Localization;
use super::estimator::{Estimator, KnownMap};
use super::parameters::PLACING;
use crate::localization::TrackingCheckpoint;
use crate::localization::drift::Drift;
use crate::localization::tracker::CONFIRMATION_BEAMS;
use crate::mapping::{DockLocation, PlaceTrust};
use crate::model::geometry::Pose2;

impl Localization {
    /// A person says that the robot is at `pose`, by eye. The pose counts as unsure until the sensors have confirmed it.
    pub fn place_roughly_at(&mut self, pose: Pose2) {
        self.set_pose(pose);
        self.odometry.calibration.interrupt();
        self.drift = Drift {
            sigma_m: PLACING.person_sigma_m,
            sigma_rad: PLACING.person_sigma_rad,
        };
        if let Some(known) = self.estimator.known_map_mut() {
            known
                .tracker
                .place_at(pose, PLACING.person_sigma_m, PLACING.person_sigma_rad);
            known.tracker.require_confirmation(CONFIRMATION_BEAMS);
        }
    }

    /// The dock has another position.
    pub fn put_dock(&mut self, dock: DockLocation) {
        if let Some(known) = self.estimator.known_map_mut() {
            known.reference_map.put_dock(dock);
        }
    }

    /// Whether the pose may be used as a reference: the sensors confirm it, or line SLAM has tracked it from the start.
    #[must_use]
    pub fn is_confirmed(&self) -> bool {
        let is_narrow = self.drift.sigma_m <= PLACING.confirmed_sigma_m;
        is_narrow
            && match &self.estimator {
                Estimator::MonteCarlo(known) => known.tracker.is_confirmed(),
                Estimator::LineSlam(_) => true,
                Estimator::Odometry => false,
            }
    }

    /// How sure the robot is of its place in a known home; `None` in another one.
    #[must_use]
    pub(crate) fn place_trust(&self) -> Option<PlaceTrust> {
        let tracker = &self.estimator.known_map()?.tracker;
        let is_sure = !tracker.is_lost()
            && tracker.unconfirmed_beams() == 0
            && tracker.explained() >= PLACING.trusted_explained;
        Some(if is_sure {
            PlaceTrust::Sure
        } else {
            PlaceTrust::Doubtful
        })
    }

    /// Whether the dock's contacts closed at the last observation. A robot that wakes on its dock has not docked.
    #[must_use]
    pub fn has_just_docked(&self) -> bool {
        self.has_just_docked
    }

    /// Whether the dock's contacts were closed at the last observation.
    #[must_use]
    pub fn is_docked(&self) -> bool {
        self.is_docked
    }

    /// How a robot on its dock starts to localize in the map that it has made, with what it has learned of its gyro.
    #[must_use]
    pub fn tracking_on_dock(&self) -> TrackingCheckpoint {
        let (gyro_scale, gyro_bias_rad_per_s) = self.odometry.gyro();
        TrackingCheckpoint {
            sigma_m: PLACING.dock_sigma_m,
            sigma_rad: PLACING.dock_sigma_rad,
            gyro_scale,
            gyro_bias_rad_per_s,
            ..TrackingCheckpoint::default()
        }
    }

    /// Whether the robot may draw what it sees at its estimated pose. After a person has given the pose by eye, the sensors must
    /// confirm it first.
    #[must_use]
    pub fn may_draw(&self) -> bool {
        let is_told = |known: &KnownMap| known.tracker.unconfirmed_beams() > 0;
        if self.has_lost_place() {
            return false;
        }
        !self.estimator.known_map().is_some_and(is_told) || self.drift.sigma_m <= PLACING.confirmed_sigma_m
    }
}
