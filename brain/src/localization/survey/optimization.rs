//! All poses and walls moved to where they fit best, by Gauss and Newton, piece by piece.

use core::task::Poll;

use super::graph::{Graph, KERNEL, Unknowns};
use super::linear::{Solving, System};
use super::work::Work;

/// Most rounds, and steps that end them, metres or radians.
const ROUNDS: usize = 5;
const STILL: f64 = 5e-4;
/// Work of a step between two nodes, of a mark, and of moving a node.
const STEP_WORK: usize = 250;
const MARK_WORK: usize = 250;
const MOVE_WORK: usize = 15;

/// Rounds in which marks count that are far off, and what counts fully then, in squared deviations: half a metre.
const WIDE_ROUNDS: usize = 3;
const WIDE_KERNEL: f64 = 500.0;

/// The rounds.
#[derive(Clone, Debug, Default)]
pub(super) struct Optimization {
    /// So many of them come first in which marks count that are far off.
    wide: usize,
    rounds: usize,
    round: Round,
}

/// What a round is about to do.
#[derive(Clone, Debug, Default)]
enum Round {
    #[default]
    Begin,
    /// Steps, then marks, then stands on the dock, go into the system.
    Gather {
        unknowns: Unknowns,
        system: System,
        next: usize,
    },
    Solve {
        unknowns: Unknowns,
        solving: Solving,
    },
}

impl Optimization {
    /// One that pulls marks over, which lie on walls that they are far from.
    pub(super) fn from_far() -> Self {
        Self {
            wide: WIDE_ROUNDS,
            ..Self::default()
        }
    }

    fn kernel(&self) -> f64 {
        if self.rounds < self.wide {
            WIDE_KERNEL
        } else {
            KERNEL
        }
    }

    /// Goes on while work is left, with the same graph each time. Gives whether there is a best place for all.
    pub(super) fn go_on(&mut self, graph: &mut Graph, work: &mut Work) -> Poll<bool> {
        while work.is_left() {
            match core::mem::take(&mut self.round) {
                Round::Begin => {
                    let unknowns = graph.unknowns();
                    self.round = Round::Gather {
                        system: graph.system(&unknowns),
                        unknowns,
                        next: 0,
                    };
                    work.spend(MOVE_WORK * graph.nodes.len());
                }
                Round::Gather {
                    unknowns,
                    system,
                    next,
                } => self.round = gather(unknowns, (system, next), (graph, self.kernel()), work),
                Round::Solve {
                    unknowns,
                    mut solving,
                } => match solving.go_on(work) {
                    Poll::Pending => self.round = Round::Solve { unknowns, solving },
                    Poll::Ready(None) => return Poll::Ready(false),
                    Poll::Ready(Some(solution)) => {
                        let change = solution.values;
                        graph.apply(&unknowns, &change);
                        graph.turn_errors.scale_sigma = Some(solution.last_sigma);
                        work.spend(MOVE_WORK * graph.nodes.len());
                        let is_still = change.iter().all(|step| step.abs() < STILL);
                        let is_wide = self.rounds < self.wide;
                        self.rounds += 1;
                        if !is_wide && (is_still || self.rounds == self.wide + ROUNDS) {
                            return Poll::Ready(true);
                        }
                    }
                },
            }
        }
        Poll::Pending
    }
}

/// Puts steps, marks and stands from `next` on into the system while work is left.
fn gather(
    unknowns: Unknowns,
    (mut system, mut next): (System, usize),
    (graph, kernel): (&Graph, f64),
    work: &mut Work,
) -> Round {
    let steps = graph.nodes.len().saturating_sub(1);
    while work.is_left() {
        if next < steps {
            graph.add_step(next, &unknowns, &mut system);
            work.spend(STEP_WORK);
        } else if let Some(mark) = graph.marks.get(next - steps) {
            graph.add_mark((mark, kernel), &unknowns, &mut system);
            work.spend(MARK_WORK);
        } else if next - steps - graph.marks.len() < graph.docked.len() {
            graph.add_stand(next - steps - graph.marks.len(), &mut system);
            work.spend(MARK_WORK);
        } else {
            return Round::Solve {
                unknowns,
                solving: system.solve(),
            };
        }
        next += 1;
    }
    Round::Gather {
        unknowns,
        system,
        next,
    }
}

/// Does all of it at once.
#[cfg(test)]
pub(super) fn optimized(graph: &mut Graph) -> bool {
    let mut work = Work::of(usize::MAX);
    Optimization::default().go_on(graph, &mut work) == Poll::Ready(true)
}
