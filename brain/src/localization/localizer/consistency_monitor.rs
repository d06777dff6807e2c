//! Checks whether a robot on its first run can be where line SLAM places it.
//!
//! The reference is the robot's own map of a few minutes ago. A wall that is a few centimetres or decimetres off is drift, which
//! line SLAM corrects. Obstacles in the middle of floor that was free, and a body inside what was solid, for metres of driving,
//! mean that the robot is elsewhere: somebody moved it without lifting it, or its wheels turned on something.

use super::{LEARN_US, Localization};
use crate::localization::MapCorrection;
use crate::localization::particles::Surroundings;
use crate::localization::reference_map::ReferenceMap;
use crate::mapping::Map;
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::Point2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// When what the sensors show contradicts the robot's own map.
struct MonitorParameters {
    /// Distance between two checks, metres.
    step_m: f64,
    /// An obstacle in known floor contradicts the map when it is this far from anything solid, metres. Line SLAM may be off by
    /// less.
    elsewhere_m: f64,
    /// The distance grows with the pose's uncertainty by this many standard deviations.
    elsewhere_sigmas: f64,
    /// The floor must be known this far around an obstacle that contradicts the map, metres. A beam may have passed a wall that
    /// the robot later sees from the front: then the floor before the wall is known, the wall and what is behind it are not (this
    /// happened in a first run of home 17).
    surroundings_m: f64,
    /// Number of checks over which the share of contradictions is averaged, without those where nothing is known: two and a half
    /// metres along a wall.
    averaged_checks: f64,
    /// Above this share the robot is elsewhere. In undisturbed first runs of generated homes it stayed below 0.1.
    contradicted_above: f64,
    /// Above this share something is wrong. The present map is no reference, and is rolled back to this moment if the robot turns
    /// out to be elsewhere.
    doubted_above: f64,
    /// The rollback begins this much earlier, microseconds, because not every place shows a contradiction at once.
    rollback_lead_us: u64,
}

const PARAMETERS: MonitorParameters = MonitorParameters {
    step_m: 0.1,
    elsewhere_m: 0.35,
    elsewhere_sigmas: 2.0,
    surroundings_m: 0.15,
    averaged_checks: 25.0,
    contradicted_above: 0.2,
    doubted_above: 0.1,
    rollback_lead_us: 20_000_000,
};

/// An observation, and the motion since the one before.
#[derive(Clone, Copy, Debug)]
struct ObservedStep<'step> {
    observation: &'step Observation,
    advance: Advance,
}

/// The map of a few minutes ago, and the share of recent checks that contradict it.
#[derive(Clone, Debug, Default)]
pub(super) struct ConsistencyMonitor {
    reference_map: Option<Box<ReferenceMap>>,
    updated_us: u64,
    redrawn: u32,
    distance_m: f64,
    contradicted: f64,
    consistent_us: u64,
}

impl ConsistencyMonitor {
    /// Checks what the sensors show at the estimated pose.
    fn observe(&mut self, step: ObservedStep<'_>, estimate: &PoseEstimate, config: &BrainConfig) {
        let ObservedStep { observation, advance } = step;
        self.distance_m += advance.distance_m.abs();
        let touches = advance.onsets.contacts.any();
        let Some(reference_map) = &self.reference_map else {
            return;
        };
        if self.distance_m < PARAMETERS.step_m && !touches {
            return;
        }
        self.distance_m = 0.0;
        let solid = solid_in_base(observation, touches, config);
        let far_m = PARAMETERS.elsewhere_m + PARAMETERS.elsewhere_sigmas * estimate.sigma_m;
        if let Some(contradicted) = contradicted(reference_map, estimate, &solid, far_m) {
            self.contradicted += (contradicted - self.contradicted) / PARAMETERS.averaged_checks;
        }
        if self.contradicted <= PARAMETERS.doubted_above {
            self.consistent_us = observation.time_us;
        }
    }

