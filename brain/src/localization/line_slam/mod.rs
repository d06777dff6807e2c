//! Line SLAM: localization and mapping in a home that is not known yet, with walls as landmarks.
//!
//! Infrared readings along short paths ([`local_submap`]) give line segments ([`line_segment`]). A segment that belongs to a known
//! landmark ([`data_association`]) corrects the pose at once ([`kalman`]). Now and then all poses and landmarks ([`graph`]) are
//! optimized ([`optimization`]) in the background ([`graph_fit`]), with right angles where the home has them ([`manhattan`]). Loops
//! close at the dock ([`dock`]) and at duplicate landmarks ([`duplicate_landmarks`]). The map is then redrawn with the better
//! poses.

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
mod parameters;
mod turns;

use core::task::Poll;

use dock::DockWatch;
use graph::{Graph, Node};
use graph_fit::FittedGraph;
use kalman::{Belief, StepVariance};
use local_submap::{LocalSubmap, SubmapBuilder};
use parameters::{NOISE, UPDATE};
pub(super) use turns::{ScaleEstimate, TurnCalibration};
use turns::{TurnErrors, Turns};

use crate::mapping::Keyframe;
use crate::model::advance::Advance;
use crate::model::config::ProximityLayout;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::Gradual;
use crate::model::observation::Observation;

/// An advance of odometry and the pose at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct OdometryStep {
    pub(super) odom: Pose2,
    pub(super) advance: Advance,
}

/// A correction of the pose.
#[derive(Clone, Debug)]
pub(super) struct PoseFix {
    pub(super) map_from_odom: Pose2,
    /// Scale error of the turns, relative, and its standard deviation, when an optimization has estimated it. It is applied between
    /// two steps, so that all turns of one step have the same scale. Whole turns with a mixed scale would give a wrong estimate.
    pub(super) scale: Option<ScaleEstimate>,
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// Line SLAM of one home.
#[derive(Debug)]
pub(super) struct LineSlam {
    layout: ProximityLayout,
    log: SubmapBuilder,
    dock: DockWatch,
    graph: Graph,
    belief: Belief,
    /// Pose of the belief, by odometry.
    odom: Pose2,
    /// The newest node; beyond the nodes when there are too many.
    here: usize,
    pending: StepInProgress,
    observations_fitted: usize,
    fit: Option<Gradual<Option<FittedGraph>>>,
    drawn_us: u64,
    /// Poses of the nodes with which the map was drawn.
    drawn: Vec<Pose2>,
    /// A pose has moved by enough since to redraw the map.
    outdated: bool,
    /// The robot has docked again or turned whole turns beside a wall, and no optimization has used that yet.
    has_urgent_constraint: bool,
    /// An optimization has estimated the scale of turns, and odometry does not use it yet.
    has_new_scale: bool,
    /// The map is redrawn at once when an urgent constraint is optimized, because the job may be over.
    redraws_at_once: bool,
}

/// Motion since the last node.
#[derive(Clone, Copy, Debug, Default)]
struct StepInProgress {
    distance_m: f64,
    turn_rad: f64,
    /// Derivative of the end position by the scale of turns, metres, in the odometry frame.
    d_position_d_scale: Point2,
    /// Derivative of the end position by the gyro's bias, metres per radian per second.
    d_position_d_bias: Point2,
    noise_rad2: f64,
    time_s: f64,
}

impl StepInProgress {
    /// Adds an advance that ended at `odom`. A robot at rest does not turn, however long it rests.
    fn add(&mut self, advance: Advance, odom: Pose2) {
        if advance.is_stationary() {
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
            Some(_) => NOISE.gyro_rad2_per_s * advance.time_s,
            None => NOISE.slip_rad2_per_m * advance.distance_m.abs(),
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
        let slip_m2 = NOISE.slip_m2_per_m * self.distance_m + NOISE.step_m2;
        let length_m2 = step.x_m * step.x_m + step.y_m * step.y_m;
        StepVariance {
            along_m2: slip_m2,
            across_m2: slip_m2 + turn_rad2 * length_m2 / 3.0,
            turn_rad2,
        }
    }
}

impl LineSlam {
    /// Starts at `pose`, which is `odom` by odometry.
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

    /// Starts again at a known pose. What came before is final.
    pub(super) fn begin_at(&mut self, pose: Pose2, odom: Pose2) {
        *self = Self::new(self.layout, pose, odom);
    }

