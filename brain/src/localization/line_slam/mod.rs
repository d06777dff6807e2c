//! Where the robot is in a home that it does not know yet: the walls that it passes tell.
//!
//! The infrared sensors see pieces of wall ([`line_segment`]) on short ways along them ([`local_submap`]). A piece of wall that lies where
//! one was seen before corrects the pose at once ([`kalman`]), and now and then all poses and walls are fitted anew
//! ([`graph`], [`optimization`]), with right angles where the home has them ([`manhattan`]), while the robot drives on ([`graph_fit`]).
//! The map is then drawn again with the better poses.

mod cleanup;
mod data_association;
mod dock;
mod duplicate_landmarks;
mod graph;
mod graph_fit;
mod kalman;
mod line_segment;
mod local_submap;
#[cfg(test)]
mod loop_closure;
mod manhattan;
mod optimization;
mod turns;

use core::task::Poll;

use dock::DockWatch;
use graph::{Graph, Node};
use graph_fit::FittedGraph;
use kalman::{Belief, StepVariance};
use local_submap::{LocalSubmap, SubmapBuilder};
pub(super) use turns::TurnCalibration;
use turns::{TurnErrors, Turns};

use crate::mapping::Keyframe;
use crate::model::advance::Advance;
use crate::model::config::ProximityLayout;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::Gradual;
use crate::model::observation::Observation;

/// Slip along the way, square metres per metre, and what each step adds: that of a bad robot. One that is taken for too good
/// holds on to a wrong wall.
const SLIP_M2_PER_M: f64 = 4.0e-4;
const STEP_M2: f64 = 4.0e-6;
/// Noise of a gyro's heading, square radians per second: 0.04 degrees per square root of a second, that of a bad robot, too.
const GYRO_RAD2_PER_S: f64 = 4.8e-7;
/// Slip in heading where there is no gyro, square radians per metre.
const SLIP_RAD2_PER_M: f64 = 7.6e-5;
/// Most nodes; what comes later is placed by the walls that are known by then.
const NODES_MAX: usize = 2_000;
/// All is fitted anew when so many marks have come: a share of those there are, or this number.
const FIT_SHARE: f64 = 0.03;
const FIT_OBSERVATIONS: usize = 2;
/// A step that turns so much, in radians, is one of whole turns on the spot: what it tells of the gyro is fitted at once.
const CALIBRATION_TURN_RAD: f64 = 7.0;
/// The map is drawn again when a pose has moved by this much since, metres.
const REDRAW_M: f64 = 0.025;
/// At least this long after the last time, microseconds,
const REDRAW_US: u64 = 60_000_000;
/// and this share of the time since the survey began: drawing takes the longer the more there is.
const REDRAW_SHARE: u64 = 5;

/// What the survey found out.
#[derive(Clone, Debug)]
pub(super) struct PoseFix {
    pub(super) map_from_odom: Pose2,
    /// What is wrong with the scale with which turns are counted, relative, and its deviation, when a fit has told it. It comes
    /// where a step ends, so that all turns of the next one are counted alike: whole turns on the spot that are not tell a wrong scale.
    pub(super) scale: Option<(f64, f64)>,
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// The survey of a home.
#[derive(Debug)]
pub(super) struct LineSlam {
    layout: ProximityLayout,
    log: SubmapBuilder,
    dock: DockWatch,
    graph: Graph,
    belief: Belief,
    /// Where the belief is, by odometry.
    odom: Pose2,
    /// The node of the newest visit; beyond the nodes when there are too many.
    here: usize,
    pending: StepInProgress,
    observations_fitted: usize,
    fit: Option<Gradual<Option<FittedGraph>>>,
    drawn_us: u64,
    /// Poses of the nodes with which the map was drawn.
    drawn: Vec<Pose2>,
    /// A pose has moved since by enough to draw the map again.
    outdated: bool,
    /// The robot has come home, or has turned whole turns beside a wall, and what that tells is not in a fit yet.
    has_urgent_constraint: bool,
    /// A fit has told the scale of turns, and nobody counts with it yet.
    has_new_scale: bool,
    /// It is in a fit: the map is drawn again at once, for the work may be over.
    redraws_at_once: bool,
}

/// What the robot moved since the last node.
#[derive(Clone, Copy, Debug, Default)]
struct StepInProgress {
    distance_m: f64,
    turn_rad: f64,
    /// By how much the end moves for each unit of the scale of turns, in the frame of odometry.
    d_position_d_scale: Point2,
    /// The same for each radian per second that it turned more.
    d_position_d_bias: Point2,
    noise_rad2: f64,
    time_s: f64,
}

impl StepInProgress {
    /// Adds an advance that ended at `odom`. Standing turns nobody, however long it lasts.
    fn add(&mut self, advance: Advance, odom: Pose2) {
        if advance.stands() {
            return;
        }
        let heading_rad = odom.heading_rad - 0.5 * advance.turn_rad;
        let (sin, cos) = libm::sincos(heading_rad);
        let lever_m = (self.turn_rad + 0.5 * advance.turn_rad) * advance.distance_m;
        self.d_position_d_scale.x_m -= lever_m * sin;
        self.d_position_d_scale.y_m += lever_m * cos;
        let lever_m = (self.time_s + 0.5 * advance.time_s) * advance.distance_m;
        self.d_position_d_bias.x_m -= lever_m * sin;
        self.d_position_d_bias.y_m += lever_m * cos;
        self.distance_m += advance.distance_m.abs();
        self.turn_rad += advance.turn_rad;
        self.time_s += advance.time_s;
        self.noise_rad2 += match advance.gyro_turn_rad {
            Some(_) => GYRO_RAD2_PER_S * advance.time_s,
            None => SLIP_RAD2_PER_M * advance.distance_m.abs(),
        };
    }

