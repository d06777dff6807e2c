//! Rooms by distance segmentation, and the doors between them.
//!
//! Water rises in a relief of distances to the nearest obstacle, from the widest places down. A pool that meets another one
//! in a passage narrower than a wide door stays apart from it; else the two become one. Furniture that stands free is no
//! obstacle here, or every chair would divide a room. Rooms keep their identities: a new room takes over that of the old
//! room with which it shares most cells. What people have changed of the rooms is done after that.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cell::neighbours;
use super::distance::{squared_cells, window};
use super::doors::{Door, doors};
use super::raster::CELLS;
use super::room_changes::RoomChanges;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// Half of the widest passage that still divides two rooms, metres.
const DOOR_HALF_M: f64 = 0.55;
/// A room is wider than the passage to it by this factor at least.
const WIDER: f64 = 1.25;
/// A pool smaller than this when it meets another one is a corner of it, square metres.
const CORE_M2: f64 = 0.2;
/// Rooms smaller than this are none, square metres.
const ROOM_M2: f64 = 1.0;
/// What is not free and smaller than this is furniture, square metres.
const FURNITURE_M2: f64 = 1.2;

/// Work of a cell: visited, named, flooded.
const VISIT_WORK: usize = 8;
const NAME_WORK: usize = 6;
const FLOOD_WORK: usize = 25;

/// A room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Identity, from 1; kept when the home is mapped again.
    pub id: u16,
    /// Its floor in square metres.
    pub area_m2: f64,
    /// The place in it that is farthest from everything.
    pub middle: Point2,
}

/// Rooms and doors of a home.
#[derive(Clone, Debug, PartialEq)]
pub struct Rooms {
    /// Shared with the search that goes on from it.
    found: Arc<Raster<u16>>,
    /// After the changes of people, if there are any.
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

    /// Identity of the room of each cell, 0 = none.
    #[must_use]
    pub fn labels(&self) -> &Raster<u16> {
        self.changed.as_ref().unwrap_or(&self.found)
    }

    /// The same without the changes of people.
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

    /// Identity that the next new room gets.
    pub(super) fn next(&self) -> u16 {
        self.next
    }

    /// Another identity that no room has had.
    pub(super) fn take_next(&mut self) -> u16 {
        let next = self.next;
        self.next = next.saturating_add(1);
        next
    }

    /// Rooms of an earlier time, of which only cells and identities are known.
    pub(super) fn remembered(found: Raster<u16>, next: u16) -> Self {
        let highest = found.values().iter().copied().max().unwrap_or(0);
        Self {
            found: Arc::new(found),
            next: next.max(highest.saturating_add(1)),
            ..Self::default()
        }
    }

    /// The rooms of what is known now; those that were there before keep their identities.
    #[must_use]
    pub fn renewed(&self, knowledge: &Raster<CellKnowledge>) -> Self {
        let unchanged = RoomChanges::default();
        at_once(self.renewed_in_steps((knowledge, &unchanged), &mut StepBudget::unlimited()))
    }

