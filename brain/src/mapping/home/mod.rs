//! The part of the map that outlives a job: what stands where.

mod painting;

use core::task::Poll;

use super::annotations::Annotations;
use super::carpet::FloorFelt;
use super::derived::Derived;
use super::dock::DockPlace;
use super::draw::Pencil;
use super::layers::{CellBox, CellKnowledge, Flag, Layers};
use super::rooms::Rooms;
use super::sighting::Sighting;
use super::wall_direction::DirectionAt;
use super::{CELL_M, Cell, Raster, StoredMap};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::Point2;
use crate::model::gradual::{Gradual, StepBudget, at_once};
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// Derived rasters are brought up to date after this time, microseconds.
const REFRESH_US: u64 = 2_000_000;
/// Rooms are looked for again after this time, microseconds.
const SURVEY_US: u64 = 120_000_000;
/// Sightings kept for drawing the map again: half a centimetre of way apart at least, some two hours of cleaning.
const SIGHTINGS_MAX: usize = 100_000;
/// Radius of what is shut around a place that trapped the robot; plans keep the body's radius away from it, too.
const POCKET_M: f64 = 0.1;

/// Whether a cell may be entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Entry {
    /// It may.
    Allowed,
    /// It may not.
    Forbidden,
}

/// What is known of the home.
#[derive(Debug)]
pub(super) struct HomeMap {
    pub(super) pencil: Pencil,
    pub(super) layers: Layers,
    pub(super) derived: Derived,
    /// What was known before the first of the sightings.
    pub(super) base: Layers,
    pub(super) sightings: Vec<Sighting>,
    last: Option<Sighting>,
    refreshed_us: u64,
    /// Tiles that are not brought up to date yet, of those that were to be.
    pub(super) stale_tiles: usize,
    pub(super) rooms: Rooms,
    surveyed_us: u64,
    surveying: Option<Gradual<Rooms>>,
    pub(super) dock: DockPlace,
    pub(super) revision: u32,
    /// Grows when a kind of floor has changed; apart from `revision`, by which plans are judged.
    pub(super) floor_revision: u32,
    /// Something was felt of the floor since that grew.
    floor_is_new: bool,
    /// Direction of the walls at a revision.
    pub(super) direction: DirectionAt,
    pub(super) redrawn: u32,
    /// Cells that are shut until the next job.
    pub(super) pockets: Vec<Cell>,
    pub(super) annotations: Annotations,
    /// Where no-go zones were last painted.
    pub(super) painted: Option<CellBox>,
}

impl HomeMap {
    pub(super) fn new(body: Body, sensors: SensorLayout) -> Self {
        Self {
            pencil: Pencil { body, sensors },
            layers: Layers::default(),
            derived: Derived::default(),
            base: Layers::default(),
            sightings: Vec::new(),
            last: None,
            refreshed_us: 0,
            stale_tiles: 0,
            rooms: Rooms::default(),
            surveyed_us: 0,
            surveying: None,
            dock: DockPlace::default(),
            revision: 0,
            floor_revision: 0,
            floor_is_new: false,
            direction: DirectionAt::default(),
            redrawn: 0,
            pockets: Vec::new(),
            annotations: Annotations::default(),
            painted: None,
        }
    }

    pub(super) fn insert(&mut self, estimate: &PoseEstimate, observation: &Observation) {
        if !is_of_use(estimate, observation) {
            self.last = None;
            return;
        }
        if observation.docked && self.dock.pose().is_none() {
            self.dock = DockPlace::sure(estimate.pose);
        }
        let mut sighting = Sighting::new(estimate, observation);
        let before = self.last.map(|last| last.touched).unwrap_or_default();
        sighting.touched = sighting.touched.after(before);
        if self.last.is_some_and(|last| sighting.repeats(&last)) {
            return;
        }
        self.last = Some(sighting);
        self.sightings.push(sighting);
        self.pencil.draw(&sighting, &mut self.layers);
        if observation.time_us >= self.refreshed_us.saturating_add(REFRESH_US) {
            self.refreshed_us = observation.time_us;
            self.begin_refresh();
        }
        if observation.time_us >= self.surveyed_us.saturating_add(SURVEY_US) {
            self.surveyed_us = observation.time_us;
            self.begin_survey();
        }
    }

