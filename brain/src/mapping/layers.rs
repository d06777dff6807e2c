//! The tiled layers: what is known of each cell, gathered over all jobs.
//!
//! *Evidence*: small saturating counts for and against what a cell may be. *Knowledge*: what the evidence of a cell amounts
//! to. *Dirty*: cells whose knowledge may have changed since the derived rasters were last brought up to date.

use std::sync::Arc;

use super::tile_grid::{TILE_CELLS, TileGrid, TileKey, first_cell, locate};
use super::{Cell, FloorKind};

/// Tiles that the bounding box of a map may have: 1,638 square metres. What lies beyond is not remembered, so that no
/// stray pose makes the dense rasters outgrow the memory of a small board.
pub(super) const TILES_MAX: i64 = 640;

/// Tiles are remembered up to this far from the origin: one kilometre.
const KEY_MAX: i32 = 625;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKnowledge {
    /// Nothing.
    #[default]
    Unknown,
    /// Floor that the body can be on, as far as it was seen.
    Free,
    /// Something stands there.
    Occupied,
    /// The floor ends there.
    Cliff,
    /// A person does not want the robot there, or it got stuck there.
    NoGo,
}

/// What was gathered about a cell. Saturating; positive occupancy speaks for an obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Evidence {
    /// Log odds of an obstacle from infrared and from the body's own presence, in steps of about 0.05.
    pub(super) occupancy: i8,
    /// For a contact: things too low, too dark or too clear for infrared.
    pub(super) contact: u8,
    /// For the end of the floor.
    pub(super) cliff: u8,
    /// Standard deviation of the pose in centimetres when the cell was seen best.
    pub(super) sigma_cm: u8,
    /// [`Flag`]s.
    pub(super) flags: u8,
    /// What the motors' loads say: positive for carpet, negative for hard floor. No part of knowledge: nothing drives by it.
    pub(super) carpet: i8,
}

/// Something that is so or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flag {
    /// The body was here.
    Body = 1,
    /// Not to be entered.
    NoGo = 2,
    /// Something was seen here, so that `sigma_cm` counts.
    Seen = 4,
    /// The robot was trapped here; not to be entered in this job.
    Pocket = 8,
}

/// Occupancy from which on a cell counts as occupied.
const OCCUPIED_FROM: i8 = 12;
/// Occupancy up to which a cell counts as free.
const FREE_TO: i8 = -4;
/// Contact evidence from which on a cell counts as occupied.
const CONTACT_FROM: u8 = 2;
/// Cliff evidence from which on a cell counts as an edge.
const CLIFF_FROM: u8 = 2;

/// Evidence from which on a cell counts as carpet, and below the negative of which as hard floor: one pass of the brush's end.
const FLOOR_FROM: i8 = 3;
/// Most of that evidence: a rug that was taken away or brought is believed after two passes over it.
const FLOOR_MAX: i8 = 20;

impl Evidence {
    /// The kind of floor, if it was felt.
    pub(super) fn floor(self) -> Option<FloorKind> {
        match self.carpet {
            FLOOR_FROM.. => Some(FloorKind::Carpet),
            carpet if carpet <= -FLOOR_FROM => Some(FloorKind::Hard),
            _ => None,
        }
    }

    /// Takes in what was felt, with a weight.
    pub(super) fn feel(&mut self, kind: FloorKind, weight: i8) {
        let step = match kind {
            FloorKind::Hard => -weight,
            FloorKind::Carpet => weight,
        };
        self.carpet = self.carpet.saturating_add(step).clamp(-FLOOR_MAX, FLOOR_MAX);
    }

    pub(super) fn has(self, flag: Flag) -> bool {
        self.flags & flag as u8 != 0
    }

    pub(super) fn set(&mut self, flag: Flag) {
        self.flags |= flag as u8;
    }

    pub(super) fn clear(&mut self, flag: Flag) {
        self.flags &= !(flag as u8);
    }

    /// What all of it amounts to.
    pub(super) fn knowledge(self) -> CellKnowledge {
        if self.has(Flag::NoGo) || self.has(Flag::Pocket) {
            CellKnowledge::NoGo
        } else if self.cliff >= CLIFF_FROM {
            CellKnowledge::Cliff
        } else if self.occupancy >= OCCUPIED_FROM || self.contact >= CONTACT_FROM {
            CellKnowledge::Occupied
        } else if self.has(Flag::Body) || self.occupancy <= FREE_TO {
            CellKnowledge::Free
        } else {
            CellKnowledge::Unknown
        }
    }
}

