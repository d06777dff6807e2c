//! All poses and walls moved to where they fit best, by Gauss and Newton.

use super::graph::{Graph, KERNEL, Unknowns};
use crate::localization::skyline::{Solution, System};
use crate::model::gradual::Pace;
#[cfg(test)]
use crate::model::gradual::at_once;

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

/// From how far away marks pull walls over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// From near the walls on which they lie.
    Near,
    /// In the first rounds from far, too: they lie on walls that they are far from.
    Far,
}

impl Reach {
    /// So many rounds come first in which marks count that are far off.
    const fn wide_rounds(self) -> usize {
        match self {
            Self::Near => 0,
            Self::Far => WIDE_ROUNDS,
        }
    }
}

/// Moves all poses and walls. Gives whether there is a best place for all.
pub(super) async fn optimize(graph: &mut Graph, reach: Reach, pace: &mut Pace) -> bool {
    let wide = reach.wide_rounds();
    for round in 0..wide + ROUNDS {
        let kernel = if round < wide { WIDE_KERNEL } else { KERNEL };
        let unknowns = graph.unknowns();
        let mut system = graph.system(&unknowns);
        pace.spend(MOVE_WORK * graph.nodes.len()).await;
        gather(graph, (&unknowns, kernel), &mut system, pace).await;
        let Some(Solution { values, factor }) = system.solve(pace).await else {
            return false;
        };
        graph.apply(&unknowns, &values);
        graph.turn_errors.scale_sigma = Some(factor.last_sigma());
        let is_still = values.iter().all(|step| step.abs() < STILL);
        if is_still && round >= wide {
            return true;
        }
        if round + 1 < wide + ROUNDS {
            pace.spend(MOVE_WORK * graph.nodes.len()).await;
        }
    }
    true
}

/// Puts steps, marks and stands on the dock into the system.
async fn gather(graph: &Graph, (unknowns, kernel): (&Unknowns, f64), system: &mut System, pace: &mut Pace) {
    for step in 0..graph.nodes.len().saturating_sub(1) {
        graph.add_step(step, unknowns, system);
        pace.spend(STEP_WORK).await;
    }
    for mark in &graph.marks {
        graph.add_mark((mark, kernel), unknowns, system);
        pace.spend(MARK_WORK).await;
    }
    for stand in 0..graph.docked.len() {
        graph.add_stand(stand, system);
        pace.spend(MARK_WORK).await;
    }
}

/// Does all of it at once.
#[cfg(test)]
pub(super) fn optimized(graph: &mut Graph) -> bool {
    at_once(optimize(graph, Reach::Near, &mut Pace::at_once()))
}
