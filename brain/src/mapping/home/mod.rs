//! The part of the map that outlives a job.

mod cut_off;
mod painting;
mod settling;

use core::task::Poll;

use super::annotations::Annotations;
use super::carpet::SurfaceObservation;
use super::derived::Derived;
use super::dock_location::DockLocation;
use super::inverse_sensor_model::InverseSensorModel;
use super::kept_home::KeptHome;
use super::next_numbers::NextNumbers;
use super::occupancy_grid::{CellBox, CellKnowledge, Flag, OccupancyGrid};
use super::rooms::Rooms;
use super::sighting::Sighting;
use super::wall_direction::CachedDirection;
use super::{CELL_M, Cell, Raster, StoredMap};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::Point2;
use crate::model::gradual::{Gradual, StepBudget, at_once};
use crate::model::known_beacon::KnownBeacon;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
pub(super) use painting::without_no_go;
use settling::KnownHome;
pub(crate) use settling::PlaceTrust;
pub(super) use settling::RunSoFar;

/// Interval of updating the derived rasters, microseconds.
const REFRESH_US: u64 = 2_000_000;
/// Interval of segmenting rooms, microseconds.
const SEGMENTATION_INTERVAL_US: u64 = 120_000_000;
/// Most sightings for a redraw: at least half a centimetre of travel apart, some two hours of cleaning.
const SIGHTINGS_MAX: usize = 100_000;
/// Radius of the forbidden disc where the robot got stuck. Plans also keep the body's radius away from it.
const POCKET_M: f64 = 0.1;

/// Whether a cell may be entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    /// It may be entered.
    Allowed,
    /// It may not be entered.
    Forbidden,
}

/// The map of the home.
#[derive(Debug)]
pub(super) struct HomeMap {
    pub(super) sensor_model: InverseSensorModel,
    pub(super) grid: OccupancyGrid,
    pub(super) derived: Derived,
    /// The grid before the first sighting.
    pub(super) base: OccupancyGrid,
    pub(super) sightings: Vec<Sighting>,
    /// In a known home: what earlier runs left, and what this run will leave.
    pub(super) known: Option<Box<KnownHome>>,
    /// Share of the floor driven in earlier runs that the robot reaches from its dock.
    pub(super) connected_share: f64,
    last: Option<Sighting>,
    refreshed_us: u64,
    /// Dirty tiles that the current update has still to process.
    pub(super) stale_tiles: usize,
    pub(super) rooms: Rooms,
    segmented_us: u64,
    segmentation: Option<Gradual<Rooms>>,
    pub(super) dock: DockLocation,
    pub(super) revision: u32,
    /// Increments when a surface changed. It is separate from `revision`, which invalidates plans.
    pub(super) surface_revision: u32,
    /// Whether a surface was added since that increment.
    surface_is_new: bool,
    /// Wall direction of one revision.
    pub(super) direction: CachedDirection,
    pub(super) redrawn: u32,
    /// Cells that are forbidden until the next job.
    pub(super) pockets: Vec<Cell>,
    pub(super) annotations: Annotations,
    /// Radio beacons with places in the frame of the map.
    pub(super) beacons: Vec<KnownBeacon>,
    /// Bounds of the grid when no-go zones were last painted.
    pub(super) painted: Option<CellBox>,
}

impl HomeMap {
    pub(super) fn new(body: Body, sensors: SensorLayout) -> Self {
        Self {
            sensor_model: InverseSensorModel { body, sensors },
            grid: OccupancyGrid::default(),
            derived: Derived::default(),
            base: OccupancyGrid::default(),
            sightings: Vec::new(),
            known: None,
            connected_share: 1.0,
            last: None,
            refreshed_us: 0,
            stale_tiles: 0,
            rooms: Rooms::default(),
            segmented_us: 0,
            segmentation: None,
            dock: DockLocation::default(),
            revision: 0,
            surface_revision: 0,
            surface_is_new: false,
            direction: CachedDirection::default(),
            redrawn: 0,
            pockets: Vec::new(),
            annotations: Annotations::default(),
            beacons: Vec::new(),
            painted: None,
        }
    }

