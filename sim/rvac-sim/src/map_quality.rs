//! Agreement of the robot's map with the plan of the home.
//!
//! A robot cannot know the plan's axes: its frame starts at its own first pose. The map is therefore judged twice: in
//! that frame, and *aligned* with the plan by the rigid transform that fits the walls best.

use brain::Point2;
use brain::mapping::{CELL_M, CellKnowledge, Map};
use home::{Home, Pose};

use crate::map_alignment::{aligned, wall_error_m};
use crate::map_obstacles::{self, MapObstacles};

/// Agreement of a map with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapQuality {
    /// In the frame of the robot's start.
    pub(crate) placed: Agreement,
    /// Aligned.
    pub(crate) aligned: Agreement,
    /// Wrong obstacles, aligned.
    pub(crate) obstacles: MapObstacles,
}

/// Agreement of a map with the plan for one alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// Floor that the robot knows as free, over that and what it does not know of the reachable floor and what it
    /// wrongly takes for free: 0..1. Floor that the body cannot come over may be known, but need not.
    pub(crate) iou: f64,
    /// Mean distance of the cells at which the robot's free floor ends at something solid from what is really solid
    /// there, metres; `None` = it knows of no such cell.
    pub(crate) wall_error_m: Option<f64>,
}

/// Judges a map; `None` = nothing is known yet.
pub(crate) fn judge(map: &Map, home: &Home, plan_from_map: Pose) -> Option<MapQuality> {
    let walls = walls(map);
    let best = aligned(&walls, home, plan_from_map);
    Some(MapQuality {
        placed: agreement((map, &walls), home, plan_from_map)?,
        aligned: agreement((map, &walls), home, best)?,
        obstacles: map_obstacles::judge(map.knowledge(), home, best),
    })
}

fn agreement((map, walls): (&Map, &[Point2]), home: &Home, plan_from_map: Pose) -> Option<Agreement> {
    let knowledge = map.knowledge();
    let grid = home.grid();
    let (mut known_free, mut right_free, mut known_reachable) = (0_u32, 0_u32, 0_u32);
    for (number, _) in knowledge
        .values()
        .iter()
        .enumerate()
        .filter(|(_, kind)| **kind == CellKnowledge::Free)
    {
        let at = knowledge.cell(number).middle();
        let (x_m, y_m) = plan_from_map.point(at.x_m, at.y_m);
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

/// Where in the map free floor ends at something solid.
fn walls(map: &Map) -> Vec<Point2> {
    let knowledge = map.knowledge();
    let cells = knowledge.values().iter().enumerate();
    cells
        .filter(|(number, kind)| **kind == CellKnowledge::Occupied && borders_free(knowledge, *number))
        .map(|(number, _)| knowledge.cell(number).middle())
        .collect()
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

    use anyhow::Context;
    use brain::{Body, SensorLayout};
    use home::RobotModel;

    use super::*;
    use crate::known_map::known_map;

    fn flat() -> anyhow::Result<Home> {
        let model = RobotModel::by_name("sr8730")?;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../homes/two-room-flat.toml");
        Ok(Home::load(&path, &model)?)
    }

    /// The flat as it is, drawn in this frame.
    fn drawn(home: &Home, map_from_plan: Pose) -> Map {
        let body = Body {
            radius_m: 0.175,
            swath_m: 0.29,
            track_m: 0.24,
        };
        let mut map = Map::new(body, SensorLayout::default());
        map.load(&known_map(home, map_from_plan, None));
        map
    }

    #[test]
    fn a_right_map_in_a_frame_that_is_off_is_wrong_where_it_is_placed_and_right_aligned() -> anyhow::Result<()>
    {
        let home = flat()?;
        let map = drawn(&home, Pose::new(0.0, 0.0, 0.0));
        for off in [
            Pose::new(0.25, -0.15, 0.02),
            Pose::new(-0.1, 0.3, -0.03),
            Pose::new(0.0, 0.0, 0.0),
        ] {
            let MapQuality { placed, aligned, .. } = judge(&map, &home, off).context("a map of the flat")?;
            let off_m = |one: Agreement| one.wall_error_m.context("walls of the flat");
            assert!(aligned.iou > 0.985, "{aligned:?} at {off:?}");
            // The middles of the cells that border free floor lie about half a cell within what is solid.
            assert!(off_m(aligned)? < 0.013, "{aligned:?} at {off:?}");
            assert!(placed.iou <= aligned.iou + 0.002, "{placed:?}, {aligned:?}");
            if off.x_m != 0.0 {
                assert!(placed.iou < 0.95 && off_m(placed)? > 0.05, "{placed:?}");
            }
        }
        Ok(())
    }

    #[test]
    fn what_is_bent_stays_wrong_when_it_is_laid_over_the_plan() -> anyhow::Result<()> {
        let home = flat()?;
        let straight = Pose::new(0.0, 0.0, 0.0);
        let bent: Vec<Point2> = walls(&drawn(&home, straight))
            .into_iter()
            .map(|place| Point2 {
                y_m: place.y_m + 0.02 * place.x_m * place.x_m,
                ..place
            })
            .collect();
        let off_m = |pose| wall_error_m(&bent, &home, pose).context("walls of the flat");
        let (before_m, after_m) = (off_m(straight)?, off_m(aligned(&bent, &home, straight))?);
        assert!(after_m < before_m, "{after_m} m, {before_m} m");
        assert!(after_m > 0.02, "{after_m} m");
        Ok(())
    }
}
