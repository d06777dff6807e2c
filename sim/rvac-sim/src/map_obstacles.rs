//! Obstacles of a map that do not exist, and obstacles of the home that the map has as free floor.

use brain::mapping::{CELL_M, CellKnowledge};
use brain::{Cell, Raster};
use home::{Home, Pose};
use serde::Serialize;

/// A solid cell of the map may lie so far beside what is solid: its middle is drawn from a beam that ends between two cells.
const BESIDE_M: f64 = CELL_M;
/// Free cells of the map that lie in something solid belong to its outline while a solid cell is within so many cells.
const OUTLINE_CELLS: i32 = 2;

/// Wrong obstacles of a map that is laid over the home.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MapObstacles {
    /// Solid in the map and floor in truth, more than a cell away from anything solid, square metres.
    pub false_m2: f64,
    /// Connected places of it.
    pub false_count: u32,
    /// Free in the map and solid in truth, with nothing solid in the map within two cells, square metres.
    pub missing_m2: f64,
    /// Connected places of it.
    pub missing_count: u32,
}

/// Compares what a map says with the home.
pub(crate) fn judge(knowledge: &Raster<CellKnowledge>, home: &Home, plan_from_map: Pose) -> MapObstacles {
    let at = |index: usize| {
        let middle = knowledge.cell(index).middle();
        plan_from_map.point(middle.x_m, middle.y_m)
    };
    let is_false = |(index, kind): (usize, &CellKnowledge)| {
        let (x_m, y_m) = at(index);
        *kind == CellKnowledge::Occupied
            && home.grid().at(x_m, y_m).is_floor()
            && home.clearance_m(x_m, y_m) > BESIDE_M
    };
    let is_missing = |(index, kind): (usize, &CellKnowledge)| {
        let (x_m, y_m) = at(index);
        *kind == CellKnowledge::Free
            && home.grid().at(x_m, y_m).is_solid()
            && !has_solid_beside(knowledge, knowledge.cell(index))
    };
    let cells = || knowledge.values().iter().enumerate();
    let wrong: Vec<bool> = cells().map(is_false).collect();
    let lacking: Vec<bool> = cells().map(is_missing).collect();
    let (false_m2, false_count) = extent(&wrong, knowledge.width());
    let (missing_m2, missing_count) = extent(&lacking, knowledge.width());
    MapObstacles {
        false_m2,
        false_count,
        missing_m2,
        missing_count,
    }
}

fn has_solid_beside(knowledge: &Raster<CellKnowledge>, cell: Cell) -> bool {
    let around = -OUTLINE_CELLS..=OUTLINE_CELLS;
    around.clone().any(|dx| {
        around.clone().any(|dy| {
            let beside = Cell {
                x: cell.x.saturating_add(dx),
                y: cell.y.saturating_add(dy),
            };
            knowledge.get(beside) == Some(&CellKnowledge::Occupied)
        })
    })
}

/// Area of marked cells, and how many places they form; cells that touch at a corner belong together.
fn extent(marked: &[bool], width: usize) -> (f64, u32) {
    let mut left = marked.to_vec();
    let (mut cells, mut places) = (0_u32, 0_u32);
    for start in 0..left.len() {
        if !left[start] {
            continue;
        }
        left[start] = false;
        places += 1;
        let mut waiting = vec![start];
        while let Some(index) = waiting.pop() {
            cells += 1;
            for beside in neighbours(index, width, left.len()) {
                if core::mem::take(&mut left[beside]) {
                    waiting.push(beside);
                }
            }
        }
    }
    (f64::from(cells) * CELL_M * CELL_M, places)
}

/// The up to eight cells around one of a raster.
fn neighbours(index: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (column, row) = (index % width, index / width);
    let rows = row.saturating_sub(1)..=row + 1;
    rows.flat_map(move |row| {
        let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
        columns.map(move |column| row * width + column)
    })
    .filter(move |beside| *beside < count)
}

#[cfg(test)]
mod tests {
    use super::{MapObstacles, judge};
    use crate::known_map::known_map;
    use brain::mapping::{CELL_M, CellKnowledge};
    use brain::{Cell, Raster};
    use home::{Home, Pose, RobotModel};

    /// A room with a box and a leg of 4 cm.
    const PLAN: &str = r#"
        format = "librervac-home"
        version = 1
        [[room]]
        polygon = [[0, 0], [2, 0], [2, 2], [0, 2]]
        [[furniture]]
        polygon = [[0.5, 0.5], [0.8, 0.5], [0.8, 0.8], [0.5, 0.8]]
        [[furniture]]
        legs = [[1.5, 1.5]]
        leg-diameter-m = 0.04
    "#;

    fn home() -> Home {
        let model = RobotModel::by_name("sr8730").unwrap();
        Home::from_floorplan("room", PLAN, &model).unwrap()
    }

    /// A perfect map in the frame of the plan, with other cells in some places of the file.
    fn changed(home: &Home, changes: &[((f64, f64), CellKnowledge)]) -> Raster<CellKnowledge> {
        let mut knowledge = known_map(home, Pose::default(), None).knowledge();
        let corner = home.file_from_plan();
        for ((x_m, y_m), kind) in changes {
            let cell = Cell {
                x: ((x_m - corner.x_m) / CELL_M).floor() as i32,
                y: ((y_m - corner.y_m) / CELL_M).floor() as i32,
            };
            let index = (0..knowledge.values().len()).find(|index| knowledge.cell(*index) == cell);
            knowledge.values_mut()[index.unwrap()] = *kind;
        }
        knowledge
    }

    fn judged(changes: &[((f64, f64), CellKnowledge)]) -> MapObstacles {
        let home = home();
        judge(&changed(&home, changes), &home, Pose::default())
    }

    const CELL_M2: f64 = CELL_M * CELL_M;

    #[test]
    fn a_perfect_map_has_no_wrong_obstacle() {
        assert_eq!(judged(&[]), MapObstacles::default());
    }

    #[test]
    fn marks_on_floor_are_counted_by_place_and_those_at_a_wall_are_not() {
        let solid = CellKnowledge::Occupied;
        let marks = [
            ((1.0, 1.2), solid),
            ((1.0 + CELL_M, 1.2 + CELL_M), solid),
            ((1.7, 0.4), solid),
            // The first cell of floor beside the box.
            ((0.81, 0.65), solid),
        ];
        let found = judged(&marks);
        assert_eq!((found.false_count, found.missing_count), (2, 0));
        assert!((found.false_m2 - 3.0 * CELL_M2).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_leg_that_is_missing_counts_and_an_outline_that_is_a_cell_off_does_not() {
        let free = CellKnowledge::Free;
        let around_leg = (-3..=3).flat_map(|dx| (-3..=3).map(move |dy| (dx, dy)));
        let missing: Vec<_> = around_leg
            .map(|(dx, dy)| ((1.5 + CELL_M * f64::from(dx), 1.5 + CELL_M * f64::from(dy)), free))
            .collect();
        let found = judged(&missing);
        assert_eq!((found.false_count, found.missing_count), (0, 1));
        assert!(
            found.missing_m2 >= CELL_M2 && found.missing_m2 < 6.0 * CELL_M2,
            "{found:?}"
        );
        let thinner = [((0.51, 0.65), free)];
        assert_eq!(judged(&thinner), MapObstacles::default());
    }
}