    pub(super) fn insert(&mut self, estimate: &PoseEstimate, observation: &Observation) {
        if !is_of_use(estimate, observation) {
            self.last = None;
            return;
        }
        if observation.docked && self.dock.pose().is_none() {
            self.dock = DockLocation::converged(estimate.pose);
        }
        let mut sighting = Sighting::new(estimate, observation);
        let before = self.last.map(|last| last.switches).unwrap_or_default();
        sighting.switches = sighting.switches.after(before);
        if self.last.is_some_and(|last| sighting.repeats(&last)) {
            return;
        }
        self.last = Some(sighting);
        if self.known.is_some() {
            // Nothing corrects past poses in a known home, so nothing is drawn again.
            self.sightings.clear();
        }
        self.sightings.push(sighting);
        let kept = self.known.as_ref().map(|known| &*known.kept);
        self.sensor_model.draw(&sighting, kept, &mut self.grid);
        if observation.time_us >= self.refreshed_us.saturating_add(REFRESH_US) {
            self.refreshed_us = observation.time_us;
            self.begin_refresh();
        }
        if observation.time_us >= self.segmented_us.saturating_add(SEGMENTATION_INTERVAL_US) {
            self.segmented_us = observation.time_us;
            self.begin_segmentation();
        }
    }

    /// Sets or clears a flag so that a redraw keeps it.
    pub(super) fn flag(&mut self, cell: Cell, flag: Flag, access: Access) {
        let change = |evidence: &mut super::occupancy_grid::Evidence| match access {
            Access::Forbidden => evidence.set(flag),
            Access::Allowed => evidence.clear(flag),
        };
        self.base.change(cell, change);
        self.grid.change(cell, change);
        if let Some(known) = &mut self.known {
            known.flag(cell, flag, access);
        }
    }

