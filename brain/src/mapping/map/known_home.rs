//! The map's view of the home.

use std::sync::Arc;

use super::{LoadedHome, Map};
use crate::mapping::home::HomeMap;
use crate::mapping::home_floor::{EarlierFloor, HomeFloor};
use crate::mapping::occupancy_grid::Flag;
use crate::mapping::sighting::Sighting;
use crate::mapping::wall_direction::wall_direction_rad;
use crate::mapping::walls::walls;
use crate::mapping::{
    CELL_M, Cell, CellKnowledge, DistanceField, DockLocation, PlaceTrust, Raster, Rooms, SurfaceKind,
    WallSegment,
};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::known_beacon::KnownBeacon;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

impl Map {
    /// Adds an observation at a pose. Observations of a robot that is lost, lifted or without a link are ignored, and so are
    /// repeated ones at rest.
    pub fn insert(&mut self, estimate: &PoseEstimate, observation: &Observation) {
        if self.home.is_full() {
            self.finish_redraw();
            self.finalize();
        }
        self.home.insert(estimate, observation);
        self.home.refresh_on();
        self.home.continue_segmentation();
        self.redraw_on();
    }

    /// Notes how sure the robot is of its place in a known home. What it has drawn shortly before a doubt is dropped.
    pub(crate) fn note_trust(&mut self, trust: PlaceTrust, time_us: u64) {
        self.home.note_trust(trust, time_us);
    }

    /// Radio beacons whose places are known.
    #[must_use]
    pub fn beacons(&self) -> &[KnownBeacon] {
        &self.home.beacons
    }

    /// The places of radio beacons have become known better.
    pub(crate) fn keep_beacons(&mut self, beacons: Vec<KnownBeacon>) {
        self.home.beacons = beacons;
    }

    /// Share of the floor driven in earlier runs that the robot reaches from its dock, 0..=1. Below 1 something that infrared sees
    /// stands in between.
    #[must_use]
    pub fn connected_share(&self) -> f64 {
        self.home.connected_share
    }

    /// The map is no reference: this run draws into it what it shows.
    pub(crate) fn draw_afresh(&mut self) {
        self.home.known = None;
    }

    /// Drops the home: a new one is drawn in a frame of its own. Numbers that were given are not given again.
    pub(crate) fn begin_anew(&mut self) {
        let mut blank = HomeMap::new(self.home.sensor_model.body, self.home.sensor_model.sensors);
        blank.number_after(self.home.next_numbers());
        self.replace_home(LoadedHome::from(blank));
        self.start_anew();
        self.frame += 1;
    }

    /// Number of the map's frame, from 1. Poses of another frame mean nothing in this one.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Knowledge of each cell. Up to two seconds old; [`Self::refresh`] updates it.
    #[must_use]
    pub fn knowledge(&self) -> &Raster<CellKnowledge> {
        &self.home.derived.knowledge
    }

    /// Known free floor in square metres. It visits all cells, so it is not for every step.
    #[must_use]
    pub fn free_m2(&self) -> f64 {
        let free = self.knowledge().values().iter();
        let count = free.filter(|cell| **cell == CellKnowledge::Free).count();
        count as f64 * CELL_M * CELL_M
    }

    /// Distances to occupied cells, as old as [`Self::knowledge`].
    #[must_use]
    pub fn distance_field(&self) -> &DistanceField {
        &self.home.derived.distance
    }

    /// Begins to update the derived rasters over the next steps, for plans that need a new obstacle.
    pub(crate) fn begin_refresh(&mut self) {
        self.home.begin_refresh();
    }

    /// Whether no update is in progress.
    pub(crate) fn is_fresh(&self) -> bool {
        self.home.stale_tiles == 0
    }

    /// Updates everything derived now, for a planner that needs the last contact.
    pub fn refresh(&mut self) {
        self.home.refresh();
    }

    /// Increments whenever anything derived has changed.
    #[must_use]
    pub fn revision(&self) -> u32 {
        self.home.revision
    }

    /// Increments when a surface has changed, up to two seconds late.
    #[must_use]
    pub fn surface_revision(&self) -> u32 {
        self.home.surface_revision
    }

    /// The surface of a cell, if known.
    #[must_use]
    pub fn surface_kind(&self, cell: Cell) -> Option<SurfaceKind> {
        self.home.grid.at(cell).surface()
    }

