//! Joins the estimators to one pose.

mod consistency_monitor;
mod docked;
mod estimator;
mod gyro_knowledge;
mod lift;
mod relocalization;

use super::TrackingCheckpoint;
use super::beacons::Beacons;
use super::drift::{Drift, WHEEL_TURN_SCALE};
use super::line_slam::TurnCalibration;
use super::map_correction::MapCorrection;
use super::odometry::Odometry;
use super::reverse_budget::ReverseBudget;
use super::rssi_fingerprint::RssiFingerprints;
use super::tracker::{MotionUpdate, SENSORS_MIN};
use crate::mapping::Map;
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use estimator::{Estimator, EstimatorKind, KnownMap};
use lift::Lift;

/// How well a pose on the dock is known, metres and radians: the dock is wider than the robot's contacts.
const START_SIGMA_M: f64 = 0.02;
const START_SIGMA_RAD: f64 = 0.03;
/// Widest deviation that is taken up, metres and radians.
const SIGMA_MAX: f64 = 1.0;
/// A place nearer than this to the present one is no news for the filter, metres and radians.
const PLACED_M: f64 = 0.05;
const PLACED_RAD: f64 = 0.05;

/// A gyro that was silent for so long is not there, microseconds.
const GYRO_GONE_US: u64 = 10_000_000;

/// A deviation from outside, or at least this one; what is not a number is wide.
fn finite(sigma: f64, least: f64) -> f64 {
    if sigma.is_finite() {
        sigma.clamp(least, SIGMA_MAX)
    } else {
        SIGMA_MAX
    }
}

/// A robot whose place is less sure than this does not learn how strongly beacons are received there, metres.
const HEARD_SIGMA_M: f64 = 0.3;

/// What was unknown is taken into the map that the filter compares with this often, microseconds,
const LEARN_US: u64 = 120_000_000;
/// as long as the map explains so much of what the sensors show.
const LEARN_EXPLAINED: f64 = 0.75;
/// Pose estimate.
#[derive(Debug)]
pub struct Localization {
    pub(super) odometry: Odometry,
    map_from_odom: Pose2,
    reverse_budget: ReverseBudget,
    drift: Drift,
    pub(super) estimator: Estimator,
    pub(super) beacons: Beacons,
    fingerprints: RssiFingerprints,
    /// When the first observation came.
    began_us: Option<u64>,
    /// When a gyro spoke last.
    gyro_us: Option<u64>,
    was_docked: bool,
    was_off_dock: bool,
    has_just_docked: bool,
    lift: Lift,
    learnt_us: u64,
}

impl Localization {
    /// At the origin of the map, for wheels `track_m` apart that turn at most `rim_max_m_per_s` fast.
    #[must_use]
    pub fn new(track_m: f64, rim_max_m_per_s: f64) -> Self {
        Self {
            odometry: Odometry::new(track_m, rim_max_m_per_s),
            map_from_odom: Pose2::IDENTITY,
            reverse_budget: ReverseBudget::default(),
            drift: Drift::default(),
            estimator: Estimator::Odometry,
            beacons: Beacons::new(),
            fingerprints: RssiFingerprints::default(),
            began_us: None,
            gyro_us: None,
            was_docked: false,
            was_off_dock: false,
            has_just_docked: false,
            lift: Lift::default(),
            learnt_us: 0,
        }
    }

    /// Takes in an observation and says how far the robot moved since the last one.
    pub fn update(&mut self, observation: &Observation) -> Advance {
        let advance = self.odometry.update(observation);
        if observation.gyro_heading_rad.is_some() {
            self.gyro_us = Some(observation.time_us);
        }
        self.reverse_budget.follow(advance);
        self.drift.grow(advance);
        advance
    }

