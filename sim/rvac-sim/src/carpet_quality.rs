//! Agreement of the carpets in the robot's map with the rugs of the home.

use brain::Point2;
use brain::mapping::{Cell, Map, SurfaceKind};
use home::{Pose, World};

/// Agreement of the detected carpets with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CarpetQuality {
    /// Share of the rug floor under the swath that the map has as carpet; `None` = the swath was on no rug, or nothing
    /// is measured.
    pub(crate) recall: Option<f64>,
    /// Share of the map's carpet that lies on a rug; `None` = it has none.
    pub(crate) precision: Option<f64>,
}

/// Judges a map.
pub(crate) fn judge(map: &Map, world: &World, (plan_from_map, measures): (Pose, bool)) -> CarpetQuality {
    if !measures {
        return CarpetQuality::default();
    }
    CarpetQuality {
        recall: recall(map, world, plan_from_map.inverse()),
        precision: precision(map, world, plan_from_map),
    }
}

fn recall(map: &Map, world: &World, map_from_plan: Pose) -> Option<f64> {
    let grid = world.home().grid();
    let (mut swept, mut found) = (0_u32, 0_u32);
    for (index, cell) in grid.cells.iter().enumerate() {
        if *cell != home::Cell::Rug || world.swept().get(index) != Some(&true) {
            continue;
        }
        let (x_m, y_m) = grid.centre(index);
        let (x_m, y_m) = map_from_plan.point(x_m, y_m);
        swept += 1;
        found += u32::from(map.surface_kind(Cell::under(Point2 { x_m, y_m })) == Some(SurfaceKind::Carpet));
    }
    share(found, swept)
}

fn precision(map: &Map, world: &World, plan_from_map: Pose) -> Option<f64> {
    let grid = world.home().grid();
    let (mut reported, mut right) = (0_u32, 0_u32);
    for (cell, _) in map
        .surface_kinds()
        .filter(|(_, kind)| *kind == SurfaceKind::Carpet)
    {
        let at = cell.middle();
        let (x_m, y_m) = plan_from_map.point(at.x_m, at.y_m);
        reported += 1;
        right += u32::from(grid.at(x_m, y_m) == home::Cell::Rug);
    }
    share(right, reported)
}

fn share(part: u32, whole: u32) -> Option<f64> {
    (whole > 0).then(|| f64::from(part) / f64::from(whole))
}