    /// Takes the present map as the reference, periodically and after each redraw, while nothing contradicts the map. A map in
    /// which the robot could not relocalize is no reference, because the robot would be left with nothing.
    pub(super) fn update_reference(&mut self, map: &Map, time_us: u64) {
        let is_due = time_us >= self.updated_us.saturating_add(LEARN_US) || map.redrawn() != self.redrawn;
        if is_due && self.contradicted <= PARAMETERS.doubted_above {
            (self.updated_us, self.redrawn) = (time_us, map.redrawn());
            self.reference_map = ReferenceMap::is_trustworthy(map).then(|| Box::new(ReferenceMap::of(map)));
        }
    }

    /// The contradicted map, and the time since which the robot drew in the wrong place.
    pub(super) fn take_contradicted(&mut self) -> Option<(Box<ReferenceMap>, u64)> {
        if self.contradicted <= PARAMETERS.contradicted_above {
            return None;
        }
        let since_us = self.consistent_us.saturating_sub(PARAMETERS.rollback_lead_us);
        let reference_map = core::mem::take(self).reference_map?;
        Some((reference_map, since_us))
    }
}

impl Localization {
    /// When the robot's own map contradicts the pose, line SLAM ends. The robot relocalizes in that map, and what it has drawn
    /// since is rolled back.
    pub(super) fn check_consistency(
        &mut self,
        map: &Map,
        config: &BrainConfig,
        time_us: u64,
    ) -> Option<MapCorrection> {
        let first_run = self.estimator.first_run_mut()?;
        let Some((reference_map, since_us)) = first_run.monitor.take_contradicted() else {
            first_run.monitor.update_reference(map, time_us);
            return None;
        };
        let mut keyframes = first_run.slam.keyframes();
        keyframes.retain(|keyframe| keyframe.time_us <= since_us);
        self.lose_in_map(*reference_map, config, time_us);
        Some(MapCorrection::RollBack { since_us, keyframes })
    }

    /// Checks what the sensors show against the map, for a robot on its first run.
    pub(crate) fn check_against_map(
        &mut self,
        observation: &Observation,
        advance: Advance,
        config: &BrainConfig,
    ) {
        let estimate = self.estimate();
        if let Some(first_run) = self.estimator.first_run_mut()
            && !observation.wheel_drop
        {
            let step = ObservedStep { observation, advance };
            first_run.monitor.observe(step, &estimate, config);
        }
    }
}

/// Solid points in the frame of the robot: infrared readings, and the front when the bumper has just closed.
fn solid_in_base(observation: &Observation, touches: bool, config: &BrainConfig) -> Vec<Point2> {
    let layout = &config.sensors.proximity;
    let seen = layout.sensors().iter().zip(&observation.proximity);
    let mut solid: Vec<Point2> = seen
        .filter_map(|(sensor, level)| {
            let seen_m = layout.response.distance_m(f64::from(*level))?;
            Some(sensor.transform(Point2 {
                x_m: seen_m,
                y_m: 0.0,
            }))
        })
        .collect();
    if touches {
        solid.push(Point2 {
            x_m: config.body.radius_m,
            y_m: 0.0,
        });
    }
    solid
}

/// Share of the points that contradict the map, 0..=1; `None` where the map knows nothing.
fn contradicted(
    reference_map: &ReferenceMap,
    estimate: &PoseEstimate,
    solid: &[Point2],
    far_m: f64,
) -> Option<f64> {
    let here = estimate.pose.position();
    if reference_map.is_known(here) && reference_map.clearance_m(here) < -2.0 * estimate.sigma_m {
        return Some(1.0);
    }
    let (mut known, mut contradicted) = (0_u32, 0_u32);
    for at in solid.iter().map(|at| estimate.pose.transform(*at)) {
        if reference_map.is_known(at) {
            known += 1;
            contradicted +=
                u32::from(reference_map.clearance_m(at) > far_m && is_surrounded_by_known(reference_map, at));
        }
    }
    (known > 0).then(|| f64::from(contradicted) / f64::from(known))
}