    /// Takes up what has become known of the home since: a tracked robot compares with it, too, and one that was carried away
    /// in the midst of a survey looks for itself in the map that it has made, if that is any good. Says what the map must take
    /// back.
    pub fn learn(&mut self, map: &Map, config: &BrainConfig, time_us: u64) -> Option<MapCorrection> {
        match &mut self.estimator {
            Estimator::Odometry => None,
            Estimator::LineSlam(_) if self.lift.take_put_down() => {
                self.relocalize(map, config, time_us);
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

    /// What must survive a restart of a robot that is tracked.
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

    /// Takes up what [`Self::checkpoint`] said before a restart, after [`Self::start_monte_carlo`] and at the same pose.
    pub fn resume_tracking(&mut self, before: TrackingCheckpoint) {
        self.odometry
            .resume_gyro(before.gyro_scale, before.gyro_bias_rad_per_s);
        let pose = self.pose();
        self.drift = Drift {
            sigma_m: finite(before.sigma_m, START_SIGMA_M),
            sigma_rad: finite(before.sigma_rad, START_SIGMA_RAD),
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

    /// Compares what was perceived with the map, and corrects [`Self::pose`]. Unless [`Self::start_monte_carlo`] was asked for there is
    /// no map; then only ranges to beacons count. Says with which poses the map should be drawn again.
    pub fn refine(&mut self, observation: &Observation, advance: Advance) -> Option<MapCorrection> {
        self.fingerprints.listen(observation, advance);
        self.find_place(observation, advance);
        if self.is_placed() {
            let at = self.pose().position();
            self.fingerprints.learn(at);
        }
        let first_run = self.estimator.first_run_mut()?;
        let keyframes = first_run.slam.redraw(observation.time_us)?;
        Some(MapCorrection::Redraw { keyframes })
    }

    /// Whether what is received here may be learnt as that of the place where the robot believes to be.
    fn is_placed(&self) -> bool {
        let is_followed = match &self.estimator {
            Estimator::MonteCarlo(known) => known.tracker.is_settled(),
            Estimator::LineSlam(_) => self.lift != Lift::PutDown,
            Estimator::Odometry => false,
        };
        is_followed && self.drift.sigma_m <= HEARD_SIGMA_M
    }

    fn find_place(&mut self, observation: &Observation, advance: Advance) {
        let by_beacons = self.beacons.follow(observation, advance, self.estimate());
        self.leave_hopeless_map(observation.time_us);
        let moved = MotionUpdate::of(&self.odometry, advance, self.pose());
        let docks = observation.docked && !self.was_docked;
        self.was_docked = observation.docked;
        self.was_off_dock |= !observation.docked;
        self.has_just_docked = docks && self.was_off_dock;
        match (self.active_estimator(), by_beacons) {
            (EstimatorKind::MonteCarlo, _) => self.follow_map(observation, moved, docks),
            (_, Some(estimate)) => self.adopt(estimate),
            (EstimatorKind::Beacons, None) => {}
            (EstimatorKind::LineSlam | EstimatorKind::Odometry, None) => {
                self.follow_walls(observation, advance);
            }
        }
    }

    fn follow_map(&mut self, observation: &Observation, moved: MotionUpdate, docks: bool) {
        let Some(KnownMap {
            tracker,
            reference_map,
        }) = self.estimator.known_map_mut()
        else {
            return;
        };
        tracker.hear(self.beacons.heard());
        tracker.receive(&self.fingerprints);
        tracker.step_search(reference_map);
        // Where the dock is not known better than the robot knows its own place, that one stays.
        let place = reference_map.dock();
        let is_better = !place.is_told() && (place.is_sure() || !tracker.is_confirmed());
        if docks
            && is_better
            && let Some(dock) = place.pose()
        {
            tracker.place_at(dock, START_SIGMA_M, START_SIGMA_RAD);
            self.odometry.calibration.interrupt();
            self.beacons.place_at(dock);
            self.put_at(dock);
        } else if docks
            && tracker.is_lost()
            && let Some(dock) = place.pose()
        {
            self.begin_roughly_at(dock);
        } else if let Some(estimate) = tracker.follow(reference_map, observation, moved) {
            self.adopt_tracked(estimate);
        }
    }

    fn follow_walls(&mut self, observation: &Observation, advance: Advance) {
        self.lift.update(observation, advance);
        if observation.wheel_drop {
            return;
        }
        let turns = self.turn_counting(observation.time_us);
        let odom = self.odometry.odom_from_base();
        let Some(first_run) = self.estimator.first_run_mut() else {
            return;
        };
        let Some(fix) = first_run.slam.follow(odom, (advance, turns), observation) else {
            return;
        };
        if advance.gyro_turn_rad.is_some()
            && let Some((scale, sigma)) = fix.scale
        {
            self.odometry.calibration.set_scale(scale, sigma);
        }
        self.correct(fix.map_from_odom);
        self.drift = Drift {
            sigma_m: fix.sigma_m,
            sigma_rad: fix.sigma_rad,
        };
    }

    /// How turns are counted. It asks whether there is a gyro and not whether this advance has a turn of it: the first advance after a
    /// start has none, and what was learned of the gyro before counts from the first step on.
    fn turn_counting(&self, now_us: u64) -> TurnCalibration {
        if !self.has_gyro(now_us) {
            return TurnCalibration {
                scale: 0.0,
                scale_sigma: WHEEL_TURN_SCALE,
                bias_sigma_rad_per_s: 0.0,
            };
        }
        TurnCalibration {
            scale: self.odometry.gyro().0,
            scale_sigma: self.odometry.calibration.scale_sigma(),
            bias_sigma_rad_per_s: self.odometry.calibration.bias_sigma_rad_per_s(),
        }
    }

    /// Whether anything but its wheels tells the robot where it is heading: a gyro, beacons, or a map that it can compare
    /// with. Without, it is lost within minutes, and what it draws is no map.
    #[must_use]
    pub fn knows_heading(&self, now_us: u64) -> bool {
        self.has_gyro(now_us)
            || matches!(
                self.active_estimator(),
                EstimatorKind::Beacons | EstimatorKind::MonteCarlo
            )
    }

    /// Deviation of the gyro's scale, relative, while the robot surveys a home that it does not know; `None` = it has no gyro,
    /// or compares with a map, which tells the scale by itself.
    pub(crate) fn surveyed_gyro_scale_sigma(&self, now_us: u64) -> Option<f64> {
        let surveys = self.estimator.is_line_slam() && self.has_gyro(now_us);
        surveys.then(|| self.odometry.calibration.scale_sigma())
    }

    /// Deviation of the gyro's bias, rad/s; `None` = it has no gyro.
    pub(crate) fn gyro_bias_sigma_rad_per_s(&self, now_us: u64) -> Option<f64> {
        self.has_gyro(now_us)
            .then(|| self.odometry.calibration.bias_sigma_rad_per_s())
    }

    fn has_gyro(&self, now_us: u64) -> bool {
        self.gyro_us
            .is_some_and(|gyro_us| now_us < gyro_us.saturating_add(GYRO_GONE_US))
    }

    /// A robot with next to no sensors lets go of the map when nothing tells its heading.
    fn leave_hopeless_map(&mut self, now_us: u64) {
        let blind = self
            .estimator
            .known_map()
            .is_some_and(|known| known.tracker.sensor_count() < SENSORS_MIN);
        let began_us = *self.began_us.get_or_insert(now_us);
        let waited = now_us >= began_us.saturating_add(GYRO_GONE_US);
        if blind && waited && !self.has_gyro(now_us) && !self.beacons.are_heard() {
            self.leave_map();
        }
    }

    /// Pose in the map and how sure it is. A robot that only counts its wheels is never lost: it has no map to be lost in.
    #[must_use]
    pub fn estimate(&self) -> PoseEstimate {
        PoseEstimate {
            pose: self.pose(),
            sigma_m: self.drift.sigma_m,
            sigma_rad: self.drift.sigma_rad,
            lost: self
                .estimator
                .known_map()
                .is_some_and(|known| known.tracker.is_lost()),
            odom: self.odometry.odom_from_base(),
        }
    }

    /// How well the map explains what the sensors show, 0..1; `None` without a map to compare with.
    #[must_use]
    pub fn explained(&self) -> Option<f64> {
        self.estimator.known_map().map(|known| known.tracker.explained())
    }

    /// Way back in metres that no way forward has made good, 0..=0.15: ground that nothing has seen.
    #[must_use]
    pub fn backed_m(&self) -> f64 {
        self.reverse_budget.backed_m()
    }

    /// Way in metres for which backing may still be commanded before the robot has driven forward again.
    #[must_use]
    pub fn reverse_left_m(&self) -> f64 {
        self.reverse_budget.left_m()
    }

    /// Takes up what [`Self::backed_m`] said before a restart.
    pub fn resume_backed(&mut self, backed_m: f64) {
        self.reverse_budget = ReverseBudget::resumed(backed_m);
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

    /// Takes up what the filter found; the gyro learns from it.
    fn adopt(&mut self, estimate: PoseEstimate) {
        let correction_rad = normalize_rad(estimate.pose.heading_rad - self.pose().heading_rad);
        let found = Drift {
            sigma_m: estimate.sigma_m,
            sigma_rad: estimate.sigma_rad,
        };
        let calibration = &mut self.odometry.calibration;
        if estimate.lost {
            // Guesses jump about; where odometry has carried the last pose that was believed is as good as any of them.
            calibration.interrupt();
        } else {
            calibration.correct(correction_rad, estimate.sigma_rad * estimate.sigma_rad);
            self.put_at(estimate.pose);
        }
        self.drift = found;
    }

    /// Declares that the robot now stands at `pose` in the map.
    pub fn place_at(&mut self, pose: Pose2) {
        let before = self.pose();
        self.put_at(pose);
        let odom = self.odometry.odom_from_base();
        if let Some(first_run) = self.estimator.first_run_mut() {
            first_run.slam.begin_at(pose, odom);
        }
        let is_there = before.position().distance_m(pose.position()) < PLACED_M
            && normalize_rad(before.heading_rad - pose.heading_rad).abs() < PLACED_RAD;
        if !is_there {
            self.beacons.place_at(pose);
        }
        if let Some(known) = self.estimator.known_map_mut()
            && !is_there
        {
            known.tracker.place_at(pose, START_SIGMA_M, START_SIGMA_RAD);
        }
    }

    fn put_at(&mut self, pose: Pose2) {
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
