//! The floor of a home at one moment, for judgements in several steps while the map goes on: what can be reached, and what may be forbidden.

use std::sync::Arc;

use super::distance::window;
use super::home::without_no_go;
use super::kept_home::KeptHome;
use super::occupancy_grid::{CellBox, Flag, OccupancyGrid};
use super::reach::reachable_in_steps;
use super::zone_cells::{cells_around, cells_between};
use super::{Annotations, CELL_M, Cell, CellKnowledge, Raster, Rooms};
use crate::model::edit_error::EditError;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;
use crate::model::no_go::NoGo;
use crate::model::order::{CleaningOrder, HomePart, SPOT_RADIUS_M};
use crate::model::zone::Zone;

/// Length of the strip in front of the dock that must stay open, cells: from its end the robot can drive in.
const DOCK_STRIP_CELLS: u32 = 32;
/// Work to look at a cell, and to look it up in the tiles.
const LOOK_WORK: usize = 1;
const LOOK_UP_WORK: usize = 10;
/// Work to ask on which side of an edge of a zone a cell lies.
const EDGE_WORK: usize = 1;

/// The floor of a home at one moment.
#[derive(Debug)]
pub(crate) struct HomeFloor {
    pub(super) knowledge: Raster<CellKnowledge>,
    /// Shares its cells with the map until that changes them.
    pub(super) grid: OccupancyGrid,
    pub(super) kept: Option<Arc<KeptHome>>,
    pub(super) words: Annotations,
    pub(super) rooms: Rooms,
    pub(super) dock: Option<Pose2>,
    /// Of the body.
    pub(super) radius_m: f64,
    /// Whether any cells may be forbidden, for ever or until the next job.
    pub(super) forbids_cells: bool,
}

impl HomeFloor {
    pub(crate) fn knowledge(&self) -> &Raster<CellKnowledge> {
        &self.knowledge
    }

    pub(crate) fn annotations(&self) -> &Annotations {
        &self.words
    }

    pub(crate) fn rooms(&self) -> &Rooms {
        &self.rooms
    }

    pub(crate) fn dock(&self) -> Option<Pose2> {
        self.dock
    }

    /// Standard deviation of the pose at which a cell was seen, metres; `None` where it never was.
    pub(crate) fn sigma_m(&self, cell: Cell) -> Option<f64> {
        self.grid.sigma_m(cell)
    }

    /// Whether there is a cell of free floor.
    pub(crate) fn has_floor(&self) -> bool {
        self.knowledge.values().contains(&CellKnowledge::Free)
    }

    /// The knowledge with cells to avoid in a job as no-go cells.
    pub(crate) async fn avoiding(&self, avoid: &[NoGo], budget: &mut StepBudget) -> Raster<CellKnowledge> {
        let mut knowledge = self.knowledge.clone();
        forbid(&mut knowledge, avoid.iter(), budget).await;
        knowledge
    }

