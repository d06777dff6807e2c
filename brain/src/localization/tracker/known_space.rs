//! The map as a lost robot searches it.

use crate::localization::floor_blocks::FloorBlocks;
use crate::localization::particles::Surroundings;
use crate::model::geometry::Point2;

/// A map without unknown space. A lost robot searches known space only, because any pose would do in unknown space.
pub(super) struct Whole<'map, M>(pub(super) &'map M);

impl<M: Surroundings> Surroundings for Whole<'_, M> {
    fn clearance_m(&self, at: Point2) -> f64 {
        self.0.clearance_m(at)
    }

    fn drop_m(&self, at: Point2) -> Option<f64> {
        self.0.drop_m(at)
    }

    fn is_known(&self, _: Point2) -> bool {
        true
    }

    fn clearance_around_m(&self, at: Point2, radius_m: f64) -> (f64, f64) {
        self.0.clearance_around_m(at, radius_m)
    }

    fn floor_blocks(&self) -> FloorBlocks {
        self.0.floor_blocks()
    }
}
