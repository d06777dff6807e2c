//! All poses and walls fitted anew, while the robot drives on.
//!
//! The fit works on a copy of the graph, in many steps of little work each: a home has some thousand unknowns, and a small
//! board would think about them for seconds. When it is done the graph takes it up, and what came to the graph meanwhile
//! is moved along with the last pose that the fit knew.

use super::doubled::{Trial, doubles};
use super::graph::{Graph, Mark};
use super::optimization::{Reach, optimize};
use super::square::{directed, square};
use super::tidy::tidy;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::gradual::{Gradual, Pace};

/// Work of a step: a quarter of a millisecond of a desktop's core.
const STEP_WORK: usize = 300_000;

/// What is fitted.
#[derive(Debug)]
struct Fit {
    graph: Graph,
    /// For each wall at the beginning the one that it became.
    became: Vec<Option<usize>>,
    /// How many marks there were at the beginning.
    marks: usize,
    /// The last pose at the beginning.
    last: Pose2,
    /// Walls that stand twice are taken for one.
    trial: Option<Box<Trial>>,
}

/// Whether walls are one that seemed to stand twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// They are, or none seemed to.
    Holds,
    /// Some are not: all is fitted again.
    Refuted,
}

/// Begins a fit of the graph as it is now, which gives `None` when nothing fits; there is none while the graph has no nodes.
pub(super) fn begin(graph: &Graph) -> Option<Gradual<Option<Fitted>>> {
    let fit = Fit::of(graph)?;
    Some(Gradual::new(
        async move { fit.fitted(&mut Pace::of(STEP_WORK)).await },
    ))
}

impl Fit {
    fn of(graph: &Graph) -> Option<Self> {
        Some(Self {
            became: (0..graph.walls.len()).map(Some).collect(),
            marks: graph.marks.len(),
            last: graph.nodes.last()?.pose,
            trial: None,
            graph: graph.clone(),
        })
    }

    /// Does all of it. Each part but the optimization is one pass over the marks, and a step of its own.
    async fn fitted(mut self, pace: &mut Pace) -> Option<Fitted> {
        self.tidy();
        loop {
            pace.pause().await;
            self.join_doubles();
            pace.pause().await;
            square(&mut self.graph);
            pace.pause().await;
            let reach = match self.trial {
                Some(_) => Reach::Far,
                None => Reach::Near,
            };
            let is_solved = optimize(&mut self.graph, reach, pace).await;
            if self.judge_doubles(is_solved)? == Verdict::Holds {
                break;
            }
        }
        pace.pause().await;
        self.tidy();
        Some(self.into_fitted())
    }

    fn tidy(&mut self) {
        let places = tidy(&mut self.graph);
        self.follow(&places);
    }

    /// Walls are elsewhere now, or gone.
    fn follow(&mut self, places: &[Option<usize>]) {
        for wall in &mut self.became {
            *wall = wall.and_then(|wall| places.get(wall).copied().flatten());
        }
    }

    /// Takes walls that seem to stand twice for one, on trial.
    fn join_doubles(&mut self) {
        let doubles = doubles(&self.graph);
        if doubles.is_empty() {
            return;
        }
        let trial = Trial::new(&self.graph, &self.became, doubles);
        let places = trial.join(&mut self.graph);
        self.follow(&places);
        self.trial = Some(Box::new(trial));
    }

    /// Walls that were not one after all, or with which nothing fits as one, are taken apart again. `None` when nothing fits anyway.
    fn judge_doubles(&mut self, is_solved: bool) -> Option<Verdict> {
        let Some(trial) = self.trial.take() else {
            return is_solved.then_some(Verdict::Holds);
        };
        let refuted = trial.refuted(is_solved.then_some(&self.graph));
        if refuted.is_empty() {
            self.trial = Some(trial);
            return Some(Verdict::Holds);
        }
        (self.graph, self.became) = trial.taken_back(&refuted);
        Some(Verdict::Refuted)
    }

    fn into_fitted(mut self) -> Fitted {
        self.graph.fitted_strain = self.graph.strain();
        let last = self.graph.nodes.last().map_or(self.last, |node| node.pose);
        Fitted {
            moved: last * self.last.inverse(),
            is_mended: self.trial.is_some(),
            graph: self.graph,
            became: self.became,
            marks: self.marks,
        }
    }
}