    /// Sets or clears a flag, whatever is drawn again later.
    pub(super) fn flag(&mut self, cell: Cell, flag: Flag, entry: Entry) {
        let change = |evidence: &mut super::layers::Evidence| match entry {
            Entry::Forbidden => evidence.set(flag),
            Entry::Allowed => evidence.clear(flag),
        };
        self.base.change(cell, change);
        self.layers.change(cell, change);
    }

    /// Forbids the cells around a place until [`Self::open_pockets`].
    pub(super) fn shut_pocket(&mut self, place: Point2) {
        let reach = libm::ceil(POCKET_M / CELL_M) as i32;
        let middle = Cell::under(place);
        let around = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (column, row)));
        let within = around.filter(|(column, row)| column * column + row * row <= reach * reach);
        self.shut(within.map(|(column, row)| Cell {
            x: middle.x.saturating_add(column),
            y: middle.y.saturating_add(row),
        }));
    }

    /// Forbids cells until [`Self::open_pockets`].
    pub(super) fn shut(&mut self, cells: impl Iterator<Item = Cell>) {
        for cell in cells {
            self.flag(cell, Flag::Pocket, Entry::Forbidden);
            self.pockets.push(cell);
        }
        self.refresh();
    }

    /// A new job may go everywhere again: things are moved.
    pub(super) fn open_pockets(&mut self) {
        for cell in core::mem::take(&mut self.pockets) {
            self.flag(cell, Flag::Pocket, Entry::Allowed);
        }
        self.refresh();
    }

    pub(super) fn survey(&mut self) {
        self.refresh();
        let beneath = self.knowledge_beneath();
        let knowledge = beneath.as_ref().unwrap_or(&self.derived.knowledge);
        let with_changes = (knowledge, self.annotations.room_changes());
        self.rooms = at_once(
            self.rooms
                .renewed_in_steps(with_changes, &mut StepBudget::unlimited()),
        );
        self.surveying = None;
    }

    /// Begins to look for rooms in what is known now. That goes on with [`Self::survey_on`].
    fn begin_survey(&mut self) {
        let beneath = self.knowledge_beneath();
        let knowledge = beneath.unwrap_or_else(|| self.derived.knowledge.clone());
        let (before, changes) = (self.rooms.clone(), self.annotations.room_changes().clone());
        self.surveying = Some(Gradual::new(async move {
            let with_changes = (&knowledge, &changes);
            before
                .renewed_in_steps(with_changes, &mut StepBudget::limited())
                .await
        }));
    }

    pub(super) fn survey_on(&mut self) {
        if let Some(surveying) = &mut self.surveying
            && let Poll::Ready(rooms) = surveying.go_on()
        {
            self.rooms = rooms;
            self.surveying = None;
        }
    }

    /// Cells that tiles cover.
    pub(super) fn bounds(&self) -> Option<CellBox> {
        self.layers.bounds()
    }

    pub(super) fn knowledge(&self) -> &Raster<CellKnowledge> {
        &self.derived.knowledge
    }

    /// What would be known of a cell without a flag.
    pub(super) fn knowledge_without(&self, cell: Cell, flags: &[Flag]) -> CellKnowledge {
        let mut evidence = self.layers.at(cell);
        flags.iter().for_each(|flag| evidence.clear(*flag));
        evidence.knowledge()
    }

    /// Something that people see has changed.
    pub(super) fn touch(&mut self) {
        self.refresh();
        self.revision = self.revision.wrapping_add(1);
    }

    /// Whether there is no room for another sighting.
    pub(super) fn is_full(&self) -> bool {
        self.sightings.len() >= SIGHTINGS_MAX
    }

    /// What was seen up to now stays where it is.
    pub(super) fn settle(&mut self) {
        self.base = self.layers.clone();
        self.sightings.clear();
    }

    /// Notes that the cleaning parts run where the robot was seen last.
    pub(super) fn note_sweeping(&mut self) {
        if self.last.is_some()
            && let Some(newest) = self.sightings.last_mut()
        {
            newest.touched.note_sweeping();
        }
    }

    /// Takes in what is felt of the floor at an observation, if that was new to the map.
    pub(super) fn note_floor(&mut self, time_us: u64, felt: FloorFelt) -> Option<Sighting> {
        let newest = self.sightings.last_mut()?;
        if newest.time_us != time_us {
            return None;
        }
        newest.floor = Some(felt);
        self.pencil.draw_floor(newest, &mut self.layers);
        self.floor_is_new = true;
        Some(*newest)
    }

    /// Begins to bring up to date what changed up to now, tile by tile.
    pub(super) fn begin_refresh(&mut self) {
        if core::mem::take(&mut self.floor_is_new) {
            self.floor_revision = self.floor_revision.wrapping_add(1);
        }
        self.paint_what_came();
        self.stale_tiles = self.layers.dirty_tiles();
    }

    pub(super) fn refresh_on(&mut self) {
        if self.stale_tiles == 0 {
            return;
        }
        self.derived.refresh_tile(&mut self.layers);
        self.stale_tiles -= 1;
        if self.stale_tiles == 0 {
            self.revision = self.revision.wrapping_add(1);
        }
    }

    pub(super) fn refresh(&mut self) {
        self.stale_tiles = 0;
        self.paint_what_came();
        if self.layers.is_dirty() {
            self.derived.refresh(&mut self.layers);
            self.revision = self.revision.wrapping_add(1);
        }
    }

    /// Takes up layers that were drawn again; what was seen meanwhile is in them.
    pub(super) fn take_redrawn(&mut self, layers: Layers, derived: Derived) {
        self.layers = layers;
        self.paint_no_go();
        self.derived = derived;
        self.stale_tiles = 0;
        self.derived.refresh(&mut self.layers);
        self.revision = self.revision.wrapping_add(1);
        self.redrawn = self.redrawn.wrapping_add(1);
    }

    /// The same with a stored home instead of nothing.
    pub(super) async fn filled(mut self, stored: &StoredMap, budget: &mut StepBudget) -> Self {
        self.layers = stored.layers(budget).await;
        self.base = self.layers.clone();
        self.dock = stored.dock_place();
        self.annotations = stored.annotations().clone();
        self.paint_no_go();
        self.derived = Derived::anew(&mut self.layers, budget).await;
        let beneath = self.knowledge_beneath();
        let knowledge = beneath.as_ref().unwrap_or(&self.derived.knowledge);
        let with_changes = (knowledge, self.annotations.room_changes());
        self.rooms = stored.rooms().renewed_in_steps(with_changes, budget).await;
        self
    }

    /// Goes on with the counters of the home that was there before.
    pub(super) fn count_on(&mut self, before: &Self) {
        self.revision = before.revision.wrapping_add(1);
        self.floor_revision = before.floor_revision.wrapping_add(1);
        self.redrawn = before.redrawn;
        self.refreshed_us = before.refreshed_us;
        self.surveyed_us = before.surveyed_us;
    }
}

/// Nothing is learnt in the air, without news, or by a robot that does not know where it is.
fn is_of_use(estimate: &PoseEstimate, observation: &Observation) -> bool {
    let pose = estimate.pose;
    let is_finite = (pose.x_m + pose.y_m + pose.heading_rad).is_finite();
    is_finite && !estimate.lost && observation.link_up && !observation.wheel_drop
}