    /// Forbids a disc of cells until [`Self::allow_pockets`].
    pub(super) fn forbid_pocket(&mut self, place: Point2) {
        let reach = libm::ceil(POCKET_M / CELL_M) as i32;
        let middle = Cell::under(place);
        let around = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (column, row)));
        let within = around.filter(|(column, row)| column * column + row * row <= reach * reach);
        self.forbid_for_job(within.map(|(column, row)| Cell {
            x: middle.x.saturating_add(column),
            y: middle.y.saturating_add(row),
        }));
    }

    /// Forbids cells until [`Self::allow_pockets`].
    pub(super) fn forbid_for_job(&mut self, cells: impl Iterator<Item = Cell>) {
        for cell in cells {
            self.flag(cell, Flag::Pocket, Access::Forbidden);
            self.pockets.push(cell);
        }
        self.refresh();
    }

    /// Allows everything that was forbidden for the job: things may have been moved.
    pub(super) fn allow_pockets(&mut self) {
        for cell in core::mem::take(&mut self.pockets) {
            self.flag(cell, Flag::Pocket, Access::Allowed);
        }
        self.refresh();
    }

    pub(super) fn segment_rooms(&mut self) {
        self.refresh();
        let without_no_go = self.knowledge_without_no_go();
        let knowledge = without_no_go.as_ref().unwrap_or(&self.derived.knowledge);
        let changes = self.annotations.room_changes();
        self.rooms = at_once(
            self.rooms
                .segmented_in_steps(knowledge, changes, &mut StepBudget::unlimited()),
        );
        self.segmentation = None;
    }

    /// Begins to segment rooms. [`Self::continue_segmentation`] does the work.
    fn begin_segmentation(&mut self) {
        let without_no_go = self.knowledge_without_no_go();
        let knowledge = without_no_go.unwrap_or_else(|| self.derived.knowledge.clone());
        let (before, changes) = (self.rooms.clone(), self.annotations.room_changes().clone());
        self.segmentation = Some(Gradual::new(async move {
            before
                .segmented_in_steps(&knowledge, &changes, &mut StepBudget::limited())
                .await
        }));
    }

    pub(super) fn continue_segmentation(&mut self) {
        if let Some(segmentation) = &mut self.segmentation
            && let Poll::Ready(rooms) = segmentation.go_on()
        {
            self.rooms = rooms;
            self.segmentation = None;
        }
    }

    /// Bounding box of all tiles.
    pub(super) fn bounds(&self) -> Option<CellBox> {
        self.grid.bounds()
    }

    pub(super) fn knowledge(&self) -> &Raster<CellKnowledge> {
        &self.derived.knowledge
    }

    /// Records a visible change.
    pub(super) fn increment_revision(&mut self) {
        self.refresh();
        self.revision = self.revision.wrapping_add(1);
    }

    /// Whether the list of sightings is full.
    pub(super) fn is_full(&self) -> bool {
        self.sightings.len() >= SIGHTINGS_MAX
    }

    /// Makes everything up to now final.
    pub(super) fn finalize(&mut self) {
        self.base = self.grid.clone();
        self.sightings.clear();
    }

    /// Records that the cleaning motors run at the last sighting.
    pub(super) fn note_sweeping(&mut self) {
        if self.last.is_some()
            && let Some(newest) = self.sightings.last_mut()
        {
            newest.switches.note_sweeping();
        }
    }

    /// Adds a detected surface to the sighting of this time, if there is one.
    pub(super) fn note_surface(&mut self, time_us: u64, observed: SurfaceObservation) -> Option<Sighting> {
        let newest = self.sightings.last_mut()?;
        if newest.time_us != time_us {
            return None;
        }
        newest.surface = Some(observed);
        self.sensor_model.draw_surface(newest, &mut self.grid);
        self.surface_is_new = true;
        Some(*newest)
    }

    /// Begins to update the derived rasters, tile by tile.
    pub(super) fn begin_refresh(&mut self) {
        if core::mem::take(&mut self.surface_is_new) {
            self.surface_revision = self.surface_revision.wrapping_add(1);
        }
        self.paint_no_go_in_new_tiles();
        self.stale_tiles = self.grid.dirty_tiles();
    }

    pub(super) fn refresh_on(&mut self) {
        if self.stale_tiles == 0 {
            return;
        }
        self.derived.refresh_tile(&mut self.grid);
        self.stale_tiles -= 1;
        if self.stale_tiles == 0 {
            self.revision = self.revision.wrapping_add(1);
        }
    }

    pub(super) fn refresh(&mut self) {
        self.stale_tiles = 0;
        self.paint_no_go_in_new_tiles();
        if self.grid.is_dirty() {
            self.derived.refresh(&mut self.grid);
            self.revision = self.revision.wrapping_add(1);
        }
    }

    /// Replaces the grid by a redrawn one, which includes everything seen meanwhile.
    pub(super) fn replace_grid(&mut self, grid: OccupancyGrid, derived: Derived) {
        self.grid = grid;
        self.paint_no_go();
        self.derived = derived;
        self.stale_tiles = 0;
        self.derived.refresh(&mut self.grid);
        self.revision = self.revision.wrapping_add(1);
        self.redrawn = self.redrawn.wrapping_add(1);
    }

    /// Fills an empty map from a stored one.
    pub(super) async fn filled(mut self, stored: &StoredMap, budget: &mut StepBudget) -> Self {
        self.grid = stored.grid(budget).await;
        self.base = self.grid.clone();
        self.dock = stored.dock_location();
        self.annotations = stored.annotations().clone();
        self.beacons = stored.beacons().to_vec();
        self.paint_no_go();
        self.derived = Derived::compute(&mut self.grid, budget).await;
        if let Some(dock) = self.dock.pose() {
            self.connected_share = self.reconnect(dock.position(), budget).await;
            self.base = self.grid.clone();
        }
        let kept = KeptHome::of(&self.grid, &self.derived.knowledge, budget).await;
        self.known = Some(Box::new(KnownHome::begun(kept)));
        let without_no_go = self.knowledge_without_no_go();
        let knowledge = without_no_go.as_ref().unwrap_or(&self.derived.knowledge);
        let changes = self.annotations.room_changes();
        self.rooms = stored
            .rooms()
            .segmented_in_steps(knowledge, changes, budget)
            .await;
        self
    }

    /// What is new from now on gets these numbers or higher ones.
    pub(super) fn number_after(&mut self, next: NextNumbers) {
        self.rooms.number_after(next.room);
        self.annotations.number_after(next);
    }

    /// The numbers that it gives next.
    pub(super) fn next_numbers(&self) -> NextNumbers {
        NextNumbers {
            room: self.rooms.next_id(),
            ..self.annotations.next_numbers()
        }
    }

    /// Continues the counters of the replaced home.
    pub(super) fn continue_counters(&mut self, before: &Self) {
        self.revision = before.revision.wrapping_add(1);
        self.surface_revision = before.surface_revision.wrapping_add(1);
        self.redrawn = before.redrawn;
        self.refreshed_us = before.refreshed_us;
        self.segmented_us = before.segmented_us;
    }
}

/// Whether an observation is valid for the map: not from a robot that is lifted, lost or without a link.
fn is_of_use(estimate: &PoseEstimate, observation: &Observation) -> bool {
    let pose = estimate.pose;
    let is_finite = (pose.x_m + pose.y_m + pose.heading_rad).is_finite();
    is_finite && !estimate.lost && observation.link_up && !observation.wheel_drop
}