    /// The knowledge as if these alone were forbidden.
    pub(crate) async fn forbidding<'a>(
        &self,
        forbidden: impl Iterator<Item = &'a NoGo>,
        budget: &mut StepBudget,
    ) -> Raster<CellKnowledge> {
        let mut knowledge = if self.forbids_cells {
            without_no_go(&self.knowledge, &self.grid)
        } else {
            self.knowledge.clone()
        };
        budget.spend(LOOK_WORK * knowledge.values().len()).await;
        forbid(&mut knowledge, forbidden, budget).await;
        knowledge
    }

    /// Cells that were floor become free where `is_asked`, whether they are occupied now or in dispute. Walls were none, and cliffs and
    /// no-go zones stay.
    pub(crate) async fn open_past_floor(
        &self,
        knowledge: &mut Raster<CellKnowledge>,
        is_asked: impl Fn(Cell) -> bool,
        budget: &mut StepBudget,
    ) {
        let past = EarlierFloor {
            grid: &self.grid,
            kept: self.kept.as_deref(),
        };
        for index in 0..knowledge.values().len() {
            past.open(knowledge, index, |knowledge, index| {
                is_asked(knowledge.cell(index))
            });
            budget.spend(LOOK_UP_WORK).await;
        }
    }

    /// Whether the home has the parts of an order and the places that it avoids.
    ///
    /// # Errors
    /// What it does not have, or why a place cannot be avoided.
    pub(crate) async fn admit_order(
        &self,
        order: &CleaningOrder,
        budget: &mut StepBudget,
    ) -> Result<(), EditError> {
        for part in order.parts() {
            match part {
                HomePart::Room(id) if self.rooms.rooms().iter().all(|room| room.id != *id) => {
                    return Err(EditError::NoSuchRoom);
                }
                HomePart::Zone(_) | HomePart::Spot(_) if !self.has_floor_in(part, budget).await => {
                    return Err(EditError::NoFloorThere);
                }
                _ => {}
            }
        }
        self.may_forbid(order.avoid(), budget).await
    }

    async fn has_floor_in(&self, part: &HomePart, budget: &mut StepBudget) -> bool {
        let mut asked = Vec::new();
        self.mark_asked(part, &mut asked, budget).await;
        asked.contains(&true)
    }

    /// Marks the free floor of a part: the cells of [`Self::knowledge`], row after row.
    pub(crate) async fn mark_asked(&self, part: &HomePart, asked: &mut Vec<bool>, budget: &mut StepBudget) {
        asked.resize(self.knowledge.values().len(), false);
        let Some(all) = window(&self.knowledge) else {
            return;
        };
        let work = LOOK_WORK
            + match part {
                HomePart::Zone(zone) => EDGE_WORK * zone.corners().len(),
                HomePart::Room(_) | HomePart::Spot(_) => LOOK_WORK,
            };
        for cell in cells_of_part(part, all) {
            if let Some(index) = self.knowledge.index(cell)
                && self.knowledge.values().get(index) == Some(&CellKnowledge::Free)
                && self.rooms.is_in_part(cell, part)
                && let Some(place) = asked.get_mut(index)
            {
                *place = true;
            }
            budget.spend(work).await;
        }
    }

    /// Whether there is floor that each of these forbids, and the dock stays within reach.
    ///
    /// # Errors
    /// What speaks against the first of them that may not be.
    pub(crate) async fn may_forbid(&self, no_gos: &[NoGo], budget: &mut StepBudget) -> Result<(), EditError> {
        let Some(window) = self.grid.bounds().filter(|_| !self.knowledge.values().is_empty()) else {
            return if no_gos.is_empty() {
                Ok(())
            } else {
                Err(EditError::NoMap)
            };
        };
        let mut way = match self.dock {
            Some(dock) if !no_gos.is_empty() => Some(self.way_to_dock(dock, budget).await),
            _ => None,
        };
        if let Some(way) = &mut way {
            // What all of them together leave open each of them does.
            way.is_kept_by_all = no_gos.len() > 1 && self.keeps(way, no_gos, budget).await;
        }
        for no_go in no_gos {
            if !self.forbids_floor(no_go.area(), window, budget).await {
                return Err(EditError::NoFloorThere);
            }
            let Some(way) = &way else { continue };
            if self.is_in_strip(no_go.area(), way) {
                return Err(EditError::DockInside);
            }
            if !way.is_kept_by_all && !self.keeps(way, core::slice::from_ref(no_go), budget).await {
                return Err(EditError::DockShutOff);
            }
        }
        Ok(())
    }

    async fn forbids_floor(&self, area: &Zone, window: CellBox, budget: &mut StepBudget) -> bool {
        for cell in cells_around(area, window) {
            let kind = self.knowledge.get(cell);
            let is_floor = matches!(kind, Some(CellKnowledge::Free | CellKnowledge::NoGo));
            if is_floor && area.contains(cell.middle()) {
                return true;
            }
            budget.spend(LOOK_WORK + EDGE_WORK * area.corners().len()).await;
        }
        false
    }

    async fn way_to_dock(&self, dock: Pose2, budget: &mut StepBudget) -> WayToDock {
        let mut way = WayToDock {
            dock,
            reached_cells: 0,
            is_kept_by_all: false,
        };
        way.reached_cells = self.reached_cells(&self.knowledge, way.beginning(), budget).await;
        way
    }

    fn is_in_strip(&self, zone: &Zone, way: &WayToDock) -> bool {
        let mut steps = 0..=DOCK_STRIP_CELLS;
        steps.any(|step| zone.distance_m(way.ahead(step)) < self.radius_m)
    }

    /// Whether most of the floor that is within reach of the dock now stays so.
    async fn keeps(&self, way: &WayToDock, no_gos: &[NoGo], budget: &mut StepBudget) -> bool {
        let forbidden = self.avoiding(no_gos, budget).await;
        let left = self.reached_cells(&forbidden, way.beginning(), budget).await;
        // Two fifths: a wall that keeps one of two rooms of a size is a wish, not a mistake.
        5 * left >= 2 * way.reached_cells
    }

    async fn reached_cells(
        &self,
        knowledge: &Raster<CellKnowledge>,
        from: Point2,
        budget: &mut StepBudget,
    ) -> usize {
        let reached = reachable_in_steps(knowledge, (from, self.radius_m), budget).await;
        reached.values().iter().filter(|is| **is).count()
    }
}