    /// The turns of a step that began at `odom`.
    fn turns(self, odom: Pose2) -> Turns {
        let from_odom = Pose2 {
            heading_rad: -odom.heading_rad,
            ..Pose2::IDENTITY
        };
        Turns {
            sum_rad: self.turn_rad,
            d_position_d_scale: from_odom.transform(self.d_position_d_scale),
            time_s: self.time_s,
            d_position_d_bias: from_odom.transform(self.d_position_d_bias),
            ..Turns::default()
        }
    }

    fn variance(self, step: Pose2, turns: TurnCalibration) -> StepVariance {
        let bias_rad = turns.bias_sigma_rad_per_s * self.time_s;
        let scale_rad = turns.scale_sigma * self.turn_rad;
        let turn_rad2 = self.noise_rad2 + bias_rad * bias_rad + scale_rad * scale_rad + 1e-7;
        let slip_m2 = SLIP_M2_PER_M * self.distance_m + STEP_M2;
        let length_m2 = step.x_m * step.x_m + step.y_m * step.y_m;
        StepVariance {
            along_m2: slip_m2,
            across_m2: slip_m2 + turn_rad2 * length_m2 / 3.0,
            turn_rad2,
        }
    }
}

impl LineSlam {
    /// Of a robot that stands at `pose`, and at `odom` by odometry.
    pub(super) fn new(layout: ProximityLayout, pose: Pose2, odom: Pose2) -> Self {
        Self {
            layout,
            log: SubmapBuilder::default(),
            dock: DockWatch::default(),
            graph: Graph::default(),
            belief: Belief {
                pose,
                covariance: [[1e-4, 0.0, 0.0], [0.0, 1e-4, 0.0], [0.0, 0.0, 1e-4]],
            },
            odom,
            here: 0,
            pending: StepInProgress::default(),
            observations_fitted: 0,
            fit: None,
            drawn_us: 0,
            drawn: Vec::new(),
            outdated: false,
            has_urgent_constraint: false,
            has_new_scale: false,
            redraws_at_once: false,
        }
    }

    /// Somebody knows where the robot is: what came before is not to be moved any more.
    pub(super) fn begin_at(&mut self, pose: Pose2, odom: Pose2) {
        *self = Self::new(self.layout, pose, odom);
    }

