//! Combines the estimators to one pose.

mod consistency_monitor;
mod docked;
mod estimator;
mod gyro_knowledge;
mod parameters;
mod relocalization;

use super::TrackingCheckpoint;
use super::beacons::Beacons;
use super::drift::{Drift, ODOMETRY_NOISE};
use super::gyro_monitor::GyroChange;
use super::gyro_presence::GyroPresence;
use super::lift::Lift;
use super::line_slam::{OdometryStep, ScaleEstimate, TurnCalibration};
use super::map_correction::MapCorrection;
use super::odometry::Odometry;
use super::particles::PoseSpread;
use super::reference_map::ReferenceMap;
use super::reverse_budget::ReverseBudget;
use super::rssi_fingerprint::RssiFingerprints;
use super::tracker::MotionUpdate;
use crate::mapping::Map;
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::gyro_fault::GyroFault;
use crate::model::map_doubt::MapDoubt;
use crate::model::observation::Observation;
use crate::model::onsets::{DockOnset, OnsetDetector};
use crate::model::pose_estimate::PoseEstimate;
use estimator::{Estimator, EstimatorKind, KnownMap};
use parameters::PLACING;

/// A gyro that was silent for so long counts as missing, microseconds.
const GYRO_GONE_US: u64 = 10_000_000;

/// Share of the turn that a faulty gyro missed, by which the heading counts as wrong after the wheels have made it good.
const MISSED_TURN_DOUBT: f64 = 0.2;

/// Bounds a standard deviation from outside. NaN becomes the greatest one.
fn finite(sigma: f64, least: f64) -> f64 {
    if sigma.is_finite() {
        sigma.clamp(least, PLACING.sigma_max)
    } else {
        PLACING.sigma_max
    }
}

/// A robot with a larger standard deviation than this does not learn RSSI fingerprints, metres.
const RSSI_SIGMA_M: f64 = 0.3;

/// The reference map takes over new parts this often, microseconds,
const LEARN_US: u64 = 120_000_000;
/// while the map explains at least this share of the sensor readings.
const LEARN_EXPLAINED: f64 = 0.75;
/// The pose estimate.
#[derive(Debug)]
pub struct Localization {
    pub(super) odometry: Odometry,
    onsets: OnsetDetector,
    map_from_odom: Pose2,
    reverse_budget: ReverseBudget,
    drift: Drift,
    pub(super) estimator: Estimator,
    pub(super) beacons: Beacons,
    fingerprints: RssiFingerprints,
    /// Time of the first observation.
    began_us: Option<u64>,
    /// Time of the last gyro reading that counted.
    gyro_us: Option<u64>,
    gyro_presence: GyroPresence,
    is_docked: bool,
    has_just_docked: bool,
    lift: Lift,
    learnt_us: u64,
    beacons_kept_us: u64,
}

impl Localization {
    /// Starts at the origin of the map. The wheels are `track_m` apart and turn at most `rim_max_m_per_s` fast.
    #[must_use]
    pub fn new(track_m: f64, rim_max_m_per_s: f64) -> Self {
        Self {
            odometry: Odometry::new(track_m, rim_max_m_per_s),
            onsets: OnsetDetector::default(),
            map_from_odom: Pose2::IDENTITY,
            reverse_budget: ReverseBudget::default(),
            drift: Drift::default(),
            estimator: Estimator::Odometry,
            beacons: Beacons::new(),
            fingerprints: RssiFingerprints::default(),
            began_us: None,
            gyro_us: None,
            gyro_presence: GyroPresence::default(),
            is_docked: false,
            has_just_docked: false,
            lift: Lift::default(),
            learnt_us: 0,
            beacons_kept_us: 0,
        }
    }

    /// Takes an observation and returns the motion since the last one.
    pub fn update(&mut self, observation: &Observation) -> Advance {
        let advance = Advance {
            onsets: self.onsets.take(observation),
            ..self.odometry.update(observation)
        };
        self.is_docked = observation.docked;
        self.has_just_docked = advance.onsets.docking == Some(DockOnset::Arrived);
        let is_heard = observation.gyro_heading_rad.is_some();
        self.gyro_presence.follow(observation.time_us, is_heard);
        if self.odometry.gyro_fault().is_some() {
            self.gyro_us = None;
        } else if is_heard {
            self.gyro_us = Some(observation.time_us);
        }
        if self.lift.is_lifted() {
            // Who puts it down chooses the floor behind it.
            self.reverse_budget = ReverseBudget::default();
        } else {
            self.reverse_budget.follow(advance);
        }
        self.drift.grow(advance);
        if let Some(GyroChange::Out { missed_rad, .. }) = self.odometry.gyro_change() {
            self.drift.sigma_rad = libm::hypot(self.drift.sigma_rad, MISSED_TURN_DOUBT * missed_rad);
        }
        advance
    }

