//! What the map knows of the home, for those who ask.

use super::Map;
use crate::mapping::layers::Flag;
use crate::mapping::sighting::Sighting;
use crate::mapping::wall_direction::wall_direction_rad;
use crate::mapping::walls::walls;
use crate::mapping::{
    CELL_M, Cell, CellKnowledge, DistanceField, DockPlace, FloorKind, Raster, Rooms, WallSegment,
};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// What is known of the home.
impl Map {
    /// Takes in what was perceived at a pose. Nothing is taken from a robot that is lost, lifted or silent, and nothing
    /// twice while it stands still.
    pub fn insert(&mut self, estimate: &PoseEstimate, observation: &Observation) {
        if self.home.is_full() {
            self.finish_redraw();
            self.settle();
        }
        self.home.insert(estimate, observation);
        self.home.refresh_on();
        self.home.survey_on();
        self.redraw_on();
    }

    /// What is known of each cell. Up to two seconds old; [`Self::refresh`] brings it up to date.
    #[must_use]
    pub fn knowledge(&self) -> &Raster<CellKnowledge> {
        &self.home.derived.knowledge
    }

    /// Area of all free floor that is known, in square metres. Counts all cells: not for every step.
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

    /// Begins to bring up to date what is derived, over the next steps: something was met, and plans must not miss it.
    pub(crate) fn begin_refresh(&mut self) {
        self.home.begin_refresh();
    }

    /// Whether nothing is just being brought up to date.
    pub(crate) fn is_fresh(&self) -> bool {
        self.home.stale_tiles == 0
    }

    /// Brings everything derived up to date now: for a planner that must not miss the last contact.
    pub fn refresh(&mut self) {
        self.home.refresh();
    }

    /// Grows whenever something derived has changed.
    #[must_use]
    pub fn revision(&self) -> u32 {
        self.home.revision
    }

    /// Grows when something is known of the kinds of floor that was not, up to two seconds late.
    #[must_use]
    pub fn floor_revision(&self) -> u32 {
        self.home.floor_revision
    }

    /// The kind of floor of a cell, if it was felt.
    #[must_use]
    pub fn floor_kind(&self, cell: Cell) -> Option<FloorKind> {
        self.home.layers.at(cell).floor()
    }

    /// The cells whose kind of floor is known, tile by tile.
    pub fn floor_kinds(&self) -> impl Iterator<Item = (Cell, FloorKind)> + '_ {
        let gathered = self.home.layers.gathered();
        gathered.filter_map(|(cell, evidence)| Some((cell, evidence.floor()?)))
    }

    /// Grows whenever the map was drawn again with other poses of the past: whoever has a plan in it needs another one.
    #[must_use]
    pub fn redrawn(&self) -> u32 {
        self.home.redrawn
    }

    /// Rooms and doors, up to two minutes old; [`Self::survey`] brings them up to date.
    #[must_use]
    pub fn rooms(&self) -> &Rooms {
        &self.home.rooms
    }

    /// Direction of the walls, above -pi/4 and up to pi/4; `None` when the home does not show one. Some ten milliseconds for a home
    /// that has changed since it was asked last.
    pub(crate) fn wall_direction_rad(&self) -> Option<f64> {
        let home = &self.home;
        home.direction.at(home.revision, || {
            at_once(wall_direction_rad(
                &home.derived.knowledge,
                &mut StepBudget::unlimited(),
            ))
        })
    }

    /// Looks for rooms and doors in what is known now. Some ten milliseconds for a home.
    pub fn survey(&mut self) {
        self.home.survey();
    }

    /// Straight walls in what is known, longest line first. Some ten milliseconds for a home: for people who look at it.
    #[must_use]
    pub fn walls(&self) -> Vec<WallSegment> {
        walls(self.knowledge(), self.distance_field(), |cell| {
            self.sigma_m(cell).unwrap_or(0.0)
        })
    }

    /// Pose of a robot that stands on the dock, once it has been there or a person has said where it is.
    #[must_use]
    pub fn dock(&self) -> Option<Pose2> {
        self.home.dock.pose()
    }

    /// The same with what it is known from.
    #[must_use]
    pub fn dock_place(&self) -> DockPlace {
        self.home.dock
    }

    /// The robot stands on its dock there.
    pub fn feel_dock(&mut self, pose: Pose2) {
        self.home.dock.feel(pose);
        self.home.touch();
    }

    /// Forbids a place that trapped the robot, until the next job.
    pub(crate) fn shut_pocket(&mut self, place: Point2) {
        self.home.shut_pocket(place);
    }

    /// Allows again what [`Self::shut_pocket`] forbade.
    pub(super) fn open_pockets(&mut self) {
        self.home.open_pockets();
    }

    /// Standard deviation of the pose when a cell was seen best, in metres; `None` if it never was.
    #[must_use]
    pub fn sigma_m(&self, cell: Cell) -> Option<f64> {
        let evidence = self.home.layers.at(cell);
        evidence
            .has(Flag::Seen)
            .then(|| 0.01 * f64::from(evidence.sigma_cm))
    }

    /// Bytes that the map of the home takes, sightings included.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let home = &self.home;
        home.layers.memory_bytes()
            + home.base.memory_bytes()
            + home.derived.distance.memory_bytes()
            + home.derived.knowledge.values().len()
            + home.sightings.capacity() * size_of::<Sighting>()
    }
}