    /// Takes in where the robot is by odometry and what it sees. Gives what that says of the pose, now and then.
    pub(super) fn follow(
        &mut self,
        odom: Pose2,
        (advance, turns): (Advance, TurnCalibration),
        observation: &Observation,
    ) -> Option<PoseFix> {
        self.begin(observation.time_us, turns);
        self.pending.add(advance, odom);
        let submap = self.log.follow((odom, advance), observation, &self.layout);
        let submap = submap.filter(|submap| !submap.segments.is_empty());
        if let Some(submap) = &submap {
            self.take(submap, turns);
        }
        let arrives = self.dock.arrives(advance.distance_m, observation.docked);
        if arrives {
            self.arrive_at_dock((observation.time_us, odom), turns);
        }
        let is_fitted = self.fit_on();
        self.has_new_scale |= is_fitted;
        if submap.is_none() && !arrives && !is_fitted {
            return None;
        }
        let mut now = self.belief;
        let step = self.odom.inverse() * odom;
        now.step(step, self.pending.variance(step, turns));
        let (sigma_m, sigma_rad) = now.sigmas();
        Some(PoseFix {
            map_from_odom: now.pose * odom.inverse(),
            scale: self.new_scale(),
            sigma_m,
            sigma_rad,
        })
    }

    /// The scale that a fit has found since this was asked last, at a moment at which no step is under way.
    fn new_scale(&mut self) -> Option<(f64, f64)> {
        let is_between_steps = self.pending.time_s == 0.0;
        if !is_between_steps || !core::mem::take(&mut self.has_new_scale) {
            return None;
        }
        self.graph.turn_errors.found()
    }

    /// The first node is where it began. What later ones tell of the scale of turns says how far the robot had turned until it
    /// saw the first wall, too: without, the whole map stays turned about the start.
    fn begin(&mut self, time_us: u64, turns: TurnCalibration) {
        if self.graph.nodes.is_empty() {
            self.graph.turn_errors = TurnErrors::new(turns);
            self.graph.nodes.push(Node {
                time_us,
                odom: self.odom,
                pose: self.belief.pose,
                step: Pose2::IDENTITY,
                variance: StepVariance::default(),
                turns: Turns {
                    scale: turns.scale,
                    ..Turns::default()
                },
            });
            self.drawn.push(self.belief.pose);
        }
    }

    /// Takes in a visit.
    fn take(&mut self, submap: &LocalSubmap, turns: TurnCalibration) {
        let turned_rad = self.pending.turn_rad;
        self.step_to(submap, turns);
        let expected_rad = self.belief.pose.heading_rad;
        self.associate_segments(&submap.segments);
        if turned_rad.abs() > CALIBRATION_TURN_RAD {
            let off_rad = normalize_rad(self.belief.pose.heading_rad - expected_rad);
            self.graph.turn_errors.guess(off_rad / turned_rad);
            self.has_urgent_constraint = true;
        }
        if let Some(node) = self.graph.nodes.get_mut(self.here) {
            node.pose = self.belief.pose;
            self.drawn.push(node.pose);
        }
    }

    /// The belief moves to the visit's end, where there is a new node while there may be more.
    fn step_to(&mut self, submap: &LocalSubmap, turns: TurnCalibration) {
        let step = self.odom.inverse() * submap.odom;
        let began = self.odom;
        let pending = core::mem::take(&mut self.pending);
        self.belief.step(step, pending.variance(step, turns));
        self.odom = submap.odom;
        self.here = self.graph.nodes.len();
        if self.here < NODES_MAX {
            let sigma_rad_per_s = turns.bias_sigma_rad_per_s;
            let epoch = self
                .graph
                .turn_errors
                .epoch(self.here, submap.time_us, sigma_rad_per_s);
            // What is wrong with scale and bias is unknown by itself.
            let by_chance = TurnCalibration::default();
            self.graph.nodes.push(Node {
                time_us: submap.time_us,
                odom: submap.odom,
                pose: self.belief.pose,
                step,
                variance: pending.variance(step, by_chance),
                turns: Turns {
                    scale: turns.scale,
                    epoch,
                    ..pending.turns(began)
                },
            });
        }
    }

    /// Begins to fit all poses and walls anew when enough is new, and goes on with it. Says whether a fit was taken up.
    fn fit_on(&mut self) -> bool {
        let Some(fit) = &mut self.fit else {
            self.begin_fit();
            return false;
        };
        let Poll::Ready(fitted) = fit.go_on() else {
            return false;
        };
        self.fit = None;
        let is_taken_up = fitted.is_some();
        if let Some(fitted) = fitted {
            self.take_up(fitted);
        }
        is_taken_up
    }