    /// Uses what has become known of the home since. Monte Carlo localization takes over new parts of the map. A robot that was
    /// carried away during line SLAM relocalizes in the map that it has made, if that is good enough. Returns a correction of the
    /// map.
    pub fn learn(&mut self, map: &Map, config: &BrainConfig, time_us: u64) -> Option<MapCorrection> {
        match &mut self.estimator {
            Estimator::Odometry => None,
            Estimator::LineSlam(_) if self.lift.take_put_down() => {
                self.lose_in_map(ReferenceMap::of(map), config, time_us);
                None
            }
            Estimator::LineSlam(_) => self.check_consistency(map, config, time_us),
            Estimator::MonteCarlo(known) => {
                let is_due = time_us >= self.learnt_us.saturating_add(LEARN_US);
                let tracker = &known.tracker;
                if is_due && !tracker.is_lost() && tracker.explained() >= LEARN_EXPLAINED {
                    self.learnt_us = time_us;
                    known.reference_map.grow(map);
                }
                None
            }
        }
    }

    /// What must survive a restart during Monte Carlo localization.
    #[must_use]
    pub fn checkpoint(&self) -> Option<TrackingCheckpoint> {
        let tracker = &self.estimator.known_map()?.tracker;
        let (gyro_scale, gyro_bias_rad_per_s) = self.odometry.gyro();
        Some(TrackingCheckpoint {
            sigma_m: self.drift.sigma_m,
            sigma_rad: self.drift.sigma_rad,
            lost: tracker.is_lost(),
            gyro_scale,
            gyro_bias_rad_per_s,
            unconfirmed_beams: tracker.unconfirmed_beams(),
        })
    }

    /// Restores [`Self::checkpoint`] after a restart, after [`Self::start_monte_carlo`] and at the same pose.
    pub fn resume_tracking(&mut self, before: TrackingCheckpoint) {
        self.odometry
            .resume_gyro(before.gyro_scale, before.gyro_bias_rad_per_s);
        let pose = self.pose();
        self.drift = Drift {
            sigma_m: finite(before.sigma_m, PLACING.dock_sigma_m),
            sigma_rad: finite(before.sigma_rad, PLACING.dock_sigma_rad),
        };
        let Some(KnownMap { tracker, .. }) = self.estimator.known_map_mut() else {
            return;
        };
        let Drift { sigma_m, sigma_rad } = self.drift;
        tracker.place_at(pose, sigma_m, sigma_rad);
        tracker.require_confirmation(before.unconfirmed_beams);
        if before.lost {
            tracker.lose(pose);
        }
    }

    /// Corrects [`Self::pose`] with the active estimator. Returns the poses with which the map should be redrawn.
    pub fn refine(&mut self, observation: &Observation, advance: Advance) -> Option<MapCorrection> {
        self.fingerprints.listen(observation, advance);
        self.update_pose(observation, advance);
        if self.may_learn_rssi() {
            let at = self.pose().position();
            self.fingerprints.learn(at);
        }
        if self.active_estimator() == EstimatorKind::Beacons {
            let keyframes = self.beacons.redraw(observation.time_us)?;
            return Some(MapCorrection::Redraw { keyframes });
        }
        let first_run = self.estimator.first_run_mut()?;
        let keyframes = first_run.slam.redraw(observation.time_us)?;
        Some(MapCorrection::Redraw { keyframes })
    }

    /// Whether RSSI fingerprints may be learned at the estimated pose.
    fn may_learn_rssi(&self) -> bool {
        let is_followed = match &self.estimator {
            Estimator::MonteCarlo(known) => known.tracker.is_settled(),
            Estimator::LineSlam(_) => !self.lift.is_put_down(),
            Estimator::Odometry => false,
        };
        is_followed && self.drift.sigma_m <= RSSI_SIGMA_M
    }

    fn update_pose(&mut self, observation: &Observation, advance: Advance) {
        let by_beacons = self.beacons.follow(observation, advance, self.prior());
        if self.beacons.has_found_place()
            && let Some(found) = by_beacons
        {
            self.take_place(found);
        }
        self.leave_useless_map(observation.time_us);
        let moved = MotionUpdate::of(&self.odometry, advance, self.pose());
        match (self.active_estimator(), by_beacons) {
            (EstimatorKind::MonteCarlo, _) => self.follow_monte_carlo(observation, moved),
            (_, Some(estimate)) => self.adopt(estimate),
            (EstimatorKind::Beacons, None) => {}
            (EstimatorKind::LineSlam | EstimatorKind::Odometry, None) => {
                self.follow_line_slam(observation, advance);
            }
        }
    }