    /// As [`Self::renewed`], and changed as people want them, step by step.
    pub(super) async fn renewed_in_steps(
        &self,
        (knowledge, changes): (&Raster<CellKnowledge>, &RoomChanges),
        budget: &mut StepBudget,
    ) -> Self {
        let Some(all) = window(knowledge) else {
            return self.clone();
        };
        let space = space(knowledge, budget).await;
        let is_border = |cell| space.get(cell) != Some(&true);
        let squared = squared_cells(all, is_border, budget).await;
        let labels = labels_of_pools(&squared, &space, budget).await;
        let (names, next) = self.names(&labels, budget).await;
        let found = renamed(labels, &names, budget).await;
        let changed = if changes.is_empty() {
            None
        } else {
            Some(changes.made_in(&found, budget).await)
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

    /// An identity for each new label, by the cells shared with rooms of old; and the next free one.
    async fn names(&self, labels: &Raster<u16>, budget: &mut StepBudget) -> (BTreeMap<u16, u16>, u16) {
        let mut shared: BTreeMap<(u16, u16), u32> = BTreeMap::new();
        for (index, label) in labels.values().iter().enumerate() {
            if index % CELLS == 0 {
                budget.spend(NAME_WORK * CELLS).await;
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

/// Free cells, and furniture that stands in them.
async fn space(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Raster<bool> {
    let mut space = Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), false);
    for (place, kind) in space.values_mut().iter_mut().zip(knowledge.values()) {
        *place = *kind == CellKnowledge::Free;
    }
    let furniture_max = (FURNITURE_M2 / (CELL_M * CELL_M)) as usize;
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

/// The connected cells that were not seen yet; they are seen afterwards.
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

/// A pool of the rising water. One that has become part of another one tells of which.
#[derive(Clone, Copy, Debug)]
struct Pool {
    /// The pool that it is part of; its own number while it stands alone.
    parent: u32,
    cells: u32,
    /// Greatest squared depth.
    deepest: f32,
}

/// Pools of the rising water: a forest, each tree one pool.
struct Pools<'relief> {
    squared: &'relief [f32],
    /// Number of the pool of each cell, [`DRY`] where there is no water yet.
    pool_of: Vec<u32>,
    pools: Vec<Pool>,
}

/// The pool of a cell that the water has not reached.
const DRY: u32 = u32::MAX;

impl<'relief> Pools<'relief> {
    fn new(squared: &'relief [f32]) -> Self {
        Self {
            squared,
            pool_of: vec![DRY; squared.len()],
            pools: Vec::new(),
        }
    }

    async fn fill(&mut self, space: &Raster<bool>, budget: &mut StepBudget) {
        // Squared distances are whole numbers, and not many: each has a list of its own.
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

    /// The water reaches a cell: it falls to the pools beside it, which perhaps become one, or is a pool by itself.
    fn flood(&mut self, index: u32, space: &Raster<bool>) {
        let place = index as usize;
        let level = self.squared.get(place).copied().unwrap_or(0.0);
        let mut joined = None;
        for neighbour in neighbours(space.cell(place)) {
            let Some(other) = space.index(neighbour).and_then(|beside| self.pool_at(beside)) else {
                continue;
            };
            joined = Some(match joined {
                None => self.take_in(other, level),
                Some(one) if one != other && self.become_one((one, other), level) => self.join(one, other),
                Some(one) => one,
            });
        }
        let pool = joined.unwrap_or_else(|| self.begin(level));
        if let Some(slot) = self.pool_of.get_mut(place) {
            *slot = pool;
        }
    }

    /// The pool, standing alone, that a cell belongs to.
    fn pool_at(&mut self, place: usize) -> Option<u32> {
        let pool = self.pool_of.get(place).copied().filter(|pool| *pool != DRY)?;
        let root = self.root(pool);
        if root != pool
            && let Some(slot) = self.pool_of.get_mut(place)
        {
            *slot = root;
        }
        Some(root)
    }

    fn root(&mut self, pool: u32) -> u32 {
        let parent = |pools: &[Pool], pool: u32| pools.get(pool as usize).map_or(pool, |pool| pool.parent);
        let mut at = pool;
        loop {
            let above = parent(&self.pools, at);
            if above == at {
                return at;
            }
            let next = parent(&self.pools, above);
            if let Some(pool) = self.pools.get_mut(at as usize) {
                pool.parent = next;
            }
            at = next;
        }
    }

    /// A new pool of one cell.
    fn begin(&mut self, level: f32) -> u32 {
        let number = self.pools.len() as u32;
        self.pools.push(Pool {
            parent: number,
            cells: 1,
            deepest: level,
        });
        number
    }

    /// A pool that stands alone takes in another cell.
    fn take_in(&mut self, root: u32, level: f32) -> u32 {
        if let Some(pool) = self.pools.get_mut(root as usize) {
            pool.cells += 1;
            pool.deepest = pool.deepest.max(level);
        }
        root
    }

    fn become_one(&self, (one, other): (u32, u32), level: f32) -> bool {
        let half_m = f64::from(level).sqrt() * CELL_M;
        if half_m > DOOR_HALF_M {
            return true;
        }
        let is_room = |root: u32| {
            let pool = self.pools.get(root as usize);
            pool.is_some_and(|pool| {
                let wide_enough = f64::from(pool.deepest) >= WIDER * WIDER * f64::from(level);
                f64::from(pool.cells) * CELL_M * CELL_M >= CORE_M2 && wide_enough
            })
        };
        !(is_room(one) && is_room(other))
    }

    /// Two pools that stand alone become one; gives its number.
    fn join(&mut self, one: u32, other: u32) -> u32 {
        let pool = |pools: &Self, root: u32| pools.pools.get(root as usize).copied();
        let (Some(first), Some(second)) = (pool(self, one), pool(self, other)) else {
            return one;
        };
        let (large, small) = if first.cells >= second.cells {
            (one, other)
        } else {
            (other, one)
        };
        if let Some(pool) = self.pools.get_mut(small as usize) {
            pool.parent = large;
        }
        if let Some(pool) = self.pools.get_mut(large as usize) {
            pool.cells = first.cells + second.cells;
            pool.deepest = first.deepest.max(second.deepest);
        }
        large
    }

    /// A label for each cell of a pool that is large enough for a room; 0 for the others.
    async fn labels(&mut self, space: &Raster<bool>, budget: &mut StepBudget) -> Raster<u16> {
        let mut labels = Raster::filled(space.origin(), space.width(), space.height(), 0_u16);
        let mut known: BTreeMap<u32, u16> = BTreeMap::new();
        for index in 0..self.pool_of.len() {
            if index % CELLS == 0 {
                budget.spend(NAME_WORK * CELLS).await;
            }
            let Some(root) = self.pool_at(index) else {
                continue;
            };
            let cells = self.pools.get(root as usize).map_or(0, |pool| pool.cells);
            if f64::from(cells) * CELL_M * CELL_M < ROOM_M2 {
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

/// As [`Pools::labels`]. The pools are given back before anything else is looked for: they take most of the memory.
async fn labels_of_pools(squared: &[f32], space: &Raster<bool>, budget: &mut StepBudget) -> Raster<u16> {
    let mut pools = Pools::new(squared);
    pools.fill(space, budget).await;
    pools.labels(space, budget).await
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
        budget.spend(NAME_WORK * some.len()).await;
    }
    labels
}

async fn measured(labels: &Raster<u16>, squared: &[f32], budget: &mut StepBudget) -> Vec<Room> {
    let mut found: BTreeMap<u16, (u32, usize, f32)> = BTreeMap::new();
    for (index, label) in labels.values().iter().enumerate() {
        if index % CELLS == 0 {
            budget.spend(NAME_WORK * CELLS).await;
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
