//! Room segmentation: a watershed of the distance transform, and the doors between rooms.
//!
//! The watershed starts at the largest distances to obstacles. Two basins that meet in a passage narrower than a wide door stay
//! separate; otherwise they merge. Free-standing furniture is not an obstacle here, or every chair would divide a room. Rooms
//! keep their identities: a new room takes the identity of the old room with which it shares most cells. Splits and joins by
//! people apply afterwards.

mod parameters;

use std::collections::BTreeMap;
use std::sync::Arc;

use parameters::SEGMENTATION;

use super::cell::neighbours;
use super::distance::{squared_cells, window};
use super::doors::{Door, doors};
use super::raster::CELLS;
use super::room_changes::RoomChanges;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// Work per cell: visit, relabel, flood.
const VISIT_WORK: usize = 8;
const RELABEL_WORK: usize = 6;
const FLOOD_WORK: usize = 25;

/// A room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Identity, from 1. It survives a new segmentation.
    pub id: u16,
    /// Floor area in square metres.
    pub area_m2: f64,
    /// The position in the room farthest from all obstacles.
    pub middle: Point2,
}

/// Rooms and doors of a home.
#[derive(Clone, Debug, PartialEq)]
pub struct Rooms {
    /// Shared with the segmentation that continues from it.
    found: Arc<Raster<u16>>,
    /// With the changes by people, if there are any.
    changed: Option<Raster<u16>>,
    rooms: Vec<Room>,
    doors: Vec<Door>,
    next: u16,
}

impl Default for Rooms {
    fn default() -> Self {
        Self {
            found: Arc::new(Raster::filled(Cell::default(), 0, 0, 0)),
            changed: None,
            rooms: Vec::new(),
            doors: Vec::new(),
            next: 1,
        }
    }
}

impl Rooms {
    /// All rooms by identity.
    #[must_use]
    pub fn rooms(&self) -> &[Room] {
        &self.rooms
    }

    /// All doors by the identities of their rooms.
    #[must_use]
    pub fn doors(&self) -> &[Door] {
        &self.doors
    }

    /// Room identity of each cell, 0 = none.
    #[must_use]
    pub fn labels(&self) -> &Raster<u16> {
        self.changed.as_ref().unwrap_or(&self.found)
    }

    /// The labels without the changes by people.
    pub(super) fn found(&self) -> &Raster<u16> {
        &self.found
    }

    /// Identity of the room under a point.
    #[must_use]
    pub fn room_at(&self, point: Point2) -> Option<u16> {
        self.labels()
            .get(Cell::under(point))
            .copied()
            .filter(|id| *id > 0)
    }

    /// Identity of the next new room.
    pub(super) fn next_id(&self) -> u16 {
        self.next
    }

    /// New rooms get this identity or a higher one.
    pub(super) fn number_after(&mut self, next: u16) {
        self.next = self.next.max(next);
    }

    /// Allocates an identity that no room has had.
    pub(super) fn allocate_id(&mut self) -> u16 {
        let next = self.next;
        self.next = next.saturating_add(1);
        next
    }

    /// Rooms of a stored map, of which only cells and identities are known.
    pub(super) fn from_stored(found: Raster<u16>, next: u16) -> Self {
        let highest = found.values().iter().copied().max().unwrap_or(0);
        Self {
            found: Arc::new(found),
            next: next.max(highest.saturating_add(1)),
            ..Self::default()
        }
    }

    /// Segments the present map; existing rooms keep their identities.
    #[must_use]
    pub fn segmented(&self, knowledge: &Raster<CellKnowledge>) -> Self {
        let unchanged = RoomChanges::default();
        at_once(self.segmented_in_steps(knowledge, &unchanged, &mut StepBudget::unlimited()))
    }