    fn follow_monte_carlo(&mut self, observation: &Observation, moved: MotionUpdate) {
        let Some(KnownMap {
            tracker,
            reference_map,
        }) = self.estimator.known_map_mut()
        else {
            return;
        };
        let docks = moved.advance.onsets.docking.is_some();
        tracker.add_ranges(self.beacons.located_ranges());
        tracker.receive(&self.fingerprints);
        tracker.step_search(reference_map);
        // The dock corrects the pose only where it is known better than the pose.
        let place = reference_map.dock();
        let is_better = !place.is_reported() && (place.is_converged() || !tracker.is_confirmed());
        if docks
            && is_better
            && let Some(dock) = place.pose()
        {
            tracker.place_on_dock(
                dock,
                PoseSpread {
                    sigma_m: PLACING.dock_sigma_m,
                    sigma_rad: PLACING.dock_sigma_rad,
                },
            );
            self.odometry.calibration.interrupt();
            self.beacons.place_at(dock);
            self.set_pose(dock);
        } else if docks
            && tracker.is_lost()
            && let Some(dock) = place.pose()
        {
            self.place_roughly_at(dock);
        } else if let Some(estimate) = tracker.follow(reference_map, observation, moved) {
            self.adopt_tracked(estimate);
        }
    }

    fn follow_line_slam(&mut self, observation: &Observation, advance: Advance) {
        self.lift.update(observation, advance);
        if observation.wheel_drop {
            return;
        }
        let turns = self.turn_calibration(observation.time_us);
        let step = OdometryStep {
            odom: self.odometry.odom_from_base(),
            advance,
        };
        let Some(first_run) = self.estimator.first_run_mut() else {
            return;
        };
        let Some(fix) = first_run.slam.follow(step, turns, observation) else {
            return;
        };
        if advance.gyro_turn_rad.is_some()
            && let Some(ScaleEstimate { scale, sigma }) = fix.scale
        {
            self.odometry.calibration.set_scale(scale, sigma);
        }
        self.correct(fix.map_from_odom);
        self.drift = Drift {
            sigma_m: fix.sigma_m,
            sigma_rad: fix.sigma_rad,
        };
    }

    /// The calibration of turns. It asks whether there is a gyro and not whether this advance has a turn of it: the first advance
    /// after a start has none, and what was learned of the gyro before counts from the first step on.
    fn turn_calibration(&self, now_us: u64) -> TurnCalibration {
        if !self.has_gyro(now_us) {
            return TurnCalibration {
                scale: 0.0,
                scale_sigma: ODOMETRY_NOISE.wheel_turn_scale,
                bias_sigma_rad_per_s: 0.0,
            };
        }
        TurnCalibration {
            scale: self.odometry.gyro().0,
            scale_sigma: self.odometry.calibration.scale_sigma(),
            bias_sigma_rad_per_s: self.odometry.calibration.bias_sigma_rad_per_s(),
        }
    }

    /// Whether anything besides the wheels determines the heading: a gyro, beacons or a known map. Without, the robot is lost
    /// within minutes and its map is useless.
    #[must_use]
    pub fn knows_heading(&self, now_us: u64) -> bool {
        self.has_gyro(now_us)
            || match self.active_estimator() {
                _ if self.has_lost_place() => false,
                EstimatorKind::Beacons => self.beacons.tell_heading(),
                EstimatorKind::MonteCarlo => true,
                EstimatorKind::LineSlam | EstimatorKind::Odometry => false,
            }
    }

    /// Standard deviation of the gyro's scale, relative, during line SLAM; `None` = no gyro, or a known map that determines the
    /// scale by itself.
    pub(crate) fn slam_gyro_scale_sigma(&self, now_us: u64) -> Option<f64> {
        let is_slam = self.estimator.is_line_slam() && self.has_gyro(now_us);
        is_slam.then(|| self.odometry.calibration.scale_sigma())
    }

    /// Standard deviation of the gyro's bias, rad/s; `None` = no gyro.
    pub(crate) fn gyro_bias_sigma_rad_per_s(&self, now_us: u64) -> Option<f64> {
        self.has_gyro(now_us)
            .then(|| self.odometry.calibration.bias_sigma_rad_per_s())
    }

    /// Why the gyro of a robot that has one does not count in the estimate.
    #[must_use]
    pub fn gyro_fault(&self) -> Option<GyroFault> {
        let silent = self.gyro_presence.is_silent().then_some(GyroFault::Silent);
        self.odometry.gyro_fault().or(silent)
    }

    fn has_gyro(&self, now_us: u64) -> bool {
        self.gyro_us
            .is_some_and(|gyro_us| now_us < gyro_us.saturating_add(GYRO_GONE_US))
    }

    /// A robot with almost no sensors gives up the map when nothing determines its heading.
    fn leave_useless_map(&mut self, now_us: u64) {
        let blind = self
            .estimator
            .known_map()
            .is_some_and(|known| known.tracker.is_blind());
        let began_us = *self.began_us.get_or_insert(now_us);
        let waited = now_us >= began_us.saturating_add(GYRO_GONE_US);
        if blind && waited && !self.has_gyro(now_us) && !self.beacons.are_heard() {
            self.leave_map();
        }
    }