/// Whether nothing but a touch tells that something stands there.
pub(super) fn is_touched_only(evidence: Evidence) -> bool {
    evidence.contact >= CONTACT_FROM && evidence.occupancy < OCCUPIED_FROM
}

/// Cells from `low` to `high`, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellBox {
    pub(super) low: Cell,
    pub(super) high: Cell,
}

impl CellBox {
    pub(super) fn of(cell: Cell) -> Self {
        Self {
            low: cell,
            high: cell,
        }
    }

    pub(super) fn joined(self, other: Self) -> Self {
        Self {
            low: Cell {
                x: self.low.x.min(other.low.x),
                y: self.low.y.min(other.low.y),
            },
            high: Cell {
                x: self.high.x.max(other.high.x),
                y: self.high.y.max(other.high.y),
            },
        }
    }

    pub(super) fn grown(self, cells: i32) -> Self {
        Self {
            low: Cell {
                x: self.low.x.saturating_sub(cells),
                y: self.low.y.saturating_sub(cells),
            },
            high: Cell {
                x: self.high.x.saturating_add(cells),
                y: self.high.y.saturating_add(cells),
            },
        }
    }

    /// Columns and rows.
    pub(super) fn size(self) -> (usize, usize) {
        let span = |low: i32, high: i32| usize::try_from(i64::from(high) - i64::from(low) + 1).unwrap_or(0);
        (span(self.low.x, self.high.x), span(self.low.y, self.high.y))
    }
}

#[derive(Clone, Debug)]
struct Tile {
    /// Shared with copies of the layers until one of them changes it, so that a copy costs next to nothing.
    cells: Arc<[Evidence]>,
    dirty: Option<CellBox>,
}

impl Default for Tile {
    fn default() -> Self {
        let area = (TILE_CELLS * TILE_CELLS) as usize;
        Self {
            cells: Arc::from(vec![Evidence::default(); area]),
            dirty: None,
        }
    }
}

/// Everything that was gathered about the cells of a floor.
#[derive(Clone, Debug, Default)]
pub(super) struct Layers {
    tiles: TileGrid<Tile>,
    /// Lowest and highest key.
    keys: Option<(TileKey, TileKey)>,
    /// Places of the tiles in `tiles` that are dirty.
    dirty: Vec<usize>,
}

impl Layers {
    /// Cells that tiles cover; `None` while there is none.
    pub(super) fn bounds(&self) -> Option<CellBox> {
        let (low, high) = self.keys?;
        Some(tile_box(low).joined(tile_box(high)))
    }

    /// What was gathered about a cell.
    pub(super) fn at(&self, cell: Cell) -> Evidence {
        let place = locate(cell);
        let tile = self.tiles.get(place.key);
        let evidence = tile.and_then(|tile| tile.cells.get(place.index()));
        evidence.copied().unwrap_or_default()
    }

    /// Changes what was gathered about a cell, unless it lies too far away to be remembered.
    pub(super) fn change(&mut self, cell: Cell, change: impl FnOnce(&mut Evidence)) {
        let located = locate(cell);
        let Some(place) = self.tile(located.key) else {
            return;
        };
        let Some(tile) = self.tiles.at_mut(place) else {
            return;
        };
        let Some(evidence) = Arc::make_mut(&mut tile.cells).get_mut(located.index()) else {
            return;
        };
        let before = evidence.knowledge();
        change(evidence);
        if evidence.knowledge() != before {
            match &mut tile.dirty {
                Some(dirty) => *dirty = dirty.joined(CellBox::of(cell)),
                none => {
                    *none = Some(CellBox::of(cell));
                    self.dirty.push(place);
                }
            }
        }
    }

    /// Whether some knowledge may have changed since [`Self::take_dirty`].
    pub(super) fn is_dirty(&self) -> bool {
        !self.dirty.is_empty()
    }

    /// The boxes in which knowledge may have changed, in the order in which they did.
    pub(super) fn take_dirty(&mut self) -> Vec<CellBox> {
        let places = core::mem::take(&mut self.dirty);
        places
            .into_iter()
            .filter_map(|place| self.tiles.at_mut(place)?.dirty.take())
            .collect()
    }

    /// One of these boxes, that of the tile that has waited longest.
    pub(super) fn take_dirty_tile(&mut self) -> Option<CellBox> {
        if self.dirty.is_empty() {
            return None;
        }
        let place = self.dirty.remove(0);
        self.tiles.at_mut(place)?.dirty.take()
    }

    /// Tiles in which knowledge may have changed.
    pub(super) fn dirty_tiles(&self) -> usize {
        self.dirty.len()
    }