    fn begin_fit(&mut self) {
        let observations = self.graph.observations.len();
        let due = FIT_OBSERVATIONS.max((FIT_SHARE * observations as f64) as usize);
        let is_urgent = core::mem::take(&mut self.has_urgent_constraint);
        self.redraws_at_once |= is_urgent;
        if is_urgent || observations >= self.observations_fitted + due {
            self.observations_fitted = observations;
            self.graph.recount(self.graph.turn_errors.scale);
            self.fit = graph_fit::begin(&self.graph);
        }
    }

    fn take_up(&mut self, fitted: FittedGraph) {
        let moved = fitted.moved;
        let has_merged = fitted.has_merged;
        self.graph = fitted.with_news_of(&self.graph);
        self.belief.pose = moved * self.belief.pose;
        self.observations_fitted = self.observations_fitted.min(self.graph.observations.len());
        self.outdated = self
            .graph
            .nodes
            .iter()
            .zip(&self.drawn)
            .any(|(node, drawn)| node.pose.position().distance_m(drawn.position()) > REDRAW_M);
        self.redraws_at_once = (self.redraws_at_once || has_merged) && self.outdated;
    }

    /// The poses with which the map shall be drawn again; `None` while it is drawn well enough.
    pub(super) fn redraw(&mut self, time_us: u64) -> Option<Vec<Keyframe>> {
        let began_us = self.graph.nodes.first()?.time_us;
        let pause_us = REDRAW_US.max(self.drawn_us.saturating_sub(began_us) / REDRAW_SHARE);
        let is_early = time_us < self.drawn_us.max(began_us).saturating_add(pause_us);
        let redraws_at_once = self.redraws_at_once && self.fit.is_none();
        if !self.outdated || (is_early && !redraws_at_once) {
            return None;
        }
        self.redraws_at_once = false;
        self.drawn_us = time_us;
        self.outdated = false;
        let nodes = &self.graph.nodes;
        self.drawn = nodes.iter().map(|node| node.pose).collect();
        Some(self.keyframes())
    }

    /// Where the robot was at each node, as far as is known now.
    pub(super) fn keyframes(&self) -> Vec<Keyframe> {
        let keyframe = |node: &Node| Keyframe {
            time_us: node.time_us,
            was: node.odom,
            is: node.pose,
        };
        self.graph.nodes.iter().map(keyframe).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::graph::Node;
    use super::turns::Turns;
    use super::{StepInProgress, StepVariance};
    use crate::model::advance::Advance;
    use crate::model::geometry::Pose2;

    /// A step of a turn on the spot, a straight way and an arc, by a gyro that counts so much too much. It began at `odom`.
    fn counted(error: f64, odom: Pose2) -> Node {
        let (mut here, mut pending) = (odom, StepInProgress::default());
        for (pieces, distance_m, turn_rad) in [(40, 0.0, 0.06), (100, 0.01, 0.0), (50, 0.01, -0.04)] {
            for _ in 0..pieces {
                let turn_rad = turn_rad * (1.0 + error);
                here = here.after_arc(distance_m, turn_rad);
                let advance = Advance {
                    distance_m,
                    turn_rad,
                    gyro_turn_rad: Some(turn_rad),
                    ..Advance::default()
                };
                pending.add(advance, here);
            }
        }
        Node {
            time_us: 0,
            odom: here,
            pose: here,
            step: odom.inverse() * here,
            variance: StepVariance::default(),
            turns: Turns {
                scale: 0.0,
                ..pending.turns(odom)
            },
        }
    }

    #[test]
    fn turns_that_were_counted_with_a_wrong_scale_are_counted_anew() {
        for heading_rad in [0.0, 1.3, -2.0] {
            let began = Pose2 {
                x_m: 3.0,
                y_m: -1.0,
                heading_rad,
            };
            let (right, mut wrong) = (counted(0.0, began).step, counted(0.02, began));
            let off_m = |node: &Node| node.step.position().distance_m(right.position());
            assert!(off_m(&wrong) > 0.03, "{} m", off_m(&wrong));
            wrong.recount(1.0 / 1.02 - 1.0);
            assert!(off_m(&wrong) < 0.002, "{} m", off_m(&wrong));
            assert!((wrong.step.heading_rad - right.heading_rad).abs() < 1e-9);
            assert!((wrong.turns.sum_rad - 0.4).abs() < 1e-9);
            let once = wrong;
            wrong.recount(1.0 / 1.02 - 1.0);
            assert_eq!(wrong.step, once.step, "with the same scale nothing changes");
        }
    }
}
