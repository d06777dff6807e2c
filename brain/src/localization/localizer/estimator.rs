//! The estimators that correct odometry, and the transitions between them.

use super::Localization;
use super::consistency_monitor::ConsistencyMonitor;
use super::parameters::PLACING;
use crate::localization::beacons::{BeaconEvent, PriorEstimate};
use crate::localization::drift::Drift;
use crate::localization::line_slam::LineSlam;
use crate::localization::reference_map::ReferenceMap;
use crate::localization::tracker::Tracker;
use crate::mapping::Map;
use crate::model::config::BrainConfig;
use crate::model::known_beacon::KnownBeacon;
use crate::model::pose_estimate::PoseEstimate;

/// The map takes the places of the beacons this often, microseconds.
const KEEP_BEACONS_US: u64 = 5_000_000;

/// What corrects odometry. Radio beacons run beside it: they correct odometry unless a known map does, and Monte Carlo localization
/// uses their ranges.
#[derive(Debug)]
pub(in crate::localization) enum Estimator {
    /// Nothing does: the robot has no proximity sensors, or its map is not good enough.
    Odometry,
    /// Line SLAM in a home that is not known yet.
    LineSlam(Box<FirstRun>),
    /// Monte Carlo localization in a known map.
    MonteCarlo(Box<KnownMap>),
}

/// The estimator that determines the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EstimatorKind {
    Odometry,
    LineSlam,
    MonteCarlo,
    Beacons,
}

/// Line SLAM and the monitor of its map.
#[derive(Debug)]
pub(in crate::localization) struct FirstRun {
    pub(in crate::localization) slam: LineSlam,
    pub(super) monitor: ConsistencyMonitor,
}

/// The localizer and the map against which it compares.
#[derive(Clone, Debug)]
pub(in crate::localization) struct KnownMap {
    pub(in crate::localization) tracker: Tracker,
    pub(super) reference_map: ReferenceMap,
}

impl Estimator {
    pub(super) fn is_line_slam(&self) -> bool {
        matches!(self, Self::LineSlam(_))
    }

    #[cfg(test)]
    pub(in crate::localization) fn first_run(&self) -> Option<&FirstRun> {
        match self {
            Self::LineSlam(first_run) => Some(first_run),
            Self::Odometry | Self::MonteCarlo(_) => None,
        }
    }

    pub(super) fn first_run_mut(&mut self) -> Option<&mut FirstRun> {
        match self {
            Self::LineSlam(first_run) => Some(first_run),
            Self::Odometry | Self::MonteCarlo(_) => None,
        }
    }

    pub(super) fn known_map(&self) -> Option<&KnownMap> {
        match self {
            Self::MonteCarlo(known) => Some(known),
            Self::Odometry | Self::LineSlam(_) => None,
        }
    }

    pub(in crate::localization) fn known_map_mut(&mut self) -> Option<&mut KnownMap> {
        match self {
            Self::MonteCarlo(known) => Some(known),
            Self::Odometry | Self::LineSlam(_) => None,
        }
    }
}

impl Localization {
    /// The estimator that determines the pose now.
    pub(super) fn active_estimator(&self) -> EstimatorKind {
        match &self.estimator {
            Estimator::MonteCarlo(_) => EstimatorKind::MonteCarlo,
            _ if self.beacons.is_following() => EstimatorKind::Beacons,
            Estimator::LineSlam(_) => EstimatorKind::LineSlam,
            Estimator::Odometry => EstimatorKind::Odometry,
        }
    }

    /// The present estimate, for the beacons.
    pub(super) fn prior(&self) -> PriorEstimate {
        PriorEstimate {
            estimate: self.estimate(),
            is_by_map: self
                .estimator
                .known_map()
                .is_some_and(|known| known.tracker.is_settled()),
        }
    }

    /// Begins with beacons that an earlier run has located, in the frame of the present map.
    pub(crate) fn begin_with_beacons(&mut self, known: &[KnownBeacon]) {
        self.beacons.begin_with(known);
    }

