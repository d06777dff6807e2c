//! The home for clients of the simulator's socket: plan and ground truth in the map frame.

use home::{Home, Pose};
use rvac_api::{SimulatedPlan, SimulatedTruth};

use crate::Robot;

/// The floor plan in the map frame, which is the frame of the robot's starting pose.
pub(crate) fn plan(home: &Home, map_from_plan: Pose) -> SimulatedPlan {
    let grid = home.grid();
    SimulatedPlan {
        name: home.name().to_owned(),
        cell_m: grid.cell_m,
        width: grid.width as u32,
        height: grid.height as u32,
        origin: to_api(map_from_plan, 0.0),
        cells: run_lengths(grid.cells.iter().map(|cell| *cell as u32)),
        dock: home.dock().map(|dock| to_api(map_from_plan.then(dock), 0.0)),
    }
}

/// What is really so now.
pub(crate) fn truth(robot: &Robot, map_from_plan: Pose) -> SimulatedTruth {
    let truth = robot.world().truth();
    let sim_s = robot.now_ms() as f64 / 1000.0;
    SimulatedTruth {
        pose: to_api(map_from_plan.then(truth.pose), sim_s),
        covered: truth.swept_share,
        violations: robot.monitor().count(),
        sim_s,
    }
}

fn to_api(pose: Pose, t: f64) -> rvac_api::Pose {
    rvac_api::Pose {
        x: pose.x_m,
        y: pose.y_m,
        heading: home::wrap_angle(pose.heading_rad),
        t,
    }
}

/// Pairs of value and length.
pub(crate) fn run_lengths(values: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut pairs: Vec<u32> = Vec::new();
    for value in values {
        match pairs.as_mut_slice() {
            [.., last, length] if *last == value => *length += 1,
            _ => pairs.extend([value, 1]),
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::run_lengths;

    #[test]
    fn runs_are_counted() {
        assert_eq!(run_lengths([1, 1, 2, 1].into_iter()), [1, 2, 2, 1, 1, 1]);
        assert_eq!(run_lengths([].into_iter()), Vec::<u32>::new());
    }
}