    /// As [`Self::segmented`], with the changes by people, in steps.
    pub(super) async fn segmented_in_steps(
        &self,
        knowledge: &Raster<CellKnowledge>,
        changes: &RoomChanges,
        budget: &mut StepBudget,
    ) -> Self {
        let Some(all) = window(knowledge) else {
            return self.clone();
        };
        let space = space(knowledge, budget).await;
        let is_border = |cell| space.get(cell) != Some(&true);
        let squared = squared_cells(all, is_border, budget).await;
        let labels = watershed(&squared, &space, budget).await;
        let (names, next) = self.identities(&labels, budget).await;
        let found = renamed(labels, &names, budget).await;
        let changed = if changes.is_empty() {
            None
        } else {
            Some(changes.apply_to(&found, budget).await)
        };
        let labels = changed.as_ref().unwrap_or(&found);
        let rooms = measured(labels, &squared, budget).await;
        let doors = doors(labels, &squared, budget).await;
        Self {
            found: Arc::new(found),
            changed,
            rooms,
            doors,
            next,
        }
    }

    /// An identity for each new label, by the cells shared with old rooms; and the next free one.
    async fn identities(&self, labels: &Raster<u16>, budget: &mut StepBudget) -> (BTreeMap<u16, u16>, u16) {
        let mut shared: BTreeMap<(u16, u16), u32> = BTreeMap::new();
        for (index, label) in labels.values().iter().enumerate() {
            if index % CELLS == 0 {
                budget.spend(RELABEL_WORK * CELLS).await;
            }
            if *label == 0 {
                continue;
            }
            let old = self.found.get(labels.cell(index)).copied().unwrap_or(0);
            *shared.entry((*label, old)).or_default() += 1;
        }
        let mut pairs: Vec<((u16, u16), u32)> = shared.iter().map(|(pair, count)| (*pair, *count)).collect();
        pairs.sort_by_key(|(pair, count)| (core::cmp::Reverse(*count), *pair));
        let mut names = BTreeMap::new();
        for ((label, old), _) in pairs {
            let is_taken = names.values().any(|name| *name == old);
            if old > 0 && !is_taken && !names.contains_key(&label) {
                names.insert(label, old);
            }
        }
        let mut next = self.next;
        for (label, _) in shared.keys() {
            if !names.contains_key(label) {
                names.insert(*label, next);
                next = next.saturating_add(1);
            }
        }
        (names, next)
    }
}

/// Free cells, and the furniture that stands in them.
async fn space(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Raster<bool> {
    let mut space = Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), false);
    for (place, kind) in space.values_mut().iter_mut().zip(knowledge.values()) {
        *place = *kind == CellKnowledge::Free;
    }
    let furniture_max = (SEGMENTATION.furniture_max_m2 / (CELL_M * CELL_M)) as usize;
    let mut seen = space.clone();
    for index in 0..seen.values().len() {
        if index % CELLS == 0 {
            budget.spend(CELLS).await;
        }
        if seen.values().get(index) == Some(&false) {
            let island = island(&mut seen, index, budget).await;
            if island.len() <= furniture_max && !touches_border(&space, &island) {
                for cell in island {
                    if let Some(place) = space.get_mut(cell) {
                        *place = true;
                    }
                }
            }
        }
    }
    space
}

/// The unvisited cells connected to one. Marks them as visited.
async fn island(seen: &mut Raster<bool>, index: usize, budget: &mut StepBudget) -> Vec<Cell> {
    let mut cells = vec![seen.cell(index)];
    if let Some(place) = seen.values_mut().get_mut(index) {
        *place = true;
    }
    let mut next = 0;
    while let Some(cell) = cells.get(next).copied() {
        next += 1;
        if next % CELLS == 0 {
            budget.spend(VISIT_WORK * CELLS).await;
        }
        for neighbour in neighbours(cell) {
            if let Some(place) = seen.get_mut(neighbour)
                && !*place
            {
                *place = true;
                cells.push(neighbour);
            }
        }
    }
    cells
}

fn touches_border(space: &Raster<bool>, island: &[Cell]) -> bool {
    island
        .iter()
        .any(|cell| neighbours(*cell).iter().any(|next| space.get(*next).is_none()))
}

