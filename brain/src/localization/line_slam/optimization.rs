//! All poses and walls moved to where they fit best, by Gauss and Newton.

use super::graph::{Graph, KERNEL, Unknowns};
use crate::localization::skyline::{Solution, System};
use crate::model::gradual::Pace;
#[cfg(test)]
use crate::model::gradual::at_once;

/// Most rounds, and steps that end them, metres or radians.
const ITERATIONS_MAX: usize = 5;
const CONVERGED: f64 = 5e-4;
/// Work of a step between two nodes, of a mark, and of moving a node.
const STEP_WORK: usize = 250;
const OBSERVATION_WORK: usize = 250;
const MOVE_WORK: usize = 15;

/// Rounds in which marks count that are far off, and what counts fully then, in squared deviations: half a metre.
const WIDE_ITERATIONS: usize = 3;
const WIDE_KERNEL: f64 = 500.0;

/// From how far away marks pull walls over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CaptureRange {
    /// From near the walls on which they lie.
    Near,
    /// In the first rounds from far, too: they lie on walls that they are far from.
    Far,
}

impl CaptureRange {
    /// So many rounds come first in which marks count that are far off.
    const fn wide_iterations(self) -> usize {
        match self {
            Self::Near => 0,
            Self::Far => WIDE_ITERATIONS,
        }
    }
}

/// Moves all poses and walls. Gives whether there is a best place for all.
pub(super) async fn optimize(graph: &mut Graph, reach: CaptureRange, pace: &mut Pace) -> bool {
    let wide = reach.wide_iterations();
    for round in 0..wide + ITERATIONS_MAX {
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
        let is_still = values.iter().all(|step| step.abs() < CONVERGED);
        if is_still && round >= wide {
            return true;
        }
        if round + 1 < wide + ITERATIONS_MAX {
            pace.spend(MOVE_WORK * graph.nodes.len()).await;
        }
    }
    true
}

/// Puts steps, marks and stands on the dock into the system.
async fn gather(graph: &Graph, (unknowns, kernel): (&Unknowns, f64), system: &mut System, pace: &mut Pace) {
    for step in 0..graph.nodes.len().saturating_sub(1) {
        graph.add_odometry_residual(step, unknowns, system);
        pace.spend(STEP_WORK).await;
    }
    for observation in &graph.observations {
        graph.add_line_residual((observation, kernel), unknowns, system);
        pace.spend(OBSERVATION_WORK).await;
    }
    for docking in 0..graph.docked.len() {
        graph.add_dock_residual(docking, system);
        pace.spend(OBSERVATION_WORK).await;
    }
}

/// Does all of it at once.
#[cfg(test)]
pub(super) fn optimized(graph: &mut Graph) -> bool {
    at_once(optimize(graph, CaptureRange::Near, &mut Pace::at_once()))
}
