//! Which cells the robot can reach in this map.

use super::Map;
use crate::mapping::{Raster, reachable};
use crate::model::geometry::Point2;

impl Map {
    /// Cells that the centre of a body with `clearance_m` around it can reach from `from` over free cells. Unknown cells,
    /// obstacles, cliffs and forbidden cells are not entered. Takes some milliseconds for a home.
    #[must_use]
    pub fn reachable(&self, from: Point2, clearance_m: f64) -> Raster<bool> {
        reachable(self.knowledge(), from, clearance_m)
    }
}
