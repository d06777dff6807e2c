//! How well the robot's map agrees with the plan of the home.

use brain::mapping::{CELL_M, CellKnowledge, Map};
use home::{Home, Pose};

/// Agreement of a map with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapQuality {
    /// Floor that the robot knows as free, over that and what it does not know of the reachable floor and what it wrongly
    /// takes for free: 0..1. Floor that the body cannot come over may be known, but need not.
    pub(crate) iou: f64,
    /// Mean distance of the cells at which the robot's free floor ends at something solid from what is really solid there,
    /// metres; `None` = it knows of no such cell.
    pub(crate) wall_error_m: Option<f64>,
}

/// Judges a map; `None` = nothing is known yet.
pub(crate) fn judge(map: &Map, home: &Home, plan_from_map: Pose) -> Option<MapQuality> {
    let knowledge = map.knowledge();
    let grid = home.grid();
    let (mut known_free, mut right_free, mut known_reachable) = (0_u32, 0_u32, 0_u32);
    let (mut wall_sum_m, mut wall_cells) = (0.0, 0_u32);
    for (number, kind) in knowledge.values().iter().enumerate() {
        let cell = knowledge.cell(number);
        let (x_m, y_m) = plan_from_map.point(
            (f64::from(cell.x) + 0.5) * CELL_M,
            (f64::from(cell.y) + 0.5) * CELL_M,
        );
        let place = grid.index(x_m, y_m);
        match kind {
            CellKnowledge::Free => {
                known_free += 1;
                right_free += u32::from(grid.at(x_m, y_m).is_floor());
                let reachable = place.and_then(|place| home.reachable().get(place));
                known_reachable += u32::from(reachable == Some(&true));
            }
            CellKnowledge::Occupied if borders_free(knowledge, number) => {
                wall_sum_m += home.clearance_m(x_m, y_m).abs();
                wall_cells += 1;
            }
            _ => {}
        }
    }
    let reachable = home.reachable_area_m2() / (CELL_M * CELL_M);
    let missed = (reachable - f64::from(known_reachable)).max(0.0);
    (known_free > 0).then(|| MapQuality {
        iou: f64::from(right_free) / (f64::from(known_free) + missed),
        wall_error_m: (wall_cells > 0).then(|| wall_sum_m / f64::from(wall_cells)),
    })
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
