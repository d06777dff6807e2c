//! Walls that stand twice in the graph: the robot came to one again by another way, and was off by more than strokes are
//! looked for.
//!
//! Of two walls one close before the other, both facing the same way, the one behind cannot have been seen where the one
//! before stands now: the beams, or the robot itself, were in between. So they are one wall, or something was moved since. Which
//! of both is found out by taking them for one and fitting all anew ([`super::graph_fit`]).

use super::cleanup::{OUTLIER_M, face_the_same_way, merge};
use super::graph::{Graph, LineLandmark, LineObservation};
use std::collections::BTreeMap;

/// Walls are compared in pieces of this length along them, metres.
const PIECE_M: f64 = 0.1;
/// Most pieces of a stroke: a visit is shorter.
const LENGTH_MAX: i32 = 30;
/// So far before each other they are not one wall yet, metres; nearer ones are joined without this.
const BEFORE_M: f64 = 0.05;
/// Farther before each other they are two, metres: nothing is seen from farther away.
const BEFORE_MAX_M: f64 = 0.6;
/// The robot reaches at least this far beyond its middle, metres.
const BODY_M: f64 = 0.1;
/// Length over which a wall must stand where the robot was when it saw the other one, metres: a chair that was moved is shorter.
const ALONG_M: f64 = 0.55;

/// Of the marks of walls that are one so many lie on it in the end,
const INLIER_SHARE: f64 = 0.7;
/// and the other marks that do not lie on their walls any more are fewer than this share of them.
const OUTLIER_SHARE: f64 = 0.3;
/// What odometry may be wrong by for it, more than in the last fit, in squared deviations: 40 cm over 30 m of way. What was moved
/// tears shorter ways apart.
const CHI_SQUARE_RISE_MAX: f64 = 15.0;

/// That a wall seems to be another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DuplicateLandmark {
    /// The one that was seen first.
    pub(super) earlier: usize,
    /// The one that was seen later.
    pub(super) later: usize,
}

/// What a mark shows of a wall.
#[derive(Clone, Copy, Debug)]
struct ObservedStretch {
    /// How far before the wall it lies, metres.
    off_m: f64,
    /// How far before the wall the robot was.
    from_m: f64,
    /// Ends along the wall, in pieces.
    low: i32,
    high: i32,
}