    /// The cells with a known surface, tile by tile.
    pub fn surface_kinds(&self) -> impl Iterator<Item = (Cell, SurfaceKind)> + '_ {
        let gathered = self.home.grid.gathered();
        gathered.filter_map(|(cell, evidence)| Some((cell, evidence.surface()?)))
    }

    /// Increments whenever the map was redrawn; existing plans are then invalid.
    #[must_use]
    pub fn redrawn(&self) -> u32 {
        self.home.redrawn
    }

    /// Rooms and doors, up to two minutes old; [`Self::segment_rooms`] updates them.
    #[must_use]
    pub fn rooms(&self) -> &Rooms {
        &self.home.rooms
    }

    /// Direction of the walls, above -pi/4 and up to pi/4; `None` when there is no dominant one. Takes some ten milliseconds when
    /// the map has changed since the last call.
    pub(crate) fn wall_direction_rad(&self) -> Option<f64> {
        let home = &self.home;
        home.direction.at(home.revision, || {
            at_once(wall_direction_rad(
                &home.derived.knowledge,
                &mut StepBudget::unlimited(),
            ))
        })
    }

    /// Segments rooms and doors now. Takes some ten milliseconds for a home.
    pub fn segment_rooms(&mut self) {
        self.home.segment_rooms();
    }

    /// Straight walls, the line with most votes first. Takes some ten milliseconds for a home, so it is for display only.
    #[must_use]
    pub fn walls(&self) -> Vec<WallSegment> {
        walls(self.knowledge(), self.distance_field(), |cell| {
            self.sigma_m(cell).unwrap_or(0.0)
        })
    }

    /// Pose of a docked robot, once measured or reported.
    #[must_use]
    pub fn dock(&self) -> Option<Pose2> {
        self.home.dock.pose()
    }

    /// Location of the dock and its source.
    #[must_use]
    pub fn dock_location(&self) -> DockLocation {
        self.home.dock
    }

    /// Records that the robot is docked at this pose.
    pub fn measure_dock(&mut self, pose: Pose2) {
        self.home.dock.measure(pose);
        self.home.increment_revision();
    }

    /// Forbids a place where the robot got stuck, until the next job.
    pub(crate) fn forbid_pocket(&mut self, place: Point2) {
        self.home.forbid_pocket(place);
    }

    /// Allows again what [`Self::forbid_pocket`] forbade.
    pub(super) fn allow_pockets(&mut self) {
        self.home.allow_pockets();
    }

    /// Smallest pose uncertainty at which a cell was seen, metres; `None` if it never was.
    #[must_use]
    pub fn sigma_m(&self, cell: Cell) -> Option<f64> {
        self.home.grid.sigma_m(cell)
    }

    /// The floor as it is now, for judgements that go on while the map changes.
    pub(crate) fn home_floor(&self) -> HomeFloor {
        let home = &self.home;
        HomeFloor {
            knowledge: self.knowledge().clone(),
            grid: home.grid.clone(),
            kept: home.known.as_ref().map(|known| Arc::clone(&known.kept)),
            words: home.annotations.clone(),
            rooms: home.rooms.clone(),
            dock: self.dock(),
            radius_m: home.sensor_model.body.radius_m,
            forbids_cells: home.forbids_cells(),
        }
    }

    /// Whether the body was in a cell, in this run or an earlier one.
    pub(crate) fn was_driven(&self, cell: Cell) -> bool {
        self.home.grid.at(cell).has(Flag::Body)
    }

    /// Whether an earlier run has left a map of this home.
    pub(crate) fn knows_home(&self) -> bool {
        self.home.known.is_some()
    }

    /// Cells that were floor become free where `is_asked` of the knowledge so far and their index, whether they are occupied now or in
    /// dispute. Walls were none, and cliffs and no-go zones stay.
    pub(crate) fn open_past_floor(
        &self,
        knowledge: &mut Raster<CellKnowledge>,
        is_asked: impl Fn(&Raster<CellKnowledge>, usize) -> bool,
    ) {
        let past = EarlierFloor {
            grid: &self.home.grid,
            kept: self.home.known.as_ref().map(|known| &*known.kept),
        };
        for index in 0..knowledge.values().len() {
            past.open(knowledge, index, &is_asked);
        }
    }

    /// Bytes of the home's map, including sightings.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let home = &self.home;
        home.grid.memory_bytes()
            + home.base.memory_bytes()
            + home.derived.distance.memory_bytes()
            + home.derived.knowledge.values().len()
            + home.sightings.capacity() * size_of::<Sighting>()
    }
}
