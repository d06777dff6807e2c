//! The plan of a home as a map that a robot could have made of it.

use brain::mapping::{CellKnowledge, StoredMap};
use brain::{CELL_M, Cell, Point2, Pose2, Raster};
use home::{Cell as PlanCell, Home, Pose};

/// The home in the map frame of a robot, every cell as it is in truth; doors that are ever open are open. `docked` is the pose
/// of a robot on the dock in the plan, if there is a dock.
pub(crate) fn known_map(home: &Home, map_from_plan: Pose, docked: Option<Pose>) -> StoredMap {
    let home = home.with_doors_open();
    let grid = home.grid();
    let (width_m, height_m) = (grid.width as f64 * grid.cell_m, grid.height as f64 * grid.cell_m);
    let corners = [(0.0, 0.0), (width_m, 0.0), (0.0, height_m), (width_m, height_m)]
        .map(|(x_m, y_m)| map_from_plan.point(x_m, y_m));
    let cells = |coordinates: [f64; 4]| {
        let lowest = coordinates.into_iter().fold(f64::INFINITY, f64::min);
        let highest = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let first = (lowest / CELL_M).floor() as i32;
        (first, ((highest / CELL_M).ceil() as i32 - first).max(0) as usize)
    };
    let (x, width) = cells(corners.map(|corner| corner.0));
    let (y, height) = cells(corners.map(|corner| corner.1));
    let mut knowledge = Raster::filled(Cell { x, y }, width, height, CellKnowledge::Unknown);
    let plan_from_map = map_from_plan.inverse();
    for index in 0..width * height {
        let cell = knowledge.cell(index);
        let at = cell.middle();
        let (x_m, y_m) = plan_from_map.point(at.x_m, at.y_m);
        if let (Some(value), Some(place)) = (knowledge.values_mut().get_mut(index), grid.index(x_m, y_m)) {
            *value = match grid.cells.get(place) {
                Some(PlanCell::Floor | PlanCell::Rug) => CellKnowledge::Free,
                // What is unknown to the plan is solid for the robot in it, so it would have found a wall.
                Some(PlanCell::Obstacle | PlanCell::Outside) => CellKnowledge::Occupied,
                Some(PlanCell::Cliff) => CellKnowledge::Cliff,
                None => CellKnowledge::Unknown,
            };
        }
    }
    keep_thin(&home, map_from_plan, &mut knowledge);
    let dock = docked.map(|docked| {
        let pose = map_from_plan.then(docked);
        Pose2 {
            x_m: pose.x_m,
            y_m: pose.y_m,
            heading_rad: home::wrap_angle(pose.heading_rad),
        }
    });
    StoredMap::from_raster(&knowledge, dock)
}

/// Things thinner than a cell of the map, which lie between the middles of its cells: legs, mostly.
fn keep_thin(home: &Home, map_from_plan: Pose, knowledge: &mut Raster<CellKnowledge>) {
    let grid = home.grid();
    for (index, _) in grid
        .cells
        .iter()
        .enumerate()
        .filter(|(_, kind)| **kind == PlanCell::Obstacle)
    {
        let (column, row) = (index % grid.width, index / grid.width);
        let (x_m, y_m) = map_from_plan.point(
            (column as f64 + 0.5) * grid.cell_m,
            (row as f64 + 0.5) * grid.cell_m,
        );
        let cell = Cell::under(Point2 { x_m, y_m });
        let is_shown = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(x, y)| {
            let beside = Cell {
                x: cell.x + x,
                y: cell.y + y,
            };
            knowledge.get(beside) != Some(&CellKnowledge::Free)
        });
        if !is_shown && let Some(kind) = knowledge.get_mut(cell) {
            *kind = CellKnowledge::Occupied;
        }
    }
}
