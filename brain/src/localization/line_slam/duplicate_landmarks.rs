//! Duplicate landmarks: two landmarks that are the same wall, because the robot came back to it with more drift than data
//! association accepts.
//!
//! Take two landmarks that face the same way, one close in front of the other. The rear one cannot have been seen through the front
//! one, because the beams or the robot would have crossed it. So both are one wall, or something was moved. A merge hypothesis
//! decides: merge both, optimize the graph ([`super::graph_fit`]), and keep the merge when the graph stays consistent.

use super::cleanup::{face_the_same_way, merge};
use super::graph::{Graph, LineLandmark, LineObservation, Projection};
use super::parameters::{CLEANUP, DUPLICATE};
use std::collections::BTreeMap;

/// A landmark that seems to be the same wall as an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DuplicateLandmark {
    /// The landmark that was seen first.
    pub(super) earlier: usize,
    /// The landmark that was seen later.
    pub(super) later: usize,
}

/// A stretch of a landmark as one observation shows it.
#[derive(Clone, Copy, Debug)]
struct ObservedStretch {
    /// Distance in front of the landmark, metres.
    off_m: f64,
    /// Distance of the robot in front of the landmark, metres.
    from_m: f64,
    /// Ends along the landmark, in stretches.
    low: i32,
    high: i32,
}

/// Finds the duplicates. Each landmark is the later one of at most one pair, and never also the earlier one of another pair.
pub(super) fn duplicates(graph: &Graph) -> Vec<DuplicateLandmark> {
    let observations = observations_by_landmark(graph);
    let landmarks = || graph.landmarks.iter().zip(&observations).enumerate();
    let mut duplicates: Vec<(i32, DuplicateLandmark)> = Vec::new();
    for (back, (landmark, observations)) in landmarks() {
        let seen = seen_from(graph, landmark, observations);
        for (front, (other, observations)) in landmarks() {
            if front != back && is_close_before(other, landmark) {
                let stretches = hidden_stretches(graph, landmark, &seen, observations);
                if f64::from(stretches) * DUPLICATE.stretch_m >= DUPLICATE.length_min_m {
                    duplicates.push((stretches, in_time(graph, back, front)));
                }
            }
        }
    }
    duplicates.sort_by_key(|(stretches, _)| core::cmp::Reverse(*stretches));
    let mut chosen: Vec<DuplicateLandmark> = Vec::new();
    for (_, duplicate) in duplicates {
        let is_free = |landmark: usize| chosen.iter().all(|other| other.later != landmark);
        let is_kept = chosen.iter().any(|other| other.earlier == duplicate.later);
        if is_free(duplicate.earlier) && is_free(duplicate.later) && !is_kept {
            chosen.push(duplicate);
        }
    }
    chosen
}

fn observations_by_landmark(graph: &Graph) -> Vec<Vec<&LineObservation>> {
    let mut observations = vec![Vec::new(); graph.landmarks.len()];
    for observation in &graph.observations {
        if let Some(of_landmark) = observations.get_mut(observation.landmark) {
            of_landmark.push(observation);
        }
    }
    observations
}

/// Whether the two are close enough to compare their observations.
fn is_close_before(front: &LineLandmark, back: &LineLandmark) -> bool {
    if front.is_distinct || back.is_distinct || !face_the_same_way(front, back) {
        return false;
    }
    let (low, high) = (
        back.project(front.at(front.low_m)),
        back.project(front.at(front.high_m)),
    );
    let is_before = low.off_m.max(high.off_m) > DUPLICATE.before_min_m
        && low.off_m.min(high.off_m) < DUPLICATE.before_max_m;
    is_before && low.along_m.max(high.along_m) > back.low_m && low.along_m.min(high.along_m) < back.high_m
}

/// Greatest distance from which each stretch of a landmark was seen, metres.
fn seen_from(
    graph: &Graph,
    landmark: &LineLandmark,
    observations: &[&LineObservation],
) -> BTreeMap<i32, f64> {
    let mut seen = BTreeMap::new();
    for stretch in observations
        .iter()
        .filter_map(|observation| ObservedStretch::of(graph, observation, landmark))
    {
        for place in stretch.low..stretch.high {
            let from_m: &mut f64 = seen.entry(place).or_insert(stretch.from_m);
            *from_m = from_m.max(stretch.from_m);
        }
    }
    seen
}

/// Number of stretches of a landmark that were seen although these observations lie in front of them.
fn hidden_stretches(
    graph: &Graph,
    landmark: &LineLandmark,
    seen: &BTreeMap<i32, f64>,
    observations: &[&LineObservation],
) -> i32 {
    let mut hidden: Vec<i32> = Vec::new();
    for stretch in observations
        .iter()
        .filter_map(|observation| ObservedStretch::of(graph, observation, landmark))
    {
        let is_between =
            |from_m: f64| stretch.off_m > DUPLICATE.before_min_m && stretch.off_m < from_m + DUPLICATE.body_m;
        hidden.extend(
            (stretch.low..stretch.high).filter(|place| seen.get(place).copied().is_some_and(is_between)),
        );
    }
    hidden.sort_unstable();
    hidden.dedup();
    i32::try_from(hidden.len()).unwrap_or(i32::MAX)
}

