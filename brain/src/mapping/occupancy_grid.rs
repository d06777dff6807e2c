//! The occupancy grid: evidence for each cell, accumulated over all jobs.
//!
//! *Evidence*: small saturating counts for and against the possible states of a cell. *Knowledge*: the state that the evidence
//! supports. *Dirty*: cells whose knowledge may have changed since the last update of the derived rasters.

use std::sync::Arc;

use super::cell_past::CellPast;
use super::tile_grid::{TILE_CELLS, TileGrid, TileKey, first_cell, locate};
use super::{Cell, SurfaceKind};

/// Most tiles in the bounding box of a map: 1,638 square metres. Cells beyond are not stored, so that a wrong pose cannot make
/// the dense rasters exceed the memory of a small board.
pub(super) const TILES_MAX: i64 = 640;

/// Tiles are stored up to this far from the origin: one kilometre.
const KEY_MAX: i32 = 625;

/// The state of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKnowledge {
    /// Never observed.
    #[default]
    Unknown,
    /// Free floor.
    Free,
    /// An obstacle.
    Occupied,
    /// The floor ends there.
    Cliff,
    /// Forbidden by a person, or a place where the robot got stuck.
    NoGo,
}

/// Evidence for a cell. All counts saturate. Positive occupancy means obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Evidence {
    /// Log odds of an obstacle from infrared and from the body's own presence, in steps of about 0.05.
    pub(super) occupancy: i8,
    /// For a contact. It also finds what infrared misses: things too low, too dark or transparent.
    pub(super) contact: u8,
    /// For a cliff.
    pub(super) cliff: u8,
    /// Smallest standard deviation of the pose among all observations of the cell, centimetres.
    pub(super) sigma_cm: u8,
    /// [`Flag`]s.
    pub(super) flags: u8,
    /// From the motor currents: positive for carpet, negative for hard floor. It is not part of the knowledge and does not affect
    /// navigation.
    pub(super) carpet: i8,
    /// What earlier runs found there.
    pub(super) past: CellPast,
}

/// A boolean property of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flag {
    /// The body was here.
    Body = 1,
    /// Forbidden by a person.
    NoGo = 2,
    /// Observed, so that `sigma_cm` is valid.
    Seen = 4,
    /// The robot got stuck here; forbidden until the next job.
    Pocket = 8,
    /// The body was here in this run.
    Driven = 16,
}

/// Evidence from which a cell counts as known.
struct EvidenceThresholds {
    /// Least occupancy of an occupied cell.
    occupied_min: i8,
    /// Largest occupancy of a free cell.
    free_max: i8,
    /// Least contact evidence of an occupied cell.
    contact_min: u8,
    /// Least evidence of a cliff.
    cliff_min: u8,
}

const THRESHOLDS: EvidenceThresholds = EvidenceThresholds {
    occupied_min: 12,
    free_max: -4,
    contact_min: 2,
    cliff_min: 2,
};

/// Least evidence of carpet; its negative is that of hard floor. One pass of the outer brush reaches it.
const SURFACE_MIN: i8 = 3;
/// Saturation of that evidence: two passes reverse it when a rug was removed or added.
const SURFACE_MAX: i8 = 20;

impl Evidence {
    /// The floor surface, if known.
    pub(super) fn surface(self) -> Option<SurfaceKind> {
        match self.carpet {
            SURFACE_MIN.. => Some(SurfaceKind::Carpet),
            carpet if carpet <= -SURFACE_MIN => Some(SurfaceKind::Hard),
            _ => None,
        }
    }

