//! Optimizes the whole graph in the background, while the robot drives on.
//!
//! The optimization works on a copy of the graph in many short steps. A home has thousands of unknowns, and a small board would
//! need seconds at once. When it is done, its result replaces the graph. Nodes and observations that came meanwhile move rigidly
//! with the last optimized pose.

use super::cleanup::clean_up;
use super::duplicate_landmarks::{MergeHypothesis, duplicates};
use super::graph::{Graph, LineObservation};
use super::manhattan::{align, align_to_manhattan};
use super::optimization::{CaptureRange, optimize};
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::gradual::{Gradual, StepBudget};

/// Work of one step: a quarter of a millisecond on one desktop core.
const STEP_WORK: usize = 300_000;

/// An optimization in progress.
#[derive(Debug)]
struct GraphFit {
    graph: Graph,
    /// For each landmark at the start, its present index; `None` = it was dropped.
    merged_into: Vec<Option<usize>>,
    /// Number of observations at the start.
    observations: usize,
    /// The last pose at the start.
    last: Pose2,
    /// Duplicate landmarks that are merged on trial.
    hypothesis: Option<Box<MergeHypothesis>>,
}

/// Whether the graph is consistent with a merge hypothesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MergeVerdict {
    /// It is, or there is no hypothesis.
    Accepted,
    /// Some merges are wrong. The optimization runs again without them.
    Rejected,
}

/// Starts to optimize a copy of the graph. The result is `None` when there is no solution. Does not start while the graph has no
/// nodes.
pub(super) fn begin(graph: &Graph) -> Option<Gradual<Option<FittedGraph>>> {
    let fit = GraphFit::of(graph)?;
    Some(Gradual::new(async move {
        fit.fitted(&mut StepBudget::of(STEP_WORK)).await
    }))
}

impl GraphFit {
    fn of(graph: &Graph) -> Option<Self> {
        Some(Self {
            merged_into: (0..graph.landmarks.len()).map(Some).collect(),
            observations: graph.observations.len(),
            last: graph.nodes.last()?.pose,
            hypothesis: None,
            graph: graph.clone(),
        })
    }

    /// Runs all of it. Each part except the optimization is one pass over the observations and one step.
    async fn fitted(mut self, budget: &mut StepBudget) -> Option<FittedGraph> {
        self.clean_up();
        loop {
            budget.pause().await;
            self.merge_duplicates();
            budget.pause().await;
            align_to_manhattan(&mut self.graph);
            budget.pause().await;
            let reach = match self.hypothesis {
                Some(_) => CaptureRange::Far,
                None => CaptureRange::Near,
            };
            let is_solved = optimize(&mut self.graph, reach, budget).await;
            if self.judge_merge(is_solved)? == MergeVerdict::Accepted {
                break;
            }
        }
        budget.pause().await;
        self.clean_up();
        Some(self.into_fitted())
    }

    fn clean_up(&mut self) {
        let places = clean_up(&mut self.graph);
        self.follow(&places);
    }

    /// Landmarks have new indices or were dropped.
    fn follow(&mut self, places: &[Option<usize>]) {
        for landmark in &mut self.merged_into {
            *landmark = landmark.and_then(|landmark| places.get(landmark).copied().flatten());
        }
    }

    /// Merges landmarks that seem to be duplicates, on trial.
    fn merge_duplicates(&mut self) {
        let duplicates = duplicates(&self.graph);
        if duplicates.is_empty() {
            return;
        }
        let hypothesis = MergeHypothesis::new(&self.graph, &self.merged_into, duplicates);
        let places = hypothesis.merge(&mut self.graph);
        self.follow(&places);
        self.hypothesis = Some(Box::new(hypothesis));
    }

    /// Reverts merges that are wrong, or with which there is no solution. `None` when there is no solution without merges either.
    fn judge_merge(&mut self, is_solved: bool) -> Option<MergeVerdict> {
        let Some(hypothesis) = self.hypothesis.take() else {
            return is_solved.then_some(MergeVerdict::Accepted);
        };
        let rejected = hypothesis.rejected(is_solved.then_some(&self.graph));
        if rejected.is_empty() {
            self.hypothesis = Some(hypothesis);
            return Some(MergeVerdict::Accepted);
        }
        (self.graph, self.merged_into) = hypothesis.reverted(&rejected);
        Some(MergeVerdict::Rejected)
    }

    fn into_fitted(mut self) -> FittedGraph {
        self.graph.fitted_chi_square = self.graph.odometry_chi_square();
        let last = self.graph.nodes.last().map_or(self.last, |node| node.pose);
        FittedGraph {
            moved: last * self.last.inverse(),
            has_merged: self.hypothesis.is_some(),
            graph: self.graph,
            merged_into: self.merged_into,
            observations: self.observations,
        }
    }
}

/// A completed optimization.
#[derive(Clone, Debug)]
pub(super) struct FittedGraph {
    graph: Graph,
    /// Rigid motion of everything that came since, in the map.
    pub(super) moved: Pose2,
    /// Duplicate landmarks were merged.
    pub(super) has_merged: bool,
    merged_into: Vec<Option<usize>>,
    observations: usize,
}