/// A fit that is done.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    graph: Graph,
    /// How what came since is moved, in the map.
    pub(super) moved: Pose2,
    /// Walls that stood twice are one now.
    pub(super) is_mended: bool,
    became: Vec<Option<usize>>,
    marks: usize,
}

impl Fitted {
    /// The fitted graph with what has come to `since` after the fit began.
    pub(super) fn with_news_of(mut self, since: &Graph) -> Graph {
        let known = self.graph.nodes.len();
        for node in since.nodes.iter().skip(known) {
            let mut node = *node;
            node.pose = self.moved * node.pose;
            self.graph.nodes.push(node);
        }
        self.graph.docked.clone_from(&since.docked);
        let spells = &mut self.graph.turn_errors.spells;
        spells.extend(since.turn_errors.spells.iter().skip(spells.len()).copied());
        for wall in since.walls.iter().skip(self.became.len()) {
            let mut wall = *wall;
            wall.anchor = self.moved.transform(wall.anchor);
            wall.normal_rad = normalize_rad(wall.normal_rad + self.moved.heading_rad);
            directed(&mut wall, self.graph.square_rad);
            wall.marks = 0;
            self.became.push(Some(self.graph.walls.len()));
            self.graph.walls.push(wall);
        }
        for mark in since.marks.iter().skip(self.marks) {
            if let Some(wall) = self.became.get(mark.wall).copied().flatten() {
                let mark = Mark { wall, ..*mark };
                self.graph.reach(&mark);
                self.graph.marks.push(mark);
            }
        }
        self.graph
    }
}

#[cfg(test)]
pub(super) mod tests {
    use core::task::Poll;

    use super::{Fit, Fitted, Verdict, begin};
    use crate::localization::survey::doubled::tests::seen_twice;
    use crate::localization::survey::graph::tests::{laps, rmse_m};
    use crate::localization::survey::graph::{Graph, Wall};
    use crate::model::geometry::Point2;

    /// The fit of a graph, and how many steps it took.
    pub(in crate::localization::survey) fn fitted(graph: &Graph) -> (Fitted, u32) {
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
    fn a_fit_takes_several_steps_and_what_came_meanwhile_moves_along() {
        for seed in 1..20 {
            let (since, truth) = laps(0.2, seed);
            let mut began = since.clone();
            began.nodes.truncate(50);
            began.marks.truncate(50);
            let (fitted, steps) = fitted(&began);
            assert!(steps >= 4, "{steps} steps");
            let graph = fitted.with_news_of(&since);
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
    fn marks_that_came_meanwhile_follow_their_walls_and_new_walls_come_after_the_old_ones() {
        let (mut began, _) = laps(0.0, 3);
        // Nothing lies on the first wall, so that the others move up.
        began.marks.retain(|mark| mark.wall != 0);
        let mut since = began.clone();
        let wall = Wall {
            first: since.nodes.len() - 1,
            ..since.walls[2]
        };
        since.walls.push(wall);
        for wall in [0, 2, 4] {
            let mark = began.marks[5];
            since.marks.push(super::Mark { wall, ..mark });
        }
        let graph = fitted(&began).0.with_news_of(&since);
        assert_eq!(graph.walls.len(), 4);
        let news: Vec<usize> = graph.marks.iter().rev().take(2).map(|mark| mark.wall).collect();
        assert_eq!(news, [3, 1], "the mark on the wall that is gone is gone");
        let count: u32 = graph.walls.iter().map(|wall| wall.marks).sum();
        assert_eq!(count as usize, graph.marks.len());
    }

    #[test]
    fn walls_with_which_nothing_fits_as_one_are_not_tried_again() {
        let drift = Point2 { x_m: 0.25, y_m: -0.2 };
        let (graph, _) = seen_twice(drift, 0.25, 1);
        let mut fit = Fit::of(&graph).expect("a graph with nodes");
        fit.tidy();
        fit.join_doubles();
        assert!(fit.trial.is_some());
        assert_eq!(fit.judge_doubles(false), Some(Verdict::Refuted));
        assert_eq!(fit.graph.walls.len(), graph.walls.len(), "as it was before");
        fit.join_doubles();
        assert!(fit.trial.is_none(), "they are apart");
        assert!(fit.judge_doubles(false).is_none(), "then nothing fits at all");
    }
}