/// The way to the dock as it is without anything more forbidden.
struct WayToDock {
    dock: Pose2,
    /// From where it begins.
    reached_cells: usize,
    /// By all places to avoid together.
    is_kept_by_all: bool,
}

impl WayToDock {
    /// So many cells before the dock.
    fn ahead(&self, cells: u32) -> Point2 {
        self.dock.transform(Point2 {
            x_m: -f64::from(cells) * CELL_M,
            y_m: 0.0,
        })
    }

    /// The place before the dock from which the robot drives in.
    fn beginning(&self) -> Point2 {
        self.ahead(DOCK_STRIP_CELLS)
    }
}

/// Cells of `window` among which those of a part are.
fn cells_of_part(part: &HomePart, window: CellBox) -> Box<dyn Iterator<Item = Cell> + Send> {
    match part {
        HomePart::Room(_) => {
            let CellBox { low, high } = window;
            Box::new(cells_between(low.middle(), high.middle(), window))
        }
        HomePart::Zone(zone) => Box::new(cells_around(zone, window)),
        HomePart::Spot(at) => {
            let corner = |way_m: f64| Point2 {
                x_m: at.x_m + way_m,
                y_m: at.y_m + way_m,
            };
            Box::new(cells_between(
                corner(-SPOT_RADIUS_M),
                corner(SPOT_RADIUS_M),
                window,
            ))
        }
    }
}

/// Forbids cells besides.
pub(super) async fn forbid<'a>(
    knowledge: &mut Raster<CellKnowledge>,
    forbidden: impl Iterator<Item = &'a NoGo>,
    budget: &mut StepBudget,
) {
    let Some(all) = window(knowledge) else { return };
    for area in forbidden.map(NoGo::area) {
        for cell in cells_around(area, all) {
            if area.contains(cell.middle())
                && let Some(kind) = knowledge.get_mut(cell)
            {
                *kind = CellKnowledge::NoGo;
            }
            budget.spend(LOOK_WORK + EDGE_WORK * area.corners().len()).await;
        }
    }
}

/// What was floor, whatever stands there now.
#[derive(Clone, Copy, Debug)]
pub(super) struct EarlierFloor<'a> {
    pub(super) grid: &'a OccupancyGrid,
    pub(super) kept: Option<&'a KeptHome>,
}

impl EarlierFloor<'_> {
    /// Whether a cell was floor before this run, or the body was in it.
    fn was_floor(self, cell: Cell) -> bool {
        self.kept
            .is_some_and(|kept| kept.at(cell).knowledge() == CellKnowledge::Free)
            || self.grid.at(cell).has(Flag::Body)
    }

    /// A cell that was floor becomes free where `is_asked` of the knowledge so far and the cell's index, whether it is occupied now or in
    /// dispute.
    pub(super) fn open(
        self,
        knowledge: &mut Raster<CellKnowledge>,
        index: usize,
        is_asked: impl Fn(&Raster<CellKnowledge>, usize) -> bool,
    ) {
        let is_met = matches!(
            knowledge.values().get(index),
            Some(CellKnowledge::Occupied | CellKnowledge::Unknown)
        );
        if is_met
            && is_asked(knowledge, index)
            && self.was_floor(knowledge.cell(index))
            && let Some(kind) = knowledge.values_mut().get_mut(index)
        {
            *kind = CellKnowledge::Free;
        }
    }
}