impl FittedGraph {
    /// The optimized graph with all nodes, landmarks and observations that were added to `since` after the start.
    pub(super) fn extended_with(mut self, since: &Graph) -> Graph {
        let known = self.graph.nodes.len();
        for node in since.nodes.iter().skip(known) {
            let mut node = *node;
            node.pose = self.moved * node.pose;
            self.graph.nodes.push(node);
        }
        self.graph.docked.clone_from(&since.docked);
        let epochs = &mut self.graph.turn_errors.epochs;
        epochs.extend(since.turn_errors.epochs.iter().skip(epochs.len()).copied());
        for landmark in since.landmarks.iter().skip(self.merged_into.len()) {
            let mut landmark = *landmark;
            landmark.anchor = self.moved.transform(landmark.anchor);
            landmark.normal_rad = normalize_rad(landmark.normal_rad + self.moved.heading_rad);
            align(&mut landmark, self.graph.manhattan_rad);
            landmark.observation_count = 0;
            self.merged_into.push(Some(self.graph.landmarks.len()));
            self.graph.landmarks.push(landmark);
        }
        for observation in since.observations.iter().skip(self.observations) {
            if let Some(landmark) = self.merged_into.get(observation.landmark).copied().flatten() {
                let observation = LineObservation {
                    landmark,
                    ..*observation
                };
                self.graph.extend_landmark(&observation);
                self.graph.observations.push(observation);
            }
        }
        self.graph
    }
}

#[cfg(test)]
pub(super) mod tests {
    use core::task::Poll;

    use super::{FittedGraph, GraphFit, MergeVerdict, begin};
    use crate::localization::line_slam::duplicate_landmarks::tests::seen_twice;
    use crate::localization::line_slam::graph::tests::{laps, rmse_m};
    use crate::localization::line_slam::graph::{Graph, LineLandmark};
    use crate::model::geometry::Point2;

    /// Optimizes a graph and counts the steps.
    pub(in crate::localization::line_slam) fn fitted(graph: &Graph) -> (FittedGraph, u32) {
        let mut fit = begin(graph).unwrap();
        let mut steps = 1;
        loop {
            match fit.go_on() {
                Poll::Ready(fitted) => return (fitted.unwrap(), steps),
                Poll::Pending => steps += 1,
            }
        }
    }

    #[test]
    fn optimization_takes_several_steps_and_moves_later_nodes_along() {
        for seed in 1..20 {
            let (since, truth) = laps(0.2, seed);
            let mut began = since.clone();
            began.nodes.truncate(50);
            began.observations.truncate(50);
            let (fitted, steps) = fitted(&began);
            assert!(steps >= 4, "{steps} steps");
            let graph = fitted.extended_with(&since);
            assert_eq!(graph.nodes.len(), since.nodes.len());
            for (before, after) in graph.nodes.windows(2).zip(since.nodes.windows(2)).skip(49) {
                let (made, was) = (
                    before[0].pose.inverse() * before[1].pose,
                    after[0].pose.inverse() * after[1].pose,
                );
                assert!(made.position().distance_m(was.position()) < 1e-9, "seed {seed}");
            }
            let (before_m, after_m) = (rmse_m(&since, &truth), rmse_m(&graph, &truth));
            assert!(
                after_m < before_m.max(0.1),
                "{before_m} and {after_m} m, seed {seed}"
            );
        }
    }

    #[test]
    fn later_observations_follow_their_landmarks_and_new_landmarks_come_last() {
        let (mut began, _) = laps(0.0, 3);
        // Nothing lies on the first landmark, so the other indices move down by one.
        began.observations.retain(|observation| observation.landmark != 0);
        let mut since = began.clone();
        let landmark = LineLandmark {
            first: since.nodes.len() - 1,
            ..since.landmarks[2]
        };
        since.landmarks.push(landmark);
        for landmark in [0, 2, 4] {
            let observation = began.observations[5];
            since.observations.push(super::LineObservation {
                landmark,
                ..observation
            });
        }
        let graph = fitted(&began).0.extended_with(&since);
        assert_eq!(graph.landmarks.len(), 4);
        let news: Vec<usize> = graph
            .observations
            .iter()
            .rev()
            .take(2)
            .map(|observation| observation.landmark)
            .collect();
        assert_eq!(
            news,
            [3, 1],
            "the observation on the landmark that is gone is gone"
        );
        let count: u32 = graph
            .landmarks
            .iter()
            .map(|landmark| landmark.observation_count)
            .sum();
        assert_eq!(count as usize, graph.observations.len());
    }

    #[test]
    fn duplicates_without_a_solution_are_not_tried_again() {
        let drift = Point2 { x_m: 0.25, y_m: -0.2 };
        let (graph, _) = seen_twice(drift, 0.25, 1);
        let mut fit = GraphFit::of(&graph).expect("a graph with nodes");
        fit.clean_up();
        fit.merge_duplicates();
        assert!(fit.hypothesis.is_some());
        assert_eq!(fit.judge_merge(false), Some(MergeVerdict::Rejected));
        assert_eq!(
            fit.graph.landmarks.len(),
            graph.landmarks.len(),
            "as it was before"
        );
        fit.merge_duplicates();
        assert!(fit.hypothesis.is_none(), "they are apart");
        assert!(fit.judge_merge(false).is_none(), "then nothing fits at all");
    }
}