    /// What the beacons have decided since the last call.
    pub(crate) fn take_beacon_events(&mut self) -> Vec<BeaconEvent> {
        self.beacons.take_events()
    }

    /// Whether the robot looks for its place between beacons, and sees too little to know it by a map.
    pub(super) fn has_lost_place(&self) -> bool {
        let sees = self
            .estimator
            .known_map()
            .is_some_and(|known| !known.tracker.is_blind());
        self.beacons.is_searching() && !sees
    }

    /// The place between beacons was found. A robot that sees enough knows its place in its map by itself.
    pub(super) fn take_place(&mut self, found: PoseEstimate) {
        self.odometry.calibration.interrupt();
        let odom = self.odometry.odom_from_base();
        match &mut self.estimator {
            Estimator::LineSlam(first_run) => first_run.slam.begin_at(found.pose, odom),
            Estimator::MonteCarlo(known) if known.tracker.is_blind() || known.tracker.is_lost() => {
                known.tracker.place_at(found.pose, found.sigma_m, found.sigma_rad);
            }
            Estimator::MonteCarlo(_) => return,
            Estimator::Odometry => {}
        }
        self.set_pose(found.pose);
        self.drift = Drift {
            sigma_m: found.sigma_m,
            sigma_rad: found.sigma_rad,
        };
    }

    /// The located beacons as they are worth keeping with the map, now and then.
    pub(crate) fn beacons_to_keep(&mut self, now_us: u64) -> Option<Vec<KnownBeacon>> {
        if now_us < self.beacons_kept_us.saturating_add(KEEP_BEACONS_US) {
            return None;
        }
        self.beacons_kept_us = now_us;
        self.beacons.to_keep(self.estimator.known_map().is_some())
    }

    /// From now on [`Self::refine`] localizes in a copy of `map`, starting from [`Self::estimate`]. Equal seeds give equal poses.
    /// The copy takes over later changes only by [`Self::learn`] or the next call. A robot without proximity sensors continues with
    /// odometry alone, and so does one whose map was drawn by odometry alone.
    pub fn start_monte_carlo(&mut self, map: &Map, config: &BrainConfig, seed: u64) {
        self.estimator = Estimator::Odometry;
        if config.sensors.proximity.sensors().is_empty() || !ReferenceMap::is_trustworthy(map) {
            return;
        }
        let mut tracker = Tracker::new(config.body.radius_m, config.sensors, seed);
        tracker.place_at(
            self.pose(),
            self.drift.sigma_m.max(PLACING.dock_sigma_m),
            self.drift.sigma_rad.max(PLACING.dock_sigma_rad),
        );
        self.compare_with(ReferenceMap::of(map), tracker);
    }

    /// From now on the tracker compares with this map.
    pub(super) fn compare_with(&mut self, reference_map: ReferenceMap, tracker: Tracker) {
        self.estimator = Estimator::MonteCarlo(Box::new(KnownMap {
            tracker,
            reference_map,
        }));
    }

    /// From now on [`Self::refine`] runs line SLAM in a home of which nothing is known yet, starting at the present pose. A robot
    /// without proximity sensors continues with odometry alone.
    pub fn start_line_slam(&mut self, config: &BrainConfig) {
        let layout = config.sensors.proximity;
        self.estimator = if layout.sensors().is_empty() {
            Estimator::Odometry
        } else {
            Estimator::LineSlam(Box::new(FirstRun {
                slam: LineSlam::new(layout, self.pose(), self.odometry.odom_from_base()),
                monitor: ConsistencyMonitor::default(),
            }))
        };
    }

    /// Continues with odometry and beacons alone.
    pub(super) fn leave_map(&mut self) {
        self.estimator = Estimator::Odometry;
    }

    /// Adopts an estimate of the particle filter, and what the filter has learned of the gyro.
    pub(super) fn adopt_tracked(&mut self, estimate: PoseEstimate) {
        let gyro = self.estimator.known_map().and_then(|known| known.tracker.gyro());
        self.adopt(estimate);
        if let Some(gyro) = gyro.filter(|_| !estimate.lost) {
            self.odometry.calibration.set(gyro);
        }
    }
}