/// A basin of the watershed: an element of a disjoint-set forest.
#[derive(Clone, Copy, Debug)]
struct Basin {
    /// Parent in the forest; its own index at the root.
    parent: u32,
    cells: u32,
    /// Largest squared distance to an obstacle.
    deepest: f32,
}

/// The basins of the watershed as a disjoint-set forest: each tree is one basin.
struct Basins<'relief> {
    squared: &'relief [f32],
    /// Basin of each cell, [`UNLABELLED`] before it is flooded.
    basin_of: Vec<u32>,
    basins: Vec<Basin>,
}

/// The basin of a cell that is not flooded yet.
const UNLABELLED: u32 = u32::MAX;

impl<'relief> Basins<'relief> {
    fn new(squared: &'relief [f32]) -> Self {
        Self {
            squared,
            basin_of: vec![UNLABELLED; squared.len()],
            basins: Vec::new(),
        }
    }

    async fn fill(&mut self, space: &Raster<bool>, budget: &mut StepBudget) {
        // Squared distances are small whole numbers, so a bucket per value sorts them.
        let mut levels: Vec<Vec<u32>> = Vec::new();
        for (index, squared) in self.squared.iter().enumerate() {
            if index % CELLS == 0 {
                budget.spend(VISIT_WORK * CELLS).await;
            }
            if space.values().get(index) == Some(&true) {
                let level = *squared as usize;
                if levels.len() <= level {
                    levels.resize(level + 1, Vec::new());
                }
                if let Some(list) = levels.get_mut(level) {
                    list.push(index as u32);
                }
            }
        }
        for some in levels.iter().rev().flat_map(|level| level.chunks(CELLS)) {
            for index in some {
                self.flood(*index, space);
            }
            budget.spend(FLOOD_WORK * some.len()).await;
        }
    }

    /// Floods a cell: it joins the basins beside it, which may merge, or begins one.
    fn flood(&mut self, index: u32, space: &Raster<bool>) {
        let place = index as usize;
        let level = self.squared.get(place).copied().unwrap_or(0.0);
        let mut joined = None;
        for neighbour in neighbours(space.cell(place)) {
            let Some(other) = space.index(neighbour).and_then(|beside| self.root_at(beside)) else {
                continue;
            };
            joined = Some(match joined {
                None => self.add_cell(other, level),
                Some(one) if one != other && self.merges(one, other, level) => self.merge(one, other),
                Some(one) => one,
            });
        }
        let basin = joined.unwrap_or_else(|| self.begin(level));
        if let Some(slot) = self.basin_of.get_mut(place) {
            *slot = basin;
        }
    }

    /// Index of the root basin of a cell.
    fn root_at(&mut self, place: usize) -> Option<u32> {
        let basin = self
            .basin_of
            .get(place)
            .copied()
            .filter(|basin| *basin != UNLABELLED)?;
        let root = self.root(basin);
        if root != basin
            && let Some(slot) = self.basin_of.get_mut(place)
        {
            *slot = root;
        }
        Some(root)
    }

    fn root(&mut self, basin: u32) -> u32 {
        let parent =
            |basins: &[Basin], basin: u32| basins.get(basin as usize).map_or(basin, |basin| basin.parent);
        let mut at = basin;
        loop {
            let above = parent(&self.basins, at);
            if above == at {
                return at;
            }
            let next = parent(&self.basins, above);
            if let Some(basin) = self.basins.get_mut(at as usize) {
                basin.parent = next;
            }
            at = next;
        }
    }

    /// A new basin of one cell.
    fn begin(&mut self, level: f32) -> u32 {
        let number = self.basins.len() as u32;
        self.basins.push(Basin {
            parent: number,
            cells: 1,
            deepest: level,
        });
        number
    }

    /// Adds a cell to a root basin.
    fn add_cell(&mut self, root: u32, level: f32) -> u32 {
        if let Some(basin) = self.basins.get_mut(root as usize) {
            basin.cells += 1;
            basin.deepest = basin.deepest.max(level);
        }
        root
    }