/// Finds them: each wall at most once as the later one, and never one that is the earlier one of another pair.
pub(super) fn duplicates(graph: &Graph) -> Vec<DuplicateLandmark> {
    let observations = observations_by_landmark(graph);
    let landmarks = || graph.landmarks.iter().zip(&observations).enumerate();
    let mut duplicates: Vec<(i32, DuplicateLandmark)> = Vec::new();
    for (back, (landmark, observations)) in landmarks() {
        let seen = seen_from(graph, landmark, observations);
        for (front, (other, observations)) in landmarks() {
            if front != back && is_close_before(other, landmark) {
                let pieces = hidden_pieces(graph, (landmark, &seen), observations);
                if f64::from(pieces) * PIECE_M >= ALONG_M {
                    duplicates.push((pieces, in_time(graph, (back, front))));
                }
            }
        }
    }
    duplicates.sort_by_key(|(pieces, _)| core::cmp::Reverse(*pieces));
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

/// Whether a look at the marks is worth it.
fn is_close_before(front: &LineLandmark, back: &LineLandmark) -> bool {
    if front.is_distinct || back.is_distinct || !face_the_same_way(front, back) {
        return false;
    }
    let (low, high) = (
        back.project(front.at(front.low_m)),
        back.project(front.at(front.high_m)),
    );
    let is_before = low.0.max(high.0) > BEFORE_M && low.0.min(high.0) < BEFORE_MAX_M;
    is_before && low.1.max(high.1) > back.low_m && low.1.min(high.1) < back.high_m
}

/// From how far away each piece of a wall was seen, at most, metres.
fn seen_from(
    graph: &Graph,
    landmark: &LineLandmark,
    observations: &[&LineObservation],
) -> BTreeMap<i32, f64> {
    let mut seen = BTreeMap::new();
    for piece in observations
        .iter()
        .filter_map(|observation| ObservedStretch::of(graph, observation, landmark))
    {
        for place in piece.low..piece.high {
            let from_m: &mut f64 = seen.entry(place).or_insert(piece.from_m);
            *from_m = from_m.max(piece.from_m);
        }
    }
    seen
}

/// Pieces of a wall that was seen although what these marks show is before it.
fn hidden_pieces(
    graph: &Graph,
    (landmark, seen): (&LineLandmark, &BTreeMap<i32, f64>),
    observations: &[&LineObservation],
) -> i32 {
    let mut hidden: Vec<i32> = Vec::new();
    for piece in observations
        .iter()
        .filter_map(|observation| ObservedStretch::of(graph, observation, landmark))
    {
        let is_between = |from_m: f64| piece.off_m > BEFORE_M && piece.off_m < from_m + BODY_M;
        hidden
            .extend((piece.low..piece.high).filter(|place| seen.get(place).copied().is_some_and(is_between)));
    }
    hidden.sort_unstable();
    hidden.dedup();
    i32::try_from(hidden.len()).unwrap_or(i32::MAX)
}

impl ObservedStretch {
    fn of(graph: &Graph, observation: &LineObservation, landmark: &LineLandmark) -> Option<Self> {
        let pose = graph.nodes.get(observation.node)?.pose;
        let (off_m, along_m) = landmark.project(pose.transform(observation.segment.middle));
        let low = libm::round((along_m - observation.segment.half_m) / PIECE_M) as i32;
        let length = libm::round(2.0 * observation.segment.half_m / PIECE_M) as i32;
        Some(Self {
            off_m,
            from_m: landmark.project(pose.position()).0,
            low,
            high: low.saturating_add(length.min(LENGTH_MAX)),
        })
    }
}

fn in_time(graph: &Graph, (one, other): (usize, usize)) -> DuplicateLandmark {
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

/// Walls are taken for one, and a fit shows whether they are.
#[derive(Clone, Debug)]
pub(super) struct MergeHypothesis {
    /// All as it was before.
    graph: Graph,
    merged_into: Vec<Option<usize>>,
    duplicates: Vec<DuplicateLandmark>,
}

impl MergeHypothesis {
    /// Before these are joined.
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

    /// Joins them. Gives for each wall where it is then.
    pub(super) fn merge(&self, graph: &mut Graph) -> Vec<Option<usize>> {
        let mut merged: Vec<usize> = (0..graph.landmarks.len()).collect();
        for duplicate in &self.duplicates {
            if let Some(place) = merged.get_mut(duplicate.later) {
                *place = duplicate.earlier;
            }
        }
        merge(graph, &merged)
    }

    /// The graph as it was, with those apart that are not one.
    pub(super) fn reverted(mut self, rejected: &[DuplicateLandmark]) -> (Graph, Vec<Option<usize>>) {
        for duplicate in rejected {
            if let Some(landmark) = self.graph.landmarks.get_mut(duplicate.later) {
                landmark.is_distinct = true;
            }
        }
        (self.graph, self.merged_into)
    }

    /// Those that are not one, after a fit: all of them when nothing fits with them as one. No mark comes or goes while a graph is
    /// fitted, so that both graphs have the same.
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
            outliers += u32::from(!is_later(was) && fitted.off_m(is).abs() > OUTLIER_M);
        }
        let is_rejected =
            |duplicate: &&DuplicateLandmark| self.inlier_share(duplicate, fitted) < INLIER_SHARE;
        let rejected: Vec<DuplicateLandmark> = self.duplicates.iter().filter(is_rejected).copied().collect();
        let is_bent = fitted.odometry_chi_square() > self.graph.fitted_chi_square + CHI_SQUARE_RISE_MAX
            || f64::from(outliers) > OUTLIER_SHARE * f64::from(merged);
        if rejected.is_empty() && is_bent {
            // One of them must be wrong: the one that the least speaks for.
            return self.duplicates.last().copied().into_iter().collect();
        }
        rejected
    }

    /// Share of the later wall's marks that lie on the earlier one.
    fn inlier_share(&self, duplicate: &DuplicateLandmark, fitted: &Graph) -> f64 {
        let (mut all, mut inliers) = (0_u32, 0_u32);
        for (was, is) in self.graph.observations.iter().zip(&fitted.observations) {
            if was.landmark == duplicate.later {
                all += 1;
                inliers += u32::from(fitted.off_m(is).abs() <= OUTLIER_M);
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

    /// Two laps through a room, fitted.
    fn room(seed: u64) -> (Graph, Vec<Pose2>) {
        let (mut graph, truth) = laps(0.0, seed);
        assert!(optimized(&mut graph));
        graph.fitted_chi_square = graph.odometry_chi_square();
        (graph, truth)
    }

    /// Two laps through a room between which the robot was elsewhere: it believes to be off by `drift` in the second one, of which
    /// it has walls of its own. Gives where it was, too.
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

    /// These marks are of something that stands so far before the first wall, along which the robot drives with that to its right.
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
    fn a_room_that_was_entered_a_second_time_with_an_error_becomes_one() {
        for seed in 1..20 {
            for drift in [drift(0.25, -0.2), drift(-0.35, 0.38)] {
                let (since, truth) = seen_twice(drift, 0.25, seed);
                let before_m = rmse_m(&since, &truth);
                let fitted = fitted(&since).0;
                assert!(fitted.has_merged, "seed {seed}, {drift:?}");
                let graph = fitted.with_news_of(&since);
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
    fn what_was_moved_is_not_taken_for_the_drift_of_the_robot() {
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
            let graph = fitted.with_news_of(&since);
            assert!(
                graph.landmarks.len() == LANDMARKS + 1 && graph.landmarks[LANDMARKS].is_distinct,
                "seed {seed}"
            );
            assert_eq!(duplicates(&graph), [], "it is not tried later");
            assert!(rmse_m(&graph, &truth) < before_m + 0.02, "seed {seed}");
        }
    }

    #[test]
    fn walls_one_before_the_other_are_two_when_the_robot_passed_between_or_beside() {
        let (mut since, _) = room(1);
        // The robot was 30 cm before the first wall: half a metre before it there may be a screen.
        see_before(&mut since, 0.5, |observation| {
            observation.node >= LAP && observation.landmark == 0
        });
        assert_eq!(duplicates(&since), []);
        let (mut since, _) = room(1);
        // A cupboard along its second half, which hides the wall behind.
        see_before(&mut since, 0.3, |observation| {
            observation.landmark == 0 && observation.node % LAP >= 5
        });
        assert_eq!(duplicates(&since), []);
    }
}