    /// Everything counts as changed: for rasters that know nothing yet.
    pub(super) fn soil(&mut self) {
        let places: Vec<(TileKey, usize)> = self.tiles.places().collect();
        for (key, place) in &places {
            if let Some(tile) = self.tiles.at_mut(*place) {
                tile.dirty = Some(tile_box(*key));
            }
        }
        self.dirty = places.iter().map(|(_, place)| *place).collect();
    }

    /// Every cell about which something was gathered, row after row within tiles, tiles in the order of their keys.
    pub(super) fn gathered(&self) -> impl Iterator<Item = (Cell, Evidence)> + '_ {
        self.tiles.iter().flat_map(|(key, tile)| {
            let low = first_cell(key);
            tile.cells
                .iter()
                .enumerate()
                .filter(|(_, evidence)| **evidence != Evidence::default())
                .map(move |(index, evidence)| {
                    let (row, column) = (index as i32 / TILE_CELLS, index as i32 % TILE_CELLS);
                    let cell = Cell {
                        x: low.x + column,
                        y: low.y + row,
                    };
                    (cell, *evidence)
                })
        })
    }

    /// Bytes that the tiles take, those included that are shared with a copy.
    pub(super) fn memory_bytes(&self) -> usize {
        self.tiles.len() * (TILE_CELLS * TILE_CELLS) as usize * size_of::<Evidence>()
    }

    fn tile(&mut self, key: TileKey) -> Option<usize> {
        let keys = &mut self.keys;
        self.tiles.place(key, || {
            *keys = Some(grown(*keys, key)?);
            Some(Tile::default())
        })
    }
}

/// Lowest and highest key when a tile comes to be; `None` when that is too far away.
fn grown(keys: Option<(TileKey, TileKey)>, key: TileKey) -> Option<(TileKey, TileKey)> {
    if key.0.abs() > KEY_MAX || key.1.abs() > KEY_MAX {
        return None;
    }
    let (low, high) = keys.unwrap_or((key, key));
    let low = (low.0.min(key.0), low.1.min(key.1));
    let high = (high.0.max(key.0), high.1.max(key.1));
    let columns = i64::from(high.0) - i64::from(low.0) + 1;
    let rows = i64::from(high.1) - i64::from(low.1) + 1;
    (columns.saturating_mul(rows) <= TILES_MAX).then_some((low, high))
}

/// The cells of a tile.
fn tile_box(key: TileKey) -> CellBox {
    let low = first_cell(key);
    CellBox {
        low,
        high: Cell {
            x: low.x + TILE_CELLS - 1,
            y: low.y + TILE_CELLS - 1,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, CellKnowledge, Evidence, Flag, Layers};

    #[test]
    fn what_is_too_far_away_is_not_remembered() {
        let mut layers = Layers::default();
        layers.change(Cell { x: 0, y: 0 }, |evidence| evidence.occupancy = 100);
        for far in [(i32::MAX, 0), (0, i32::MIN), (i32::MIN, i32::MAX), (64 * 640, 0)] {
            let cell = Cell { x: far.0, y: far.1 };
            layers.change(cell, |evidence| evidence.occupancy = 100);
            assert_eq!(layers.at(cell), Evidence::default());
        }
        assert_eq!(layers.at(Cell { x: 0, y: 0 }).occupancy, 100);
        assert_eq!(layers.gathered().count(), 1);
    }

    #[test]
    fn only_a_change_of_knowledge_is_dirty() {
        let mut layers = Layers::default();
        let cell = Cell { x: -1, y: 70 };
        layers.change(cell, |evidence| evidence.occupancy = 3);
        assert!(!layers.is_dirty());
        layers.change(cell, |evidence| evidence.occupancy = 50);
        assert_eq!(layers.take_dirty(), [super::CellBox::of(cell)]);
        assert!(!layers.is_dirty() && layers.take_dirty().is_empty());
    }

    #[test]
    fn what_forbids_wins_over_what_allows() {
        let mut evidence = Evidence {
            occupancy: -100,
            ..Evidence::default()
        };
        assert_eq!(evidence.knowledge(), CellKnowledge::Free);
        evidence.contact = 4;
        assert_eq!(evidence.knowledge(), CellKnowledge::Occupied);
        evidence.cliff = 4;
        assert_eq!(evidence.knowledge(), CellKnowledge::Cliff);
        evidence.set(Flag::NoGo);
        assert_eq!(evidence.knowledge(), CellKnowledge::NoGo);
        evidence.clear(Flag::NoGo);
        assert_eq!(evidence.knowledge(), CellKnowledge::Cliff);
    }
}
