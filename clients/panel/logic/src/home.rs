//! The home as the robot knows it, drawn like the plan of a simulated one.

use rvac_api::{HomeView, Pose, SimulatedPlan};

/// What is not known and what must not be entered is left out.
const LEFT_OUT: u32 = 0;

/// The home as a plan.
#[must_use]
pub fn home_plan(home: &HomeView) -> SimulatedPlan {
    let cells = home
        .cells
        .chunks_exact(2)
        .flat_map(|run| match *run {
            [kind @ 1..=3, length] => [kind, length],
            [_, length] => [LEFT_OUT, length],
            _ => [LEFT_OUT, 0],
        })
        .collect();
    SimulatedPlan {
        name: String::new(),
        cell_m: home.cell_m,
        width: home.width,
        height: home.height,
        origin: Pose {
            x: f64::from(home.x) * home.cell_m,
            y: f64::from(home.y) * home.cell_m,
            heading: 0.0,
            t: 0.0,
        },
        cells,
        dock: home.dock,
    }
}

#[cfg(test)]
mod tests {
    use super::home_plan;
    use rvac_api::HomeView;

    #[test]
    fn known_cells_are_drawn_and_the_others_left_out() {
        let home = HomeView {
            cell_m: 0.025,
            x: -40,
            y: 8,
            width: 5,
            height: 1,
            cells: vec![0, 1, 1, 1, 2, 1, 4, 1, 3, 1],
            ..HomeView::default()
        };
        let plan = home_plan(&home);
        assert_eq!(plan.cells, [0, 1, 1, 1, 2, 1, 0, 1, 3, 1]);
        assert_eq!((plan.origin.x, plan.origin.y), (-1.0, 0.2));
        assert_eq!((plan.width, plan.height), (5, 1));
    }
}