/// Whether the floor on all sides of this point is known.
fn is_surrounded_by_known(reference_map: &ReferenceMap, at: Point2) -> bool {
    let sides = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    sides.iter().all(|(x, y)| {
        reference_map.is_known(Point2 {
            x_m: at.x_m + PARAMETERS.surroundings_m * x,
            y_m: at.y_m + PARAMETERS.surroundings_m * y,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{ConsistencyMonitor, LEARN_US, ObservedStep, PoseEstimate};
    use crate::localization::known_home::{START, SimulatedRobot, TRACK_M, config, flat};
    use crate::localization::reference_map::ReferenceMap;
    use crate::localization::{Localization, MapCorrection};
    use crate::mapping::{Cell, CellKnowledge, Keyframe, Map, Raster, StoredMap};
    use crate::model::advance::Advance;
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::onsets::OnsetDetector;

    /// Checks of a robot that drives through the flat with a pose that is off by `believed_off`. Returns the greatest share.
    fn contradicted(home: &Map, believed_off: Pose2, steps: u32) -> f64 {
        let mut truth = SimulatedRobot::new(home, START);
        let mut monitor = ConsistencyMonitor::default();
        monitor.update_reference(home, LEARN_US);
        let mut onsets = OnsetDetector::default();
        let mut greatest: f64 = 0.0;
        for _ in 0..steps {
            let before = truth.pose;
            let view = truth.step().clone();
            let begins = onsets.take(&view);
            let estimate = PoseEstimate {
                pose: believed_off * truth.pose,
                sigma_m: 0.05,
                ..PoseEstimate::default()
            };
            let advance = Advance {
                distance_m: before.position().distance_m(truth.pose.position()),
                onsets: begins,
                ..Advance::default()
            };
            let step = ObservedStep {
                observation: &view,
                advance,
            };
            monitor.observe(step, &estimate, &config());
            greatest = greatest.max(monitor.contradicted);
        }
        greatest
    }

    #[test]
    fn a_wall_at_the_border_of_known_space_is_no_contradiction() {
        let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, 160, 160, CellKnowledge::Unknown);
        for index in 0..80 * 160 {
            knowledge.values_mut()[index] = CellKnowledge::Free;
        }
        let mut map = Map::new(config().body, config().sensors);
        map.load(&StoredMap::from_raster(&knowledge, None));
        let reference_map = ReferenceMap::of(&map);
        let below = |solid_m: f64| {
            let estimate = PoseEstimate {
                pose: Pose2 {
                    x_m: 2.0,
                    y_m: solid_m - 0.2,
                    heading_rad: core::f64::consts::FRAC_PI_2,
                },
                ..PoseEstimate::default()
            };
            let solid = Point2 { x_m: 0.2, y_m: 0.0 };
            super::contradicted(&reference_map, &estimate, &[solid], super::PARAMETERS.elsewhere_m)
        };
        assert_eq!(below(1.99), Some(0.0), "in the last cells that are known");
        assert_eq!(below(1.5), Some(1.0), "in the midst of floor");
        assert_eq!(below(2.5), None, "beyond");
    }

    #[test]
    fn drift_is_no_contradiction_and_another_place_is() {
        let home = flat();
        let off = |x_m: f64, y_m: f64, heading_rad: f64| Pose2 {
            x_m,
            y_m,
            heading_rad,
        };
        let steps = 50 * 300;
        for drift in [off(0.0, 0.0, 0.0), off(0.15, -0.1, 0.0), off(-0.1, 0.1, 0.03)] {
            let greatest = contradicted(&home, drift, steps);
            assert!(
                greatest < super::PARAMETERS.doubted_above,
                "{greatest} with {drift:?}"
            );
        }
        for elsewhere in [off(1.6, 0.9, 0.0), off(4.2, 3.6, 3.0), off(-0.9, 1.0, -0.6)] {
            let greatest = contradicted(&home, elsewhere, steps);
            assert!(
                greatest > super::PARAMETERS.contradicted_above,
                "{greatest} with {elsewhere:?}"
            );
        }
    }

    /// One step of a robot on its first run, whose map is the flat's.
    fn step(localization: &mut Localization, truth: &mut SimulatedRobot<'_>, home: &Map) -> bool {
        let view = truth.step().clone();
        let advance = localization.update(&view);
        localization.refine(&view, advance);
        localization.check_against_map(&view, advance, &config());
        let correction = localization.learn(home, &config(), view.time_us);
        assert_eq!(
            matches!(correction, Some(MapCorrection::RollBack { .. })),
            localization.estimate().lost,
            "{correction:?}"
        );
        localization.estimate().lost
    }

    #[test]
    fn line_slam_that_contradicts_its_map_ends_with_a_lost_robot() {
        let home = flat();
        let at = |x_m: f64, y_m: f64| Pose2 { x_m, y_m, ..START };
        let mut noticed = 0;
        for begins in [START, at(2.2, 1.6), at(2.6, 2.2), at(1.6, 1.8)] {
            let mut truth = SimulatedRobot::new(&home, begins);
            let mut localization = Localization::new(TRACK_M, 0.5);
            localization.place_at(START);
            localization.start_line_slam(&config());
            localization.learn(&home, &config(), LEARN_US);
            let lost = (0..50 * 240).any(|_| step(&mut localization, &mut truth, &home));
            assert!(!lost || begins != START, "its pose is right");
            assert_eq!(localization.explained().is_some(), lost, "compares with the map");
            noticed += u32::from(lost);
        }
        // Walls that run alike are confused, so not every start shows a contradiction.
        assert!(noticed >= 1, "{noticed} of three");
    }

    /// Draws so many steps of a robot whose pose has this standard deviation. Returns the number of known cells.
    fn drawn(map: &mut Map, truth: &mut SimulatedRobot<'_>, sigma_m: f64, steps: u32) -> usize {
        for _ in 0..steps {
            let view = truth.step().clone();
            let estimate = PoseEstimate {
                pose: truth.pose,
                odom: truth.pose,
                sigma_m,
                ..PoseEstimate::default()
            };
            map.insert(&estimate, &view);
        }
        known(map)
    }

    fn known(map: &mut Map) -> usize {
        map.finish_redraw();
        map.refresh();
        let cells = map.knowledge().values();
        cells
            .iter()
            .filter(|kind| **kind != CellKnowledge::Unknown)
            .count()
    }

    #[test]
    fn a_map_in_which_the_robot_could_not_relocalize_is_no_reference() {
        let home = flat();
        for (sigma_m, is_trusted) in [(0.02, true), (0.4, false)] {
            let mut map = Map::new(config().body, config().sensors);
            drawn(&mut map, &mut SimulatedRobot::new(&home, START), sigma_m, 6_000);
            let mut monitor = ConsistencyMonitor::default();
            monitor.update_reference(&map, LEARN_US);
            assert_eq!(monitor.reference_map.is_some(), is_trusted, "{sigma_m} m");
        }
    }

    #[test]
    fn a_rollback_removes_what_was_seen_since() {
        let home = flat();
        let mut truth = SimulatedRobot::new(&home, START);
        let mut map = Map::new(config().body, config().sensors);
        let before = drawn(&mut map, &mut truth, 0.02, 1_000);
        let later = drawn(&mut map, &mut truth, 0.02, 6_000);
        assert!(later > before + before / 10, "{before} cells, then {later}");
        let keyframe = Keyframe {
            time_us: 0,
            odom_from_base: Pose2::IDENTITY,
            map_from_base: Pose2::IDENTITY,
        };
        map.roll_back(20_000 * 1_001, &[keyframe]);
        let left = known(&mut map);
        assert!(
            left.abs_diff(before) <= before / 100,
            "{left} cells, {before} before"
        );
    }
}
