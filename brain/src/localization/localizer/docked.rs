//! What docking tells of the robot's place, and its place of the dock.
//!
//! A dock of which nobody but a person has said where it is tells the robot's place by and large; a robot that is sure of its place
//! tells where the dock is.

use super::estimator::{Estimator, KnownMap};
use super::{Localization, START_SIGMA_M, START_SIGMA_RAD};
use crate::localization::TrackingCheckpoint;
use crate::localization::drift::Drift;
use crate::localization::tracker::CONFIRMATION_BEAMS;
use crate::mapping::{DockPlace, Map};
use crate::model::config::BrainConfig;
use crate::model::geometry::Pose2;

/// How well a pose is known that a person has pointed out, metres and radians.
const ROUGH_SIGMA_M: f64 = 0.3;
const ROUGH_SIGMA_RAD: f64 = 0.4;
/// A pose that is as sure as this may lead others, metres.
const CONFIRMED_M: f64 = 0.15;

impl Localization {
    /// A person says that the robot stands at `pose` in `map`, by eye. Until its sensors have confirmed that it counts as unsure.
    pub fn place_roughly_at(&mut self, pose: Pose2, (map, config): (&Map, &BrainConfig), seed: u64) {
        self.place_at(pose);
        self.start_monte_carlo(map, config, seed);
        if self.estimator.known_map().is_none() {
            self.start_line_slam(config);
        }
        self.begin_roughly_at(pose);
    }

    pub(super) fn begin_roughly_at(&mut self, pose: Pose2) {
        self.put_at(pose);
        self.odometry.calibration.interrupt();
        self.drift = Drift {
            sigma_m: ROUGH_SIGMA_M,
            sigma_rad: ROUGH_SIGMA_RAD,
        };
        if let Some(known) = self.estimator.known_map_mut() {
            known.tracker.place_at(pose, ROUGH_SIGMA_M, ROUGH_SIGMA_RAD);
            known.tracker.require_confirmation(CONFIRMATION_BEAMS);
        }
    }

    /// The dock is known to be elsewhere.
    pub fn put_dock(&mut self, dock: DockPlace) {
        if let Some(known) = self.estimator.known_map_mut() {
            known.reference_map.put_dock(dock);
        }
    }

    /// Whether the pose is so sure that others may be led by it: what the sensors show confirms it, or walls that were followed
    /// from the beginning do.
    #[must_use]
    pub fn is_confirmed(&self) -> bool {
        let is_narrow = self.drift.sigma_m <= CONFIRMED_M;
        is_narrow
            && match &self.estimator {
                Estimator::MonteCarlo(known) => known.tracker.is_confirmed(),
                Estimator::LineSlam(_) => true,
                Estimator::Odometry => false,
            }
    }

    /// Whether the dock's contacts closed at the last observation: a robot that wakes on its dock has felt nothing yet.
    #[must_use]
    pub fn has_just_docked(&self) -> bool {
        self.has_just_docked
    }

    /// Whether the dock's contacts were closed at the last observation.
    #[must_use]
    pub fn is_docked(&self) -> bool {
        self.was_docked
    }

    /// How a robot that stands on its dock begins to compare with the map that it has made, with what it has learnt of its gyro.
    #[must_use]
    pub fn tracking_on_dock(&self) -> TrackingCheckpoint {
        let (gyro_scale, gyro_bias_rad_per_s) = self.odometry.gyro();
        TrackingCheckpoint {
            sigma_m: START_SIGMA_M,
            sigma_rad: START_SIGMA_RAD,
            gyro_scale,
            gyro_bias_rad_per_s,
            ..TrackingCheckpoint::default()
        }
    }

    /// Whether what is seen may be drawn where the robot believes to be. One that was told by eye where it stands must have found
    /// its place first.
    #[must_use]
    pub fn may_draw(&self) -> bool {
        let is_told = |known: &KnownMap| known.tracker.unconfirmed_beams() > 0;
        !self.estimator.known_map().is_some_and(is_told) || self.drift.sigma_m <= CONFIRMED_M
    }
}