    /// Pose in the map and its uncertainty. A robot with odometry alone is never lost, because it has no map to be lost in.
    #[must_use]
    pub fn estimate(&self) -> PoseEstimate {
        PoseEstimate {
            pose: self.pose(),
            sigma_m: self.drift.sigma_m,
            sigma_rad: self.drift.sigma_rad,
            lost: self.has_lost_place()
                || self
                    .estimator
                    .known_map()
                    .is_some_and(|known| known.tracker.is_lost()),
            odom: self.odometry.odom_from_base(),
        }
    }

    /// As [`Self::estimate`], with the error of the map itself: the particles tell how sure the place in the map is, and the map is not
    /// where the home is.
    pub fn estimate_in_home(&self) -> PoseEstimate {
        let in_map = self.estimate();
        if self.estimator.known_map().is_none() {
            return in_map;
        }
        PoseEstimate {
            sigma_m: libm::hypot(in_map.sigma_m, PLACING.map_sigma_m),
            ..in_map
        }
    }

    /// Share of the sensor readings that the map explains, 0..1; `None` without a known map.
    #[must_use]
    pub fn explained(&self) -> Option<f64> {
        self.estimator.known_map().map(|known| known.tracker.explained())
    }

    /// Why the known map is doubted, with the share that speaks against it; `None` = it is not, or there is none.
    #[must_use]
    pub(crate) fn map_doubt(&self) -> Option<(MapDoubt, f64)> {
        self.estimator.known_map()?.tracker.map_doubt()
    }

    /// Whether much of the known map was met, and nothing made it doubtful.
    pub(crate) fn map_held(&self) -> bool {
        let known = self.estimator.known_map();
        known.is_some_and(|known| known.tracker.has_map_held())
    }

    /// Reversed distance in metres that the robot has not driven forward again, 0..=0.15: no sensor has seen that floor.
    #[must_use]
    pub fn backed_m(&self) -> f64 {
        self.reverse_budget.backed_m()
    }

    /// Distance in metres by which the robot may still reverse before it must drive forward.
    #[must_use]
    pub fn reverse_left_m(&self) -> f64 {
        self.reverse_budget.left_m()
    }

    /// Restores [`Self::backed_m`] after a restart.
    pub fn resume_backed(&mut self, backed_m: f64) {
        self.reverse_budget = ReverseBudget::resumed(backed_m);
    }

    /// Pose in the map.
    #[must_use]
    pub fn pose(&self) -> Pose2 {
        self.map_from_odom * self.odometry.odom_from_base()
    }

    /// Sets the transform that an estimator has found.
    pub fn correct(&mut self, map_from_odom: Pose2) {
        self.map_from_odom = map_from_odom;
    }

    /// Adopts an estimate, and calibrates the gyro with it.
    fn adopt(&mut self, estimate: PoseEstimate) {
        let correction_rad = normalize_rad(estimate.pose.heading_rad - self.pose().heading_rad);
        let found = Drift {
            sigma_m: estimate.sigma_m,
            sigma_rad: estimate.sigma_rad,
        };
        let calibration = &mut self.odometry.calibration;
        if estimate.lost {
            // The estimate of a lost robot jumps, so odometry from the last known pose is as good.
            calibration.interrupt();
        } else {
            calibration.correct(correction_rad, estimate.sigma_rad * estimate.sigma_rad);
            self.set_pose(estimate.pose);
        }
        self.drift = found;
    }

    /// Declares that the robot is at `pose` in the map.
    pub fn place_at(&mut self, pose: Pose2) {
        let before = self.pose();
        self.set_pose(pose);
        let odom = self.odometry.odom_from_base();
        if let Some(first_run) = self.estimator.first_run_mut() {
            first_run.slam.begin_at(pose, odom);
        }
        let is_there = before.position().distance_m(pose.position()) < PLACING.same_m
            && normalize_rad(before.heading_rad - pose.heading_rad).abs() < PLACING.same_rad;
        if !is_there {
            self.beacons.place_at(pose);
        }
        if let Some(known) = self.estimator.known_map_mut()
            && !is_there
        {
            known
                .tracker
                .place_at(pose, PLACING.dock_sigma_m, PLACING.dock_sigma_rad);
        }
    }

    fn set_pose(&mut self, pose: Pose2) {
        self.correct(pose * self.odometry.odom_from_base().inverse());
        self.drift = Drift::default();
    }
}

#[cfg(test)]
mod tests {
    use super::Localization;
    use crate::model::geometry::Pose2;
    use crate::model::observation::Observation;

    #[test]
    fn odometry_continues_from_a_given_pose() {
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