    /// Adds weighted evidence of a surface.
    pub(super) fn add_surface(&mut self, kind: SurfaceKind, weight: i8) {
        let step = match kind {
            SurfaceKind::Hard => -weight,
            SurfaceKind::Carpet => weight,
        };
        self.carpet = self.carpet.saturating_add(step).clamp(-SURFACE_MAX, SURFACE_MAX);
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

    /// Forgets that something was touched.
    pub(super) fn expire_touch(&mut self) {
        (self.contact, self.past) = (0, CellPast::default());
    }

    /// The state that the evidence supports.
    pub(super) fn knowledge(self) -> CellKnowledge {
        if self.has(Flag::NoGo) || self.has(Flag::Pocket) {
            CellKnowledge::NoGo
        } else if self.cliff >= THRESHOLDS.cliff_min {
            CellKnowledge::Cliff
        } else if self.occupancy >= THRESHOLDS.occupied_min || self.contact >= THRESHOLDS.contact_min {
            CellKnowledge::Occupied
        } else if self.has(Flag::Body) || self.occupancy <= THRESHOLDS.free_max {
            CellKnowledge::Free
        } else {
            CellKnowledge::Unknown
        }
    }
}

/// Whether infrared has seen an obstacle.
pub(super) fn is_seen_solid(evidence: Evidence) -> bool {
    evidence.occupancy >= THRESHOLDS.occupied_min
}

/// Whether contacts have found an obstacle.
pub(super) fn is_touched(evidence: Evidence) -> bool {
    evidence.contact >= THRESHOLDS.contact_min
}

/// Whether the obstacle is known from contacts alone.
pub(super) fn is_touched_only(evidence: Evidence) -> bool {
    is_touched(evidence) && !is_seen_solid(evidence)
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
struct EvidenceTile {
    /// Shared with copies of the grid until one of them writes, so that a copy is cheap.
    cells: Arc<[Evidence]>,
    dirty: Option<CellBox>,
}

impl Default for EvidenceTile {
    fn default() -> Self {
        let area = (TILE_CELLS * TILE_CELLS) as usize;
        Self {
            cells: Arc::from(vec![Evidence::default(); area]),
            dirty: None,
        }
    }
}

/// Evidence for all cells of a storey.
#[derive(Clone, Debug, Default)]
pub(super) struct OccupancyGrid {
    tiles: TileGrid<EvidenceTile>,
    /// Lowest and highest key.
    keys: Option<(TileKey, TileKey)>,
    /// Indices in `tiles` of the dirty tiles.
    dirty: Vec<usize>,
}

impl OccupancyGrid {
    /// Bounding box of all tiles; `None` without any.
    pub(super) fn bounds(&self) -> Option<CellBox> {
        let (low, high) = self.keys?;
        Some(tile_box(low).joined(tile_box(high)))
    }

    /// Evidence for a cell.
    pub(super) fn at(&self, cell: Cell) -> Evidence {
        let place = locate(cell);
        let tile = self.tiles.get(place.key);
        let evidence = tile.and_then(|tile| tile.cells.get(place.index()));
        evidence.copied().unwrap_or_default()
    }

    /// Smallest pose uncertainty at which a cell was seen, metres; `None` if it never was.
    pub(super) fn sigma_m(&self, cell: Cell) -> Option<f64> {
        let evidence = self.at(cell);
        evidence
            .has(Flag::Seen)
            .then(|| 0.01 * f64::from(evidence.sigma_cm))
    }

    /// Knowledge of a cell as if the flags were clear.
    pub(super) fn knowledge_without(&self, cell: Cell, flags: &[Flag]) -> CellKnowledge {
        let mut evidence = self.at(cell);
        flags.iter().for_each(|flag| evidence.clear(*flag));
        evidence.knowledge()
    }

    /// Changes the evidence for a cell, unless it is too far away to be stored.
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

    /// Whether any knowledge may have changed since [`Self::take_dirty`].
    pub(super) fn is_dirty(&self) -> bool {
        !self.dirty.is_empty()
    }

    /// The boxes in which knowledge may have changed, in the order of the changes.
    pub(super) fn take_dirty(&mut self) -> Vec<CellBox> {
        let places = core::mem::take(&mut self.dirty);
        places
            .into_iter()
            .filter_map(|place| self.tiles.at_mut(place)?.dirty.take())
            .collect()
    }

    /// The oldest of these boxes.
    pub(super) fn take_dirty_tile(&mut self) -> Option<CellBox> {
        if self.dirty.is_empty() {
            return None;
        }
        let place = self.dirty.remove(0);
        self.tiles.at_mut(place)?.dirty.take()
    }

    /// Number of dirty tiles.
    pub(super) fn dirty_tiles(&self) -> usize {
        self.dirty.len()
    }

    /// Marks all tiles dirty, for rasters that are still empty.
    pub(super) fn mark_all_dirty(&mut self) {
        let places: Vec<(TileKey, usize)> = self.tiles.places().collect();
        for (key, place) in &places {
            if let Some(tile) = self.tiles.at_mut(*place) {
                tile.dirty = Some(tile_box(*key));
            }
        }
        self.dirty = places.iter().map(|(_, place)| *place).collect();
    }

    /// All cells with evidence, row after row within tiles, tiles in the order of their keys.
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

    /// Bytes of the tiles, including those shared with a copy.
    pub(super) fn memory_bytes(&self) -> usize {
        self.tiles.len() * (TILE_CELLS * TILE_CELLS) as usize * size_of::<Evidence>()
    }

    fn tile(&mut self, key: TileKey) -> Option<usize> {
        let keys = &mut self.keys;
        self.tiles.place(key, || {
            *keys = Some(grown(*keys, key)?);
            Some(EvidenceTile::default())
        })
    }
}

/// Lowest and highest key with a new tile; `None` when it is too far away.
fn grown(keys: Option<(TileKey, TileKey)>, key: TileKey) -> Option<(TileKey, TileKey)> {
    if key.column.abs() > KEY_MAX || key.row.abs() > KEY_MAX {
        return None;
    }
    let (low, high) = keys.unwrap_or((key, key));
    let low = TileKey {
        column: low.column.min(key.column),
        row: low.row.min(key.row),
    };
    let high = TileKey {
        column: high.column.max(key.column),
        row: high.row.max(key.row),
    };
    let columns = i64::from(high.column) - i64::from(low.column) + 1;
    let rows = i64::from(high.row) - i64::from(low.row) + 1;
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
    use super::{Cell, CellKnowledge, Evidence, Flag, OccupancyGrid};

    #[test]
    fn far_cells_are_not_stored() {
        let mut grid = OccupancyGrid::default();
        grid.change(Cell { x: 0, y: 0 }, |evidence| evidence.occupancy = 100);
        for far in [(i32::MAX, 0), (0, i32::MIN), (i32::MIN, i32::MAX), (64 * 640, 0)] {
            let cell = Cell { x: far.0, y: far.1 };
            grid.change(cell, |evidence| evidence.occupancy = 100);
            assert_eq!(grid.at(cell), Evidence::default());
        }
        assert_eq!(grid.at(Cell { x: 0, y: 0 }).occupancy, 100);
        assert_eq!(grid.gathered().count(), 1);
    }

    #[test]
    fn only_a_change_of_knowledge_is_dirty() {
        let mut grid = OccupancyGrid::default();
        let cell = Cell { x: -1, y: 70 };
        grid.change(cell, |evidence| evidence.occupancy = 3);
        assert!(!grid.is_dirty());
        grid.change(cell, |evidence| evidence.occupancy = 50);
        assert_eq!(grid.take_dirty(), [super::CellBox::of(cell)]);
        assert!(!grid.is_dirty() && grid.take_dirty().is_empty());
    }

    #[test]
    fn forbidden_wins_over_allowed() {
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
