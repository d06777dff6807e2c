//! The home is written down as plain data.
//!
//! Some hundred thousand cells, which take a small board a quarter of a second, so it can be done in steps while the robot drives.

use super::Map;
use crate::mapping::layers::Layers;
use crate::mapping::rooms::Rooms;
use crate::mapping::{Annotations, DockPlace, StoredMap};
use crate::model::gradual::{Gradual, StepBudget, at_once};

/// A copy of what is written down. It shares the cells with the map as long as that does not change them.
struct Draft {
    layers: Layers,
    rooms: Rooms,
    dock: DockPlace,
    annotations: Annotations,
}

impl Draft {
    fn of(map: &Map) -> Self {
        Self {
            layers: map.home.layers.clone(),
            rooms: map.home.rooms.clone(),
            dock: map.home.dock,
            annotations: map.home.annotations.clone(),
        }
    }

    async fn written(self, budget: &mut StepBudget) -> StoredMap {
        StoredMap::of_layers(&self.layers, &self.rooms, budget)
            .await
            .with_dock_place(self.dock)
            .with_annotations(self.annotations)
    }
}

impl Map {
    /// The home as plain data.
    #[must_use]
    pub fn stored(&self) -> StoredMap {
        at_once(Draft::of(self).written(&mut StepBudget::unlimited()))
    }

    /// As [`Self::stored`], of the map as it is now, in steps.
    pub(crate) fn stored_in_steps(&self) -> Gradual<StoredMap> {
        let copy = Draft::of(self);
        Gradual::new(async move { copy.written(&mut StepBudget::limited()).await })
    }
}