impl ObservedStretch {
    fn of(graph: &Graph, observation: &LineObservation, landmark: &LineLandmark) -> Option<Self> {
        let pose = graph.nodes.get(observation.node)?.pose;
        let Projection { off_m, along_m } = landmark.project(pose.transform(observation.segment.middle));
        let low = libm::round((along_m - observation.segment.half_m) / DUPLICATE.stretch_m) as i32;
        let length = libm::round(2.0 * observation.segment.half_m / DUPLICATE.stretch_m) as i32;
        Some(Self {
            off_m,
            from_m: landmark.project(pose.position()).off_m,
            low,
            high: low.saturating_add(length.min(DUPLICATE.stretches_max)),
        })
    }
}

fn in_time(graph: &Graph, one: usize, other: usize) -> DuplicateLandmark {
    let first = |landmark: usize| {
        graph
            .landmarks
            .get(landmark)
            .map_or(usize::MAX, |landmark| landmark.first)
    };
    if first(one) <= first(other) {
        DuplicateLandmark {
            earlier: one,
            later: other,
        }
    } else {
        DuplicateLandmark {
            earlier: other,
            later: one,
        }
    }
}

/// A merge of duplicates that the next optimization accepts or rejects.
#[derive(Clone, Debug)]
pub(super) struct MergeHypothesis {
    /// The graph before the merge.
    graph: Graph,
    merged_into: Vec<Option<usize>>,
    duplicates: Vec<DuplicateLandmark>,
}

impl MergeHypothesis {
    /// Keeps the graph as it is before the merge.
    pub(super) fn new(
        graph: &Graph,
        merged_into: &[Option<usize>],
        duplicates: Vec<DuplicateLandmark>,
    ) -> Self {
        Self {
            graph: graph.clone(),
            merged_into: merged_into.to_vec(),
            duplicates,
        }
    }

    /// Merges the duplicates. Returns the new index of each landmark.
    pub(super) fn merge(&self, graph: &mut Graph) -> Vec<Option<usize>> {
        let mut merged: Vec<usize> = (0..graph.landmarks.len()).collect();
        for duplicate in &self.duplicates {
            if let Some(place) = merged.get_mut(duplicate.later) {
                *place = duplicate.earlier;
            }
        }
        merge(graph, &merged)
    }

    /// The graph before the merge, with the rejected pairs marked as distinct.
    pub(super) fn reverted(mut self, rejected: &[DuplicateLandmark]) -> (Graph, Vec<Option<usize>>) {
        for duplicate in rejected {
            if let Some(landmark) = self.graph.landmarks.get_mut(duplicate.later) {
                landmark.is_distinct = true;
            }
        }
        (self.graph, self.merged_into)
    }

    /// The duplicates that the optimized graph rejects, or all of them when the optimization failed. The optimization neither adds
    /// nor removes observations, so both graphs have the same ones.
    pub(super) fn rejected(&self, fitted: Option<&Graph>) -> Vec<DuplicateLandmark> {
        let Some(fitted) = fitted else {
            return self.duplicates.clone();
        };
        let is_later = |observation: &LineObservation| {
            self.duplicates
                .iter()
                .any(|duplicate| duplicate.later == observation.landmark)
        };
        let (mut merged, mut outliers) = (0_u32, 0_u32);
        for (was, is) in self.graph.observations.iter().zip(&fitted.observations) {
            merged += u32::from(is_later(was));
            outliers += u32::from(!is_later(was) && fitted.off_m(is).abs() > CLEANUP.outlier_m);
        }
        let is_rejected = |duplicate: &&DuplicateLandmark| {
            self.inlier_share(duplicate, fitted) < DUPLICATE.inlier_share_min
        };
        let rejected: Vec<DuplicateLandmark> = self.duplicates.iter().filter(is_rejected).copied().collect();
        let is_bent = fitted.odometry_chi_square()
            > self.graph.fitted_chi_square + DUPLICATE.chi_square_rise_max
            || f64::from(outliers) > DUPLICATE.outlier_share_max * f64::from(merged);
        if rejected.is_empty() && is_bent {
            // One pair must be wrong: the one with the least evidence.
            return self.duplicates.last().copied().into_iter().collect();
        }
        rejected
    }

