//! The pose graph: poses at which walls were seen, joined by odometry and by line landmarks.
//!
//! *Node*: the pose at the end of a submap. *Line landmark*: a wall as a straight line whose front faces the free space. *Line
//! observation*: a segment, seen from a node, that lies on a landmark. *Quarter*: one of the four directions of a home with right
//! angles; landmarks of one quarter share a direction. *Docking*: the robot was on its dock ([`super::dock`]). Gauss-Newton
//! minimizes all squared residuals. Cauchy's kernel gives outliers little weight.

use super::kalman::StepVariance;
use super::line_segment::LineSegment;
use super::parameters::OPTIMIZATION;
use super::turns::{TurnErrors, TurnUnknowns, Turns};
use crate::localization::skyline::{Summation, System};
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use core::f64::consts::FRAC_PI_2;

/// A pose at which walls were seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) time_us: u64,
    /// Pose by odometry.
    pub(super) odom: Pose2,
    /// Estimated pose in the map.
    pub(super) pose: Pose2,
    /// Motion since the previous node by odometry, and its variance.
    pub(super) step: Pose2,
    pub(super) variance: StepVariance,
    /// Turns since the previous node.
    pub(super) turns: Turns,
}

impl Node {
    /// Counts the turns of the step with another scale.
    pub(super) fn recount(&mut self, scale: f64) {
        self.step = self.turns.recount(self.step, scale);
    }
}

/// A wall as a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineLandmark {
    /// The quarter whose direction it shares; `None` = its direction is free.
    pub(super) quarter: Option<u8>,
    /// Direction from the wall into the free space.
    pub(super) normal_rad: f64,
    /// A fixed point on the wall or near it.
    pub(super) anchor: Point2,
    /// Distance from the anchor to the wall along the normal, metres.
    pub(super) offset_m: f64,
    /// Ends along the wall, relative to the anchor, metres.
    pub(super) low_m: f64,
    pub(super) high_m: f64,
    /// The first node that saw it.
    pub(super) first: usize,
    /// Number of observations.
    pub(super) observation_count: u32,
    /// A merge with a close landmark was rejected.
    pub(super) is_distinct: bool,
}

/// A segment that lies on a landmark.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineObservation {
    pub(super) node: usize,
    pub(super) landmark: usize,
    pub(super) segment: LineSegment,
}

/// Weight of a residual with this variance.
fn weight(variance: f64) -> f64 {
    1.0 / variance.max(1e-8)
}

/// Unit vector.
pub(super) fn direction(rad: f64) -> Point2 {
    let (sin, cos) = libm::sincos(rad);
    Point2 { x_m: cos, y_m: sin }
}

/// A point in the frame of a landmark.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    /// Distance in front of the wall, metres.
    pub(super) off_m: f64,
    /// Position along the wall from the anchor, metres.
    pub(super) along_m: f64,
}

impl LineLandmark {
    /// The point on the wall at this distance from the anchor, metres.
    pub(super) fn at(&self, along_m: f64) -> Point2 {
        let normal = direction(self.normal_rad);
        Point2 {
            x_m: self.anchor.x_m + normal.x_m * self.offset_m - normal.y_m * along_m,
            y_m: self.anchor.y_m + normal.y_m * self.offset_m + normal.x_m * along_m,
        }
    }

    /// A point relative to the wall.
    pub(super) fn project(&self, at: Point2) -> Projection {
        let normal = direction(self.normal_rad);
        let (x_m, y_m) = (at.x_m - self.anchor.x_m, at.y_m - self.anchor.y_m);
        Projection {
            off_m: normal.x_m * x_m + normal.y_m * y_m - self.offset_m,
            along_m: normal.x_m * y_m - normal.y_m * x_m,
        }
    }
}

/// Nodes, landmarks and observations.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    pub(super) nodes: Vec<Node>,
    pub(super) landmarks: Vec<LineLandmark>,
    pub(super) observations: Vec<LineObservation>,
    /// Nodes at which the robot was docked.
    pub(super) docked: Vec<usize>,
    /// Direction of the first quarter; `None` = the home has no right angles, as far as known.
    pub(super) manhattan_rad: Option<f64>,
    pub(super) turn_errors: TurnErrors,
    /// [`Self::odometry_chi_square`] after the last optimization.
    pub(super) fitted_chi_square: f64,
}