    fn merges(&self, one: u32, other: u32, level: f32) -> bool {
        let half_m = f64::from(level).sqrt() * CELL_M;
        if half_m > SEGMENTATION.passage_half_max_m {
            return true;
        }
        let is_room = |root: u32| {
            let basin = self.basins.get(root as usize);
            basin.is_some_and(|basin| {
                let is_wide_enough = f64::from(basin.deepest)
                    >= SEGMENTATION.width_ratio_min * SEGMENTATION.width_ratio_min * f64::from(level);
                f64::from(basin.cells) * CELL_M * CELL_M >= SEGMENTATION.core_min_m2 && is_wide_enough
            })
        };
        !(is_room(one) && is_room(other))
    }

    /// Merges two root basins and returns the root.
    fn merge(&mut self, one: u32, other: u32) -> u32 {
        let basin = |basins: &Self, root: u32| basins.basins.get(root as usize).copied();
        let (Some(first), Some(second)) = (basin(self, one), basin(self, other)) else {
            return one;
        };
        let (large, small) = if first.cells >= second.cells {
            (one, other)
        } else {
            (other, one)
        };
        if let Some(basin) = self.basins.get_mut(small as usize) {
            basin.parent = large;
        }
        if let Some(basin) = self.basins.get_mut(large as usize) {
            basin.cells = first.cells + second.cells;
            basin.deepest = first.deepest.max(second.deepest);
        }
        large
    }

    /// A label for each cell of a basin that is large enough for a room; 0 for the others.
    async fn labels(&mut self, space: &Raster<bool>, budget: &mut StepBudget) -> Raster<u16> {
        let mut labels = Raster::filled(space.origin(), space.width(), space.height(), 0_u16);
        let mut known: BTreeMap<u32, u16> = BTreeMap::new();
        for index in 0..self.basin_of.len() {
            if index % CELLS == 0 {
                budget.spend(RELABEL_WORK * CELLS).await;
            }
            let Some(root) = self.root_at(index) else {
                continue;
            };
            let cells = self.basins.get(root as usize).map_or(0, |basin| basin.cells);
            if f64::from(cells) * CELL_M * CELL_M < SEGMENTATION.room_min_m2 {
                continue;
            }
            let fresh = u16::try_from(known.len() + 1).unwrap_or(u16::MAX);
            let label = *known.entry(root).or_insert(fresh);
            if let Some(place) = labels.values_mut().get_mut(index) {
                *place = label;
            }
        }
        labels
    }
}

/// As [`Basins::labels`]. The basins take most of the memory, so they are freed before the next stage.
async fn watershed(squared: &[f32], space: &Raster<bool>, budget: &mut StepBudget) -> Raster<u16> {
    let mut basins = Basins::new(squared);
    basins.fill(space, budget).await;
    basins.labels(space, budget).await
}

async fn renamed(
    mut labels: Raster<u16>,
    names: &BTreeMap<u16, u16>,
    budget: &mut StepBudget,
) -> Raster<u16> {
    for some in labels.values_mut().chunks_mut(CELLS) {
        for label in some.iter_mut().filter(|label| **label > 0) {
            *label = names.get(label).copied().unwrap_or(0);
        }
        budget.spend(RELABEL_WORK * some.len()).await;
    }
    labels
}

async fn measured(labels: &Raster<u16>, squared: &[f32], budget: &mut StepBudget) -> Vec<Room> {
    let mut found: BTreeMap<u16, (u32, usize, f32)> = BTreeMap::new();
    for (index, label) in labels.values().iter().enumerate() {
        if index % CELLS == 0 {
            budget.spend(RELABEL_WORK * CELLS).await;
        }
        if *label == 0 {
            continue;
        }
        let depth = squared.get(index).copied().unwrap_or(0.0);
        let room = found.entry(*label).or_insert((0, index, depth));
        room.0 += 1;
        if depth > room.2 {
            (room.1, room.2) = (index, depth);
        }
    }
    found
        .into_iter()
        .map(|(id, (cells, index, _))| Room {
            id,
            area_m2: f64::from(cells) * CELL_M * CELL_M,
            middle: labels.cell(index).middle(),
        })
        .collect()
}
