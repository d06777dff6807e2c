//! Joins the estimators to one pose.

mod consistency_monitor;
mod docked;
mod gyro_knowledge;
mod relocalization;

use super::TrackingCheckpoint;
use super::beacons::Beacons;
use super::drift::{Drift, WHEEL_TURN_SCALE};
use super::gyro_belief::GyroBelief;
use super::map_correction::MapCorrection;
use super::odometry::Odometry;
use super::retreat::Retreat;
use super::strengths::Strengths;
use super::survey::{Survey, TurnCounting};
use super::terrain::Terrain;
use super::tracker::{Moved, SENSORS_MIN, Tracker};
use crate::mapping::Map;
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use consistency_monitor::Witness;

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
/// A wheel that hangs for so long hangs because somebody holds the robot, seconds.
const LIFTED_S: f64 = 1.0;

/// A filter and the map that it compares with.
#[derive(Clone, Debug)]
pub(super) struct Tracked {
    pub(super) tracker: Tracker,
    pub(super) terrain: Terrain,
}

/// Pose estimate.
#[derive(Debug)]
pub struct Localization {
    pub(super) odometry: Odometry,
    map_from_odom: Pose2,
    retreat: Retreat,
    drift: Drift,
    pub(super) tracked: Option<Box<Tracked>>,
    pub(super) survey: Option<Box<Survey>>,
    witness: Witness,
    pub(super) beacons: Beacons,
    strengths: Strengths,
    /// When the first observation came.
    began_us: Option<u64>,
    /// When a gyro spoke last.
    gyro_us: Option<u64>,
    was_docked: bool,
    was_off_dock: bool,
    has_just_docked: bool,
    hanging_s: f64,
    learnt_us: u64,
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
            tracked: None,
            survey: None,
            witness: Witness::default(),
            beacons: Beacons::new(),
            strengths: Strengths::default(),
            began_us: None,
            gyro_us: None,
            was_docked: false,
            was_off_dock: false,
            has_just_docked: false,
            hanging_s: 0.0,
            learnt_us: 0,
        }
    }

    /// Takes in an observation and says how far the robot moved since the last one.
    pub fn update(&mut self, observation: &Observation) -> Advance {
        let advance = self.odometry.update(observation);
        if observation.gyro_heading_rad.is_some() {
            self.gyro_us = Some(observation.time_us);
        }
        self.retreat.follow(advance);
        self.drift.grow(advance);
        advance
    }

    /// From now on [`Self::refine`] compares with `map` as it is now, for a robot whose pose is known as well as
    /// [`Self::estimate`] says. Equal seeds give equal poses. What is drawn into the map later is not taken up before the
    /// next call. Nothing happens for a robot without proximity sensors, which could only feel its way, and in a map that
    /// odometry alone has drawn.
    pub fn track(&mut self, map: &Map, config: &BrainConfig, seed: u64) {
        self.tracked = None;
        self.survey = None;
        if config.sensors.proximity.sensors().is_empty() || !Terrain::is_trustworthy(map) {
            return;
        }
        let mut tracker = Tracker::new(config.body.radius_m, config.sensors, seed);
        tracker.place_at(
            self.pose(),
            self.drift.sigma_m.max(START_SIGMA_M),
            self.drift.sigma_rad.max(START_SIGMA_RAD),
        );
        self.follow_in(Terrain::of(map), tracker);
    }

    fn follow_in(&mut self, terrain: Terrain, tracker: Tracker) {
        self.survey = None;
        self.tracked = Some(Box::new(Tracked { tracker, terrain }));
    }

    /// From now on [`Self::refine`] finds out how the walls run in a home of which nothing is known yet, beginning where the
    /// robot stands. Nothing happens for a robot without proximity sensors.
    pub fn survey(&mut self, config: &BrainConfig) {
        let layout = config.sensors.proximity;
        self.tracked = None;
        self.witness = Witness::default();
        self.survey = (!layout.sensors().is_empty())
            .then(|| Box::new(Survey::new(layout, self.pose(), self.odometry.odom_from_base())));
    }

    /// Takes up what has become known of the home since: a tracked robot compares with it, too, and one that was carried away
    /// in the midst of a survey looks for itself in the map that it has made, if that is any good. Says what the map must take
    /// back.
    pub fn learn(&mut self, map: &Map, config: &BrainConfig, time_us: u64) -> Option<MapCorrection> {
        if self.survey.is_some() && self.hanging_s < 0.0 {
            self.hanging_s = 0.0;
            self.recover(map, config, time_us);
            return None;
        }
        if self.survey.is_some() {
            return self.hear_witness(map, config, time_us);
        }
        self.learn_tracked(map, time_us);
        None
    }

    fn learn_tracked(&mut self, map: &Map, time_us: u64) {
        let Some(tracked) = &mut self.tracked else {
            return;
        };
        let Tracked { tracker, terrain } = &mut **tracked;
        let is_due = time_us >= self.learnt_us.saturating_add(LEARN_US);
        if is_due && !tracker.is_lost() && tracker.explained() >= LEARN_EXPLAINED {
            self.learnt_us = time_us;
            terrain.grow(map);
        }
    }

    /// What must survive a restart of a robot that is tracked.
    #[must_use]
    pub fn checkpoint(&self) -> Option<TrackingCheckpoint> {
        let tracked = self.tracked.as_ref()?;
        let (gyro_scale, gyro_bias_rad_per_s) = self.odometry.gyro();
        Some(TrackingCheckpoint {
            sigma_m: self.drift.sigma_m,
            sigma_rad: self.drift.sigma_rad,
            lost: tracked.tracker.is_lost(),
            gyro_scale,
            gyro_bias_rad_per_s,
            unconfirmed_beams: tracked.tracker.unconfirmed_beams(),
        })
    }

    /// Takes up what [`Self::checkpoint`] said before a restart, after [`Self::track`] and at the same pose.
    pub fn resume_tracking(&mut self, before: TrackingCheckpoint) {
        self.odometry
            .resume_gyro(before.gyro_scale, before.gyro_bias_rad_per_s);
        let pose = self.pose();
        self.drift = Drift {
            sigma_m: finite(before.sigma_m, START_SIGMA_M),
            sigma_rad: finite(before.sigma_rad, START_SIGMA_RAD),
        };
        let Some(tracked) = &mut self.tracked else {
            return;
        };
        let Drift { sigma_m, sigma_rad } = self.drift;
        tracked.tracker.place_at(pose, sigma_m, sigma_rad);
        tracked.tracker.doubt_for(before.unconfirmed_beams);
        if before.lost {
            tracked.tracker.lose(pose);
        }
    }

    /// Compares what was perceived with the map, and corrects [`Self::pose`]. Unless [`Self::track`] was asked for there is
    /// no map; then only ranges to beacons count. Says with which poses the map should be drawn again.
    pub fn refine(&mut self, observation: &Observation, advance: Advance) -> Option<MapCorrection> {
        self.strengths.listen(observation, advance);
        self.find_place(observation, advance);
        if self.is_placed() {
            let at = self.pose().position();
            self.strengths.learn(at);
        }
        let keyframes = self.survey.as_mut()?.redraw(observation.time_us)?;
        Some(MapCorrection::Redraw { keyframes })
    }

    /// Whether what is received here may be learnt as that of the place where the robot believes to be.
    fn is_placed(&self) -> bool {
        let is_followed = match &self.tracked {
            Some(tracked) => tracked.tracker.is_settled(),
            None => self.survey.is_some() && self.hanging_s >= 0.0,
        };
        is_followed && self.drift.sigma_m <= HEARD_SIGMA_M
    }

    fn find_place(&mut self, observation: &Observation, advance: Advance) {
        let by_beacons = self.beacons.follow(observation, advance, self.estimate());
        self.leave_hopeless_map(observation.time_us);
        let moved = Moved::of(&self.odometry, advance, self.pose());
        let docks = observation.docked && !self.was_docked;
        self.was_docked = observation.docked;
        self.was_off_dock |= !observation.docked;
        self.has_just_docked = docks && self.was_off_dock;
        let Some(tracked) = &mut self.tracked else {
            if let Some(estimate) = by_beacons {
                return self.adopt(estimate);
            }
            if self.beacons.is_following() {
                return;
            }
            return self.follow_walls(observation, advance);
        };
        let Tracked { tracker, terrain } = &mut **tracked;
        tracker.hear(self.beacons.heard());
        tracker.receive(&self.strengths);
        tracker.search_on(terrain);
        // Where the dock is not known better than the robot knows its own place, that one stays.
        let place = terrain.dock();
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
            && let Some(dock) = terrain.dock().pose()
        {
            self.begin_roughly_at(dock);
        } else if let Some(estimate) = tracker.follow(terrain, observation, moved) {
            let gyro = tracker.gyro();
            self.take_up(estimate, gyro);
        }
    }

    fn follow_walls(&mut self, observation: &Observation, advance: Advance) {
        if observation.wheel_drop {
            self.hanging_s += advance.time_s;
            return;
        }
        // Below zero: it was put down, and nobody has drawn the consequences yet.
        self.hanging_s = if self.hanging_s >= LIFTED_S { -1.0 } else { 0.0 };
        let odom = self.odometry.odom_from_base();
        // Asked of the gyro and not of this advance, which the first one after a start is not of: what was learnt of the gyro
        // before counts from the first step on.
        let turns = if self.has_gyro(observation.time_us) {
            TurnCounting {
                scale: self.odometry.gyro().0,
                scale_sigma: self.odometry.calibration.scale_sigma(),
                bias_sigma_rad_per_s: self.odometry.calibration.bias_sigma_rad_per_s(),
            }
        } else {
            TurnCounting {
                scale: 0.0,
                scale_sigma: WHEEL_TURN_SCALE,
                bias_sigma_rad_per_s: 0.0,
            }
        };
        let Some(fix) = self
            .survey
            .as_mut()
            .and_then(|survey| survey.follow(odom, (advance, turns), observation))
        else {
            return;
        };
        if advance.gyro_turn_rad.is_some()
            && let Some((scale, sigma)) = fix.scale
        {
            self.odometry.calibration.know_scale(scale, sigma);
        }
        self.correct(fix.map_from_odom);
        self.drift = Drift {
            sigma_m: fix.sigma_m,
            sigma_rad: fix.sigma_rad,
        };
    }

    /// Whether anything but its wheels tells the robot where it is heading: a gyro, beacons, or a map that it can compare
    /// with. Without, it is lost within minutes, and what it draws is no map.
    #[must_use]
    pub fn knows_heading(&self, now_us: u64) -> bool {
        self.has_gyro(now_us) || self.beacons.is_following() || self.tracked.is_some()
    }

    /// Deviation of the gyro's scale, relative, while the robot surveys a home that it does not know; `None` = it has no gyro,
    /// or compares with a map, which tells the scale by itself.
    pub(crate) fn surveyed_gyro_scale_sigma(&self, now_us: u64) -> Option<f64> {
        let surveys = self.survey.is_some() && self.has_gyro(now_us);
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
            .tracked
            .as_ref()
            .is_some_and(|tracked| tracked.tracker.sensor_count() < SENSORS_MIN);
        let began_us = *self.began_us.get_or_insert(now_us);
        let waited = now_us >= began_us.saturating_add(GYRO_GONE_US);
        if blind && waited && !self.has_gyro(now_us) && !self.beacons.are_heard() {
            self.tracked = None;
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
                .tracked
                .as_ref()
                .is_some_and(|tracked| tracked.tracker.is_lost()),
            odom: self.odometry.odom_from_base(),
        }
    }

    /// How well the map explains what the sensors show, 0..1; `None` without a map to compare with.
    #[must_use]
    pub fn explained(&self) -> Option<f64> {
        self.tracked.as_ref().map(|tracked| tracked.tracker.explained())
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

    /// Takes up what guesses in a map have found, of the gyro, too.
    fn take_up(&mut self, estimate: PoseEstimate, gyro: Option<GyroBelief>) {
        self.adopt(estimate);
        if let Some(gyro) = gyro.filter(|_| !estimate.lost) {
            self.odometry.calibration.know(gyro);
        }
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
        if let Some(survey) = &mut self.survey {
            survey.begin_at(pose, self.odometry.odom_from_base());
        }
        let is_there = before.position().distance_m(pose.position()) < PLACED_M
            && normalize_rad(before.heading_rad - pose.heading_rad).abs() < PLACED_RAD;
        if !is_there {
            self.beacons.place_at(pose);
        }
        if let Some(tracked) = &mut self.tracked
            && !is_there
        {
            tracked.tracker.place_at(pose, START_SIGMA_M, START_SIGMA_RAD);
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