/// Indices of the unknowns.
#[derive(Clone, Debug)]
pub(super) struct Unknowns {
    manhattan: usize,
    /// For each landmark the index of its offset. A free direction has the next index.
    landmarks: Vec<usize>,
    turns: TurnUnknowns,
}

/// The residuals of one iteration, linearized at the present poses and landmarks.
#[derive(Debug)]
pub(super) struct Linearization {
    pub(super) unknowns: Unknowns,
    pub(super) system: System,
    /// Observations that are off by more squared deviations than this have little weight.
    kernel: f64,
}

impl Graph {
    /// A linearization that has no residuals yet.
    pub(super) fn linearization(&self, kernel: f64) -> Linearization {
        let unknowns = self.unknowns();
        Linearization {
            system: self.system(&unknowns),
            unknowns,
            kernel,
        }
    }

    fn unknowns(&self) -> Unknowns {
        let manhattan = 3 * self.nodes.len();
        let mut count = manhattan + usize::from(self.manhattan_rad.is_some());
        let mut landmarks = Vec::with_capacity(self.landmarks.len());
        for landmark in &self.landmarks {
            landmarks.push(count);
            count += if landmark.quarter.is_some() { 1 } else { 2 };
        }
        let turns = TurnUnknowns {
            first_epoch: count,
            scale: count + self.turn_errors.epochs.len(),
        };
        Unknowns {
            manhattan,
            landmarks,
            turns,
        }
    }

    /// An empty system with weak priors that keep every unknown bounded.
    fn system(&self, unknowns: &Unknowns) -> System {
        let mut first: Vec<usize> = (0..self.nodes.len())
            .flat_map(|node| [3 * node.saturating_sub(1); 3])
            .collect();
        for node in self.docked.iter().skip(1) {
            // A later docking refers to the first one.
            let dock = self.docked.first().copied().unwrap_or(0);
            if let Some(rows) = first.get_mut(3 * node..3 * node + 3) {
                rows.fill(3 * dock.min(*node));
            }
        }
        if self.manhattan_rad.is_some() {
            first.push(0);
        }
        for landmark in &self.landmarks {
            first.push(3 * landmark.first);
            if landmark.quarter.is_none() {
                first.push(3 * landmark.first);
            }
        }
        for epoch in &self.turn_errors.epochs {
            first.push(3 * epoch.first.saturating_sub(1));
        }
        first.push(0);
        let mut system = System::new(first, Summation::Interleaved);
        for unknown in 0..3 {
            system.add_residual(&[(unknown, 1.0)], 0.0, 1e7);
        }
        for unknown in unknowns.manhattan..unknowns.turns.first_epoch {
            system.add_residual(&[(unknown, 1.0)], 0.0, 1e-2);
        }
        self.turn_errors.add_knowledge(unknowns.turns, &mut system);
        system
    }

    /// Adds the odometry residual between a node and the next one.
    pub(super) fn add_odometry_residual(&self, index: usize, linearization: &mut Linearization) {
        let Linearization { unknowns, system, .. } = linearization;
        if let (Some(before), Some(after)) = (self.nodes.get(index), self.nodes.get(index + 1)) {
            let (from, to) = (3 * index, 3 * index + 3);
            let made = before.pose.inverse() * after.pose;
            let off = self.step_off(before, after);
            let [x, y, turn] = TurnErrors::slopes(&after.turns, unknowns.turns);
            let (sin, cos) = libm::sincos(before.pose.heading_rad);
            let along = [
                (from, -cos),
                (from + 1, -sin),
                (from + 2, made.y_m),
                (to, cos),
                (to + 1, sin),
                x[0],
                x[1],
            ];
            system.add_residual(&along, off.x_m, weight(after.variance.along_m2));
            let across = [
                (from, sin),
                (from + 1, -cos),
                (from + 2, -made.x_m),
                (to, -sin),
                (to + 1, cos),
                y[0],
                y[1],
            ];
            system.add_residual(&across, off.y_m, weight(after.variance.across_m2));
            let turned = [(from + 2, -1.0), (to + 2, 1.0), turn[0], turn[1]];
            system.add_residual(&turned, off.heading_rad, weight(after.variance.turn_rad2));
        }
    }

