//! Optimizes all poses and landmarks by Gauss-Newton.

use super::graph::{Graph, Linearization};
use super::parameters::OPTIMIZATION;
use crate::localization::skyline::Solution;
use crate::model::gradual::StepBudget;
#[cfg(test)]
use crate::model::gradual::at_once;

/// Work of an odometry residual, of an observation, and of moving a node.
const STEP_WORK: usize = 250;
const OBSERVATION_WORK: usize = 250;
const MOVE_WORK: usize = 15;

/// Range within which observations pull landmarks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CaptureRange {
    /// Observations close to their landmarks.
    Near,
    /// In the first iterations far observations, too: merged landmarks are far from their observations.
    Far,
}

impl CaptureRange {
    /// Number of first iterations in which far observations count.
    const fn wide_iterations(self) -> usize {
        match self {
            Self::Near => 0,
            Self::Far => OPTIMIZATION.wide_iterations,
        }
    }
}

/// Optimizes the graph. Returns whether there is a solution.
pub(super) async fn optimize(graph: &mut Graph, reach: CaptureRange, budget: &mut StepBudget) -> bool {
    let wide = reach.wide_iterations();
    for round in 0..wide + OPTIMIZATION.iterations_max {
        let kernel = if round < wide {
            OPTIMIZATION.wide_kernel
        } else {
            OPTIMIZATION.kernel
        };
        let mut linearization = graph.linearization(kernel);
        budget.spend(MOVE_WORK * graph.nodes.len()).await;
        gather(graph, &mut linearization, budget).await;
        let Linearization { unknowns, system, .. } = linearization;
        let Some(Solution { values, factor }) = system.solve(budget).await else {
            return false;
        };
        graph.apply(&unknowns, &values);
        graph.turn_errors.scale_sigma = Some(factor.last_sigma());
        let is_still = values.iter().all(|step| step.abs() < OPTIMIZATION.converged);
        if is_still && round >= wide {
            return true;
        }
        if round + 1 < wide + OPTIMIZATION.iterations_max {
            budget.spend(MOVE_WORK * graph.nodes.len()).await;
        }
    }
    true
}

/// Adds odometry, observations and dockings to the system.
async fn gather(graph: &Graph, linearization: &mut Linearization, budget: &mut StepBudget) {
    for step in 0..graph.nodes.len().saturating_sub(1) {
        graph.add_odometry_residual(step, linearization);
        budget.spend(STEP_WORK).await;
    }
    for observation in &graph.observations {
        graph.add_line_residual(observation, linearization);
        budget.spend(OBSERVATION_WORK).await;
    }
    for docking in 0..graph.docked.len() {
        graph.add_dock_residual(docking, &mut linearization.system);
        budget.spend(OBSERVATION_WORK).await;
    }
}

/// Runs the whole optimization at once.
#[cfg(test)]
pub(super) fn optimized(graph: &mut Graph) -> bool {
    at_once(optimize(graph, CaptureRange::Near, &mut StepBudget::unlimited()))
}