    /// Share of the later landmark's observations that lie on the earlier one.
    fn inlier_share(&self, duplicate: &DuplicateLandmark, fitted: &Graph) -> f64 {
        let (mut all, mut inliers) = (0_u32, 0_u32);
        for (was, is) in self.graph.observations.iter().zip(&fitted.observations) {
            if was.landmark == duplicate.later {
                all += 1;
                inliers += u32::from(fitted.off_m(is).abs() <= CLEANUP.outlier_m);
            }
        }
        f64::from(inliers) / f64::from(all.max(1))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::graph::tests::{laps, rmse_m};
    use super::super::kalman::StepVariance;
    use super::super::optimization::optimized;
    use super::{DuplicateLandmark, Graph, LineObservation, duplicates};
    use crate::localization::line_slam::graph_fit::tests::fitted;
    use crate::model::geometry::{Point2, Pose2};

    /// Nodes of the first lap, and walls of the room.
    const LAP: usize = 32;
    const LANDMARKS: usize = 4;

    /// Two laps through a room, optimized.
    fn room(seed: u64) -> (Graph, Vec<Pose2>) {
        let (mut graph, truth) = laps(0.0, seed);
        assert!(optimized(&mut graph));
        graph.fitted_chi_square = graph.odometry_chi_square();
        (graph, truth)
    }

    /// Two laps through a room with an error of `drift` between them. The second lap has landmarks of its own. Returns the true
    /// poses, too.
    pub(in crate::localization::line_slam) fn seen_twice(
        drift: Point2,
        sigma_m: f64,
        seed: u64,
    ) -> (Graph, Vec<Pose2>) {
        let (mut graph, truth) = room(seed);
        for landmark in 0..LANDMARKS {
            let mut later = graph.landmarks[landmark];
            later.anchor.x_m += drift.x_m;
            later.anchor.y_m += drift.y_m;
            graph.landmarks.push(later);
        }
        for observation in graph
            .observations
            .iter_mut()
            .filter(|observation| observation.node >= LAP)
        {
            observation.landmark += LANDMARKS;
        }
        for node in &mut graph.nodes[LAP..] {
            node.pose.x_m += drift.x_m;
            node.pose.y_m += drift.y_m;
        }
        graph.nodes[LAP].step = graph.nodes[LAP - 1].pose.inverse() * graph.nodes[LAP].pose;
        graph.nodes[LAP].variance = StepVariance {
            along_m2: sigma_m * sigma_m,
            across_m2: sigma_m * sigma_m,
            turn_rad2: 1e-4,
        };
        (graph, truth)
    }

    /// Moves these observations in front of the first wall. The robot drives along that wall with the wall to its right.
    fn see_before(graph: &mut Graph, off_m: f64, is_of_it: impl Fn(&LineObservation) -> bool) {
        let mut before = graph.landmarks[0];
        before.anchor.y_m += off_m;
        graph.landmarks.push(before);
        for observation in graph
            .observations
            .iter_mut()
            .filter(|observation| is_of_it(observation))
        {
            observation.landmark = LANDMARKS;
            observation.segment.middle.y_m += off_m;
        }
    }

    fn drift(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_room_entered_twice_with_drift_is_merged() {
        for seed in 1..20 {
            for drift in [drift(0.25, -0.2), drift(-0.35, 0.38)] {
                let (since, truth) = seen_twice(drift, 0.25, seed);
                let before_m = rmse_m(&since, &truth);
                let fitted = fitted(&since).0;
                assert!(fitted.has_merged, "seed {seed}, {drift:?}");
                let graph = fitted.extended_with(&since);
                assert_eq!(graph.landmarks.len(), LANDMARKS, "seed {seed}, {drift:?}");
                let after_m = rmse_m(&graph, &truth);
                assert!(
                    after_m < 0.5 * before_m,
                    "{before_m} and {after_m} m, seed {seed}, {drift:?}"
                );
            }
        }
    }

    #[test]
    fn moved_furniture_is_not_taken_for_drift() {
        for seed in 1..20 {
            let (mut since, truth) = room(seed);
            let before_m = rmse_m(&since, &truth);
            // A sofa of two metres along the first wall was pulled out by 25 cm before the second lap.
            see_before(&mut since, 0.25, |observation| {
                (LAP + 3..LAP + 7).contains(&observation.node)
            });
            assert_eq!(
                duplicates(&since),
                [DuplicateLandmark {
                    earlier: 0,
                    later: LANDMARKS
                }],
                "seed {seed}"
            );
            let fitted = fitted(&since).0;
            assert!(!fitted.has_merged, "seed {seed}");
            let graph = fitted.extended_with(&since);
            assert!(
                graph.landmarks.len() == LANDMARKS + 1 && graph.landmarks[LANDMARKS].is_distinct,
                "seed {seed}"
            );
            assert_eq!(duplicates(&graph), [], "it is not tried later");
            assert!(rmse_m(&graph, &truth) < before_m + 0.02, "seed {seed}");
        }
    }

    #[test]
    fn walls_behind_each_other_without_contradiction_are_no_duplicates() {
        let (mut since, _) = room(1);
        // The robot was 30 cm from the first wall. A screen half a metre in front of the wall is behind the robot.
        see_before(&mut since, 0.5, |observation| {
            observation.node >= LAP && observation.landmark == 0
        });
        assert_eq!(duplicates(&since), []);
        let (mut since, _) = room(1);
        // A cupboard along the second half of the wall hides that half.
        see_before(&mut since, 0.3, |observation| {
            observation.landmark == 0 && observation.node % LAP >= 5
        });
        assert_eq!(duplicates(&since), []);
    }
}