    /// Takes the pose by odometry and the sensor readings. Returns a correction now and then.
    pub(super) fn follow(
        &mut self,
        step: OdometryStep,
        turns: TurnCalibration,
        observation: &Observation,
    ) -> Option<PoseFix> {
        let OdometryStep { odom, advance } = step;
        self.begin(observation.time_us, turns);
        self.pending.add(advance, odom);
        let submap = self.log.follow(step, observation, &self.layout);
        let submap = submap.filter(|submap| !submap.segments.is_empty());
        if let Some(submap) = &submap {
            self.take(submap, turns);
        }
        let arrives = self.dock.arrives(advance.distance_m, observation.docked);
        if arrives {
            self.arrive_at_dock(observation.time_us, odom, turns);
        }
        let is_fitted = self.continue_fit();
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

    /// The scale that an optimization has estimated since the last call, at a moment between two steps.
    fn new_scale(&mut self) -> Option<ScaleEstimate> {
        let is_between_steps = self.pending.time_s == 0.0;
        if !is_between_steps || !core::mem::take(&mut self.has_new_scale) {
            return None;
        }
        self.graph.turn_errors.estimated_scale()
    }

    /// Adds the first node at the start. A later estimate of the scale also corrects the turns before the first wall was seen.
    /// Without this node the whole map would stay rotated about the start.
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

    /// Adds a submap to the graph.
    fn take(&mut self, submap: &LocalSubmap, turns: TurnCalibration) {
        let turned_rad = self.pending.turn_rad;
        self.step_to(submap, turns);
        let expected_rad = self.belief.pose.heading_rad;
        self.associate_segments(&submap.segments);
        if turned_rad.abs() > UPDATE.calibration_turn_min_rad {
            let off_rad = normalize_rad(self.belief.pose.heading_rad - expected_rad);
            self.graph.turn_errors.correct_scale(off_rad / turned_rad);
            self.has_urgent_constraint = true;
        }
        if let Some(node) = self.graph.nodes.get_mut(self.here) {
            node.pose = self.belief.pose;
            self.drawn.push(node.pose);
        }
    }

    /// Moves the belief to the end of the submap, and adds a node there while there are fewer than the most.
    fn step_to(&mut self, submap: &LocalSubmap, turns: TurnCalibration) {
        let step = self.odom.inverse() * submap.odom;
        let began = self.odom;
        let pending = core::mem::take(&mut self.pending);
        self.belief.step(step, pending.variance(step, turns));
        self.odom = submap.odom;
        self.here = self.graph.nodes.len();
        if self.here < UPDATE.nodes_max {
            let sigma_rad_per_s = turns.bias_sigma_rad_per_s;
            let epoch = self
                .graph
                .turn_errors
                .epoch(self.here, submap.time_us, sigma_rad_per_s);
            // Scale and bias are unknowns of their own, so they add no variance here.
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

    /// Starts an optimization when enough is new, and continues it. Returns whether a result was adopted.
    fn continue_fit(&mut self) -> bool {
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
            self.adopt(fitted);
        }
        is_taken_up
    }

    fn begin_fit(&mut self) {
        let observations = self.graph.observations.len();
        let due = UPDATE
            .fit_observations_min
            .max((UPDATE.fit_share * observations as f64) as usize);
        let is_urgent = core::mem::take(&mut self.has_urgent_constraint);
        self.redraws_at_once |= is_urgent;
        if is_urgent || observations >= self.observations_fitted + due {
            self.observations_fitted = observations;
            self.graph.recount(self.graph.turn_errors.scale);
            self.fit = graph_fit::begin(&self.graph);
        }
    }

    fn adopt(&mut self, fitted: FittedGraph) {
        let moved = fitted.moved;
        let has_merged = fitted.has_merged;
        self.graph = fitted.extended_with(&self.graph);
        self.belief.pose = moved * self.belief.pose;
        self.observations_fitted = self.observations_fitted.min(self.graph.observations.len());
        self.outdated = self
            .graph
            .nodes
            .iter()
            .zip(&self.drawn)
            .any(|(node, drawn)| node.pose.position().distance_m(drawn.position()) > UPDATE.redraw_m);
        self.redraws_at_once = (self.redraws_at_once || has_merged) && self.outdated;
    }

    /// The poses with which the map is to be redrawn; `None` while it is good enough.
    pub(super) fn redraw(&mut self, time_us: u64) -> Option<Vec<Keyframe>> {
        let began_us = self.graph.nodes.first()?.time_us;
        let pause_us = UPDATE
            .redraw_interval_us
            .max(self.drawn_us.saturating_sub(began_us) / UPDATE.redraw_elapsed_divisor);
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

    /// The estimated poses of all nodes.
    pub(super) fn keyframes(&self) -> Vec<Keyframe> {
        let keyframe = |node: &Node| Keyframe {
            time_us: node.time_us,
            odom_from_base: node.odom,
            map_from_base: node.pose,
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

    /// A step with a turn on the spot, a straight line and an arc, by a gyro with this scale error. It began at `odom`.
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
    fn turns_can_be_counted_again_with_another_scale() {
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
