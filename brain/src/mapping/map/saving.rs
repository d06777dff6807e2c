//! Saving the home as plain data.
//!
//! A home has some hundred thousand cells. A small board needs a quarter of a second for them, so saving can run in steps while
//! the robot drives.

use core::task::Poll;

use super::Map;
use crate::mapping::home::RunSoFar;
use crate::mapping::occupancy_grid::OccupancyGrid;
use crate::mapping::rooms::Rooms;
use crate::mapping::{Annotations, DockLocation, StoredMap};
use crate::model::gradual::{Gradual, StepBudget, at_once};
use crate::model::known_beacon::KnownBeacon;

/// A copy of what is saved. It shares its cells with the map until the map writes to them.
struct MapCopy {
    grid: OccupancyGrid,
    /// In a known home.
    run: Option<RunSoFar>,
    rooms: Rooms,
    dock: DockLocation,
    annotations: Annotations,
    beacons: Vec<KnownBeacon>,
}

impl MapCopy {
    fn of(map: &Map) -> Self {
        Self {
            grid: map.home.grid.clone(),
            run: map.home.run_so_far(),
            rooms: map.home.rooms.clone(),
            dock: map.home.dock,
            annotations: map.home.annotations.clone(),
            beacons: map.home.beacons.clone(),
        }
    }

    async fn written(self, budget: &mut StepBudget) -> StoredMap {
        let grid = match self.run {
            Some(run) => run.left_home(budget).await,
            None => self.grid,
        };
        StoredMap::of_layers(&grid, &self.rooms, budget)
            .await
            .with_dock_location(self.dock)
            .with_annotations(self.annotations)
            .with_beacons(self.beacons)
    }
}

/// Writes a home as plain data in steps, as it was at the beginning.
#[derive(Debug)]
pub struct MapWriter(Gradual<StoredMap>);

impl MapWriter {
    /// Does the next step. Must not be called again after it returned the home.
    pub fn go_on(&mut self) -> Option<StoredMap> {
        match self.0.go_on() {
            Poll::Ready(home) => Some(home),
            Poll::Pending => None,
        }
    }
}

impl Map {
    /// As [`Self::stored`], of the present map, in steps: for a shell that answers meanwhile.
    #[must_use]
    pub fn begin_storing(&self) -> MapWriter {
        MapWriter(self.stored_in_steps())
    }

    /// The home as plain data.
    #[must_use]
    pub fn stored(&self) -> StoredMap {
        at_once(MapCopy::of(self).written(&mut StepBudget::unlimited()))
    }

    /// As [`Self::stored`], of the present map, in steps.
    pub(crate) fn stored_in_steps(&self) -> Gradual<StoredMap> {
        let copy = MapCopy::of(self);
        Gradual::new(async move { copy.written(&mut StepBudget::short()).await })
    }
}