    /// Difference between a step in the graph and the same step by odometry: x, y, heading.
    fn step_off(&self, before: &Node, after: &Node) -> Pose2 {
        let made = before.pose.inverse() * after.pose;
        let step = self.turn_errors.unbiased(after.step, &after.turns);
        Pose2 {
            x_m: made.x_m - step.x_m,
            y_m: made.y_m - step.y_m,
            heading_rad: normalize_rad(made.heading_rad - step.heading_rad),
        }
    }

    /// Sum of the squared deviations of all steps from odometry.
    pub(super) fn odometry_chi_square(&self) -> f64 {
        let steps = self.nodes.windows(2).filter_map(|nodes| match nodes {
            [before, after] => Some((self.step_off(before, after), after.variance)),
            _ => None,
        });
        steps
            .map(|(off, variance)| {
                off.x_m * off.x_m * weight(variance.along_m2)
                    + off.y_m * off.y_m * weight(variance.across_m2)
                    + off.heading_rad * off.heading_rad * weight(variance.turn_rad2)
            })
            .sum()
    }

    /// Adds the residual of an observation.
    pub(super) fn add_line_residual(&self, observation: &LineObservation, linearization: &mut Linearization) {
        let Linearization {
            unknowns,
            system,
            kernel,
        } = linearization;
        let (Some(node), Some(landmark), Some(place)) = (
            self.nodes.get(observation.node),
            self.landmarks.get(observation.landmark),
            unknowns.landmarks.get(observation.landmark),
        ) else {
            return;
        };
        let segment = observation.segment;
        let Projection { off_m, along_m } = landmark.project(node.pose.transform(segment.middle));
        let off_rad = normalize_rad(node.pose.heading_rad + segment.normal_rad - landmark.normal_rad);
        let (variance_m2, variance_rad2) = (
            segment.sigma_m * segment.sigma_m,
            segment.sigma_rad * segment.sigma_rad,
        );
        let misfit = off_m * off_m / variance_m2 + off_rad * off_rad / variance_rad2;
        let weight = 1.0 / (1.0 + misfit / *kernel);
        let normal = direction(landmark.normal_rad);
        let arm = node.pose.transform(segment.middle);
        let (arm_x, arm_y) = (arm.x_m - node.pose.x_m, arm.y_m - node.pose.y_m);
        let at = 3 * observation.node;
        let turned = if landmark.quarter.is_some() {
            unknowns.manhattan
        } else {
            place + 1
        };
        let slopes = [(at + 2, 1.0), (turned, -1.0)];
        system.add_residual(&slopes, off_rad, weight / variance_rad2);
        let slopes = [
            (at, normal.x_m),
            (at + 1, normal.y_m),
            (at + 2, normal.y_m * arm_x - normal.x_m * arm_y),
            (*place, -1.0),
            (turned, along_m),
        ];
        system.add_residual(&slopes, off_m, weight / variance_m2);
    }

    /// Counts all turns with this scale.
    pub(super) fn recount(&mut self, scale: f64) {
        for node in &mut self.nodes {
            node.recount(scale);
        }
    }

    pub(super) fn apply(&mut self, unknowns: &Unknowns, change: &[f64]) {
        let step = |unknown: usize| {
            change.get(unknown).map_or(0.0, |step| {
                step.clamp(-OPTIMIZATION.step_max, OPTIMIZATION.step_max)
            })
        };
        for (index, node) in self.nodes.iter_mut().enumerate() {
            node.pose = Pose2 {
                x_m: node.pose.x_m + step(3 * index),
                y_m: node.pose.y_m + step(3 * index + 1),
                heading_rad: normalize_rad(node.pose.heading_rad + step(3 * index + 2)),
            };
        }
        if let Some(manhattan_rad) = &mut self.manhattan_rad {
            *manhattan_rad += step(unknowns.manhattan);
        }
        self.turn_errors.apply(unknowns.turns, step);
        self.recount(self.turn_errors.scale);
        for (landmark, place) in self.landmarks.iter_mut().zip(&unknowns.landmarks) {
            landmark.offset_m += step(*place);
            landmark.normal_rad = match (landmark.quarter, self.manhattan_rad) {
                (Some(quarter), Some(manhattan_rad)) => {
                    normalize_rad(manhattan_rad + f64::from(quarter) * FRAC_PI_2)
                }
                _ => normalize_rad(landmark.normal_rad + step(place + 1)),
            };
        }
    }

