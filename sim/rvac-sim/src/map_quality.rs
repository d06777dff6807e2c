//! How well the robot's map agrees with the plan of the home.
//!
//! A robot cannot know how the plan's axes run: its frame begins where it stood and as it stood, as well as it knew. So the map is
//! judged twice, in that frame and *aligned*: laid over the plan as a whole, as its walls fit best.

use brain::mapping::{CELL_M, Cell, CellKnowledge, Map};
use home::{Home, Pose};

use crate::map_alignment::aligned;

/// Agreement of a map with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapQuality {
    /// In the frame of the robot's start.
    pub(crate) placed: Agreement,
    /// Aligned.
    pub(crate) aligned: Agreement,
}

/// Agreement of a map that is laid over the plan in one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// Floor that the robot knows as free, over that and what it does not know of the reachable floor and what it wrongly
    /// takes for free: 0..1. Floor that the body cannot come over may be known, but need not.
    pub(crate) iou: f64,
    /// Mean distance of the cells at which the robot's free floor ends at something solid from what is really solid there,
    /// metres; `None` = it knows of no such cell.
    pub(crate) wall_error_m: Option<f64>,
}

/// Judges a map; `None` = nothing is known yet.
pub(crate) fn judge(map: &Map, home: &Home, plan_from_map: Pose) -> Option<MapQuality> {
    let walls = walls(map);
    Some(MapQuality {
        placed: agreement((map, &walls), home, plan_from_map)?,
        aligned: agreement((map, &walls), home, aligned(&walls, home, plan_from_map))?,
    })
}

fn agreement((map, walls): (&Map, &[(f64, f64)]), home: &Home, plan_from_map: Pose) -> Option<Agreement> {
    let knowledge = map.knowledge();
    let grid = home.grid();
    let (mut known_free, mut right_free, mut known_reachable) = (0_u32, 0_u32, 0_u32);
    for (number, _) in knowledge
        .values()
        .iter()
        .enumerate()
        .filter(|(_, kind)| **kind == CellKnowledge::Free)
    {
        let (x_m, y_m) = middle(knowledge.cell(number));
        let (x_m, y_m) = plan_from_map.point(x_m, y_m);
        known_free += 1;
        right_free += u32::from(grid.at(x_m, y_m).is_floor());
        let reachable = grid.index(x_m, y_m).and_then(|place| home.reachable().get(place));
        known_reachable += u32::from(reachable == Some(&true));
    }
    let reachable = home.reachable_area_m2() / (CELL_M * CELL_M);
    let missed = (reachable - f64::from(known_reachable)).max(0.0);
    (known_free > 0).then(|| Agreement {
        iou: f64::from(right_free) / (f64::from(known_free) + missed),
        wall_error_m: wall_error_m(walls, home, plan_from_map),
    })
}

/// Mean distance of places of the map from what is solid in the plan; `None` without any.
pub(crate) fn wall_error_m(walls: &[(f64, f64)], home: &Home, plan_from_map: Pose) -> Option<f64> {
    let off_m = |(x_m, y_m): &(f64, f64)| {
        let (x_m, y_m) = plan_from_map.point(*x_m, *y_m);
        home.clearance_m(x_m, y_m).abs()
    };
    (!walls.is_empty()).then(|| walls.iter().map(off_m).sum::<f64>() / walls.len() as f64)
}

/// Where in the map free floor ends at something solid.
fn walls(map: &Map) -> Vec<(f64, f64)> {
    let knowledge = map.knowledge();
    let cells = knowledge.values().iter().enumerate();
    cells
        .filter(|(number, kind)| **kind == CellKnowledge::Occupied && borders_free(knowledge, *number))
        .map(|(number, _)| middle(knowledge.cell(number)))
        .collect()
}

fn middle(cell: Cell) -> (f64, f64) {
    (
        (f64::from(cell.x) + 0.5) * CELL_M,
        (f64::from(cell.y) + 0.5) * CELL_M,
    )
}

fn borders_free(knowledge: &brain::Raster<CellKnowledge>, number: usize) -> bool {
    let width = knowledge.width();
    [
        number.checked_sub(1),
        number.checked_add(1),
        number.checked_sub(width),
        number.checked_add(width),
    ]
    .into_iter()
    .flatten()
    .any(|neighbour| knowledge.values().get(neighbour) == Some(&CellKnowledge::Free))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use brain::{Body, SensorLayout};
    use home::RobotModel;

    use super::*;
    use crate::known_map::known_map;

    fn flat() -> Home {
        let model = RobotModel::by_name("sr8730").unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../homes/two-room-flat.toml");
        Home::load(&path, &model).unwrap()
    }

    /// The flat as it is, drawn in this frame.
    fn drawn(home: &Home, map_from_plan: Pose) -> Map {
        let body = Body {
            radius_m: 0.175,
            swath_m: 0.29,
            track_m: 0.24,
        };
        let mut map = Map::new(body, SensorLayout::default());
        map.take_up(&known_map(home, map_from_plan, None));
        map
    }

    #[test]
    fn a_right_map_in_a_frame_that_is_off_is_wrong_where_it_is_placed_and_right_aligned() {
        let home = flat();
        let map = drawn(&home, Pose::new(0.0, 0.0, 0.0));
        for off in [
            Pose::new(0.25, -0.15, 0.02),
            Pose::new(-0.1, 0.3, -0.03),
            Pose::new(0.0, 0.0, 0.0),
        ] {
            let MapQuality { placed, aligned } = judge(&map, &home, off).unwrap();
            assert!(aligned.iou > 0.985, "{aligned:?} at {off:?}");
            // The middles of the cells that border free floor lie about half a cell within what is solid.
            assert!(aligned.wall_error_m.unwrap() < 0.013, "{aligned:?} at {off:?}");
            assert!(placed.iou <= aligned.iou + 0.002, "{placed:?}, {aligned:?}");
            if off.x_m != 0.0 {
                assert!(
                    placed.iou < 0.95 && placed.wall_error_m.unwrap() > 0.05,
                    "{placed:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_bent_stays_wrong_when_it_is_laid_over_the_plan() {
        let home = flat();
        let straight = Pose::new(0.0, 0.0, 0.0);
        let walls: Vec<(f64, f64)> = walls(&drawn(&home, straight));
        let bent: Vec<(f64, f64)> = walls
            .iter()
            .map(|(x_m, y_m)| (*x_m, y_m + 0.02 * x_m * x_m))
            .collect();
        let before_m = wall_error_m(&bent, &home, straight).unwrap();
        let after_m = wall_error_m(&bent, &home, aligned(&bent, &home, straight)).unwrap();
        assert!(after_m < before_m, "{after_m} m, {before_m} m");
        assert!(after_m > 0.02, "{after_m} m");
    }
}
