//! Dense rasters made of the layers, brought up to date piece by piece.

use super::distance::{DistanceField, grown, window};
use super::layers::{CellBox, Layers};
use super::{Cell, CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Work of finding a cell among the tiles.
const LOOK_UP_WORK: usize = 6;

/// Knowledge and distances over everything that was ever seen.
#[derive(Clone, Debug)]
pub(super) struct Derived {
    pub(super) knowledge: Raster<CellKnowledge>,
    pub(super) distance: DistanceField,
}

impl Default for Derived {
    fn default() -> Self {
        Self {
            knowledge: Raster::filled(Cell::default(), 0, 0, CellKnowledge::Unknown),
            distance: DistanceField::default(),
        }
    }
}

impl Derived {
    /// Everything that `layers` tell.
    pub(super) async fn anew(layers: &mut Layers, budget: &mut StepBudget) -> Self {
        layers.take_dirty();
        let mut derived = Self::default();
        derived.cover(layers);
        for index in 0..derived.knowledge.values().len() {
            let cell = derived.knowledge.cell(index);
            if let Some(place) = derived.knowledge.values_mut().get_mut(index) {
                *place = layers.at(cell).knowledge();
            }
            budget.spend(LOOK_UP_WORK).await;
        }
        derived.distance = DistanceField::in_steps(&derived.knowledge, budget).await;
        derived
    }

    /// Takes up what is dirty in `layers`.
    pub(super) fn refresh(&mut self, layers: &mut Layers) {
        let changed = layers.take_dirty();
        self.cover(layers);
        let mut solid: Option<CellBox> = None;
        for part in changed {
            if let Some(moved) = self.copy(layers, part) {
                solid = Some(match solid {
                    Some(before) if are_near(before, moved) => before.joined(moved),
                    Some(before) => {
                        self.distance.renew(&self.knowledge, before);
                        moved
                    }
                    None => moved,
                });
            }
        }
        if let Some(last) = solid {
            self.distance.renew(&self.knowledge, last);
        }
    }

    /// Takes up what is dirty in one tile of `layers`, if there is one.
    pub(super) fn refresh_tile(&mut self, layers: &mut Layers) {
        let Some(part) = layers.take_dirty_tile() else {
            return;
        };
        self.cover(layers);
        if let Some(solid) = self.copy(layers, part) {
            self.distance.renew(&self.knowledge, solid);
        }
    }

    /// The rasters grow with the layers.
    fn cover(&mut self, layers: &Layers) {
        if let Some(bounds) = layers.bounds()
            && window(&self.knowledge) != Some(bounds)
        {
            self.knowledge = grown(&self.knowledge, bounds, CellKnowledge::Unknown);
            self.distance.cover(bounds);
        }
    }

    /// Copies the knowledge of `part` and gives the box in which something became occupied or ceased to be.
    fn copy(&mut self, layers: &Layers, part: CellBox) -> Option<CellBox> {
        let mut solid: Option<CellBox> = None;
        for y in part.low.y..=part.high.y {
            for x in part.low.x..=part.high.x {
                let cell = Cell { x, y };
                let Some(place) = self.knowledge.get_mut(cell) else {
                    continue;
                };
                let before = core::mem::replace(place, layers.at(cell).knowledge());
                let occupied = |kind: CellKnowledge| kind == CellKnowledge::Occupied;
                if occupied(before) != occupied(*place) {
                    let here = CellBox::of(cell);
                    solid = Some(solid.map_or(here, |moved| moved.joined(here)));
                }
            }
        }
        solid
    }
}

/// Whether one piece of work on both boxes is less than two: a box is worked on with a margin around it.
fn are_near(one: CellBox, other: CellBox) -> bool {
    let area = |cells: CellBox| {
        let (width, height) = cells.grown(2 * super::distance::FAR_CELLS).size();
        width.saturating_mul(height)
    };
    area(one.joined(other)) <= area(one) + area(other)
}