    /// Distance of an observation from its landmark, metres; 0 when one of them is gone.
    pub(super) fn off_m(&self, observation: &LineObservation) -> f64 {
        match (
            self.nodes.get(observation.node),
            self.landmarks.get(observation.landmark),
        ) {
            (Some(node), Some(landmark)) => {
                landmark
                    .project(node.pose.transform(observation.segment.middle))
                    .off_m
            }
            _ => 0.0,
        }
    }

    /// Resets the ends and the observation counts of all landmarks.
    pub(super) fn reset_extents(&mut self) {
        for landmark in &mut self.landmarks {
            (landmark.low_m, landmark.high_m, landmark.observation_count) =
                (f64::INFINITY, f64::NEG_INFINITY, 0);
            landmark.first = usize::MAX;
        }
    }

    /// Extends the landmark of an observation to the ends of that observation.
    pub(super) fn extend_landmark(&mut self, observation: &LineObservation) {
        let (Some(node), Some(landmark)) = (
            self.nodes.get(observation.node),
            self.landmarks.get_mut(observation.landmark),
        ) else {
            return;
        };
        let Projection { along_m, .. } = landmark.project(node.pose.transform(observation.segment.middle));
        landmark.low_m = landmark.low_m.min(along_m - observation.segment.half_m);
        landmark.high_m = landmark.high_m.max(along_m + observation.segment.half_m);
        landmark.first = landmark.first.min(observation.node);
        landmark.observation_count += 1;
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::{Graph, LineLandmark, LineObservation, Node, Turns, direction};
    use crate::localization::line_slam::kalman::StepVariance;
    use crate::localization::line_slam::line_segment::LineSegment;
    use crate::localization::line_slam::optimization::optimized;
    use crate::model::geometry::{Point2, Pose2, normalize_rad};
    use crate::model::random::Random;
    use core::f64::consts::FRAC_PI_2;

    const VARIANCE: StepVariance = StepVariance {
        along_m2: 1e-4,
        across_m2: 1e-4,
        turn_rad2: 1e-4,
    };

    /// Two laps along the inside of a room of 5 by 3 m that is rotated by `turned_rad`. There is a node every half metre. Steps
    /// have errors, walls are seen exactly.
    pub(in crate::localization::line_slam) fn laps(turned_rad: f64, seed: u64) -> (Graph, Vec<Pose2>) {
        let mut random = Random::new(seed);
        let (mut truth, mut graph) = (Vec::new(), Graph::default());
        let begin = Pose2 {
            x_m: 0.0,
            y_m: 0.0,
            heading_rad: turned_rad,
        };
        let mut pose = begin;
        for (quarter, steps) in [10, 6, 10, 6].into_iter().enumerate() {
            let quarter = quarter as u8;
            graph.landmarks.push(LineLandmark {
                quarter: None,
                normal_rad: normalize_rad(turned_rad + f64::from(quarter + 1) * FRAC_PI_2),
                anchor: pose.transform(Point2 { x_m: 0.0, y_m: -0.3 }),
                offset_m: 0.0,
                low_m: -5.0,
                high_m: 5.0,
                first: truth.len(),
                observation_count: 0,
                is_distinct: false,
            });
            for _ in 0..steps {
                truth.push(pose);
                pose = pose.after_arc(0.5, 0.0);
            }
            pose = pose.after_arc(0.0, FRAC_PI_2);
        }
        let lap = truth.clone();
        truth.extend(lap);
        let mut believed = begin;
        for (index, is) in truth.iter().enumerate() {
            let before = index.checked_sub(1).map_or(begin, |before| truth[before]);
            let made = before.inverse() * *is;
            let step = Pose2 {
                x_m: made.x_m + 0.01 * random.normal(),
                y_m: made.y_m + 0.01 * random.normal(),
                heading_rad: made.heading_rad + 0.01 * random.normal(),
            };
            if index > 0 {
                believed = believed * step;
            }
            graph.nodes.push(Node {
                time_us: index as u64,
                odom: believed,
                pose: believed,
                step,
                variance: VARIANCE,
                turns: Turns::default(),
            });
            let side = match index % 32 {
                0..10 => 0,
                10..16 => 1,
                16..26 => 2,
                _ => 3,
            };
            graph.observations.push(LineObservation {
                node: index,
                landmark: side,
                segment: LineSegment {
                    middle: Point2 { x_m: 0.0, y_m: -0.3 },
                    normal_rad: FRAC_PI_2,
                    half_m: 0.25,
                    sigma_rad: 0.02,
                    sigma_m: 0.012,
                },
            });
        }
        (graph, truth)
    }

    pub(in crate::localization::line_slam) fn rmse_m(graph: &Graph, truth: &[Pose2]) -> f64 {
        let squares: f64 = graph
            .nodes
            .iter()
            .zip(truth)
            .map(|(node, is)| node.pose.position().distance_m(is.position()).powi(2))
            .sum();
        (squares / truth.len() as f64).sqrt()
    }

    // Noise has tails, so these tests use fixed seeds.
    #[test]
    fn laps_close_whatever_the_direction_of_the_home() {
        let mut sums_m = [0.0; 2];
        for seed in 1..60 {
            let (mut graph, truth) = laps(0.1 * seed as f64 - 3.0, seed);
            sums_m[0] += rmse_m(&graph, &truth);
            assert!(optimized(&mut graph));
            let after_m = rmse_m(&graph, &truth);
            assert!(after_m < 0.2, "{after_m} m with seed {seed}");
            sums_m[1] += after_m;
        }
        assert!(
            sums_m[1] < 0.6 * sums_m[0],
            "{sums_m:?} m in all, before and after"
        );
    }

    #[test]
    fn a_wrong_association_does_not_bend_the_map() {
        for seed in 1..60 {
            let (mut graph, truth) = laps(0.0, seed);
            assert!(optimized(&mut graph));
            let right_m = rmse_m(&graph, &truth);
            // From the middle of the second lap the robot sees a cupboard 25 cm in front of the wall.
            graph.observations[37].segment.middle.y_m = -0.05;
            assert!(optimized(&mut graph));
            let off_m = graph.off_m(&graph.observations[37]);
            assert!(off_m > 0.2, "{off_m} m with seed {seed}");
            assert!(rmse_m(&graph, &truth) < right_m + 0.03, "seed {seed}");
        }
    }

    #[test]
    fn right_angles_keep_the_heading_when_every_wall_is_seen_once() {
        let mut off = [0.0; 2];
        for seed in 1..20 {
            for (off, manhattan_rad) in off.iter_mut().zip([None, Some(0.0)]) {
                let (mut graph, truth) = laps(0.0, seed);
                graph.manhattan_rad = manhattan_rad;
                graph.nodes.truncate(32);
                graph.observations.truncate(32);
                for (quarter, landmark) in graph.landmarks.iter_mut().enumerate() {
                    landmark.quarter = manhattan_rad.map(|_| (quarter as u8 + 1) % 4);
                }
                assert!(optimized(&mut graph));
                *off += graph.nodes[31].pose.position().distance_m(truth[31].position());
            }
        }
        assert!(off[1] < 0.8 * off[0], "{off:?}");
    }

    #[test]
    fn points_project_in_front_of_a_landmark_or_behind_it() {
        let (graph, _) = laps(0.7, 1);
        let landmark = graph.landmarks[0];
        let before = direction(landmark.normal_rad);
        let at = |distance_m: f64| Point2 {
            x_m: landmark.anchor.x_m + distance_m * before.x_m,
            y_m: landmark.anchor.y_m + distance_m * before.y_m,
        };
        assert!((landmark.project(at(0.2)).off_m - 0.2).abs() < 1e-9);
        assert!((landmark.project(at(-0.1)).off_m + 0.1).abs() < 1e-9);
    }
}
