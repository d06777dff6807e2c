//! A sparse grid of square tiles.

use std::collections::BTreeMap;

use super::Cell;

/// Cells along the edge of a tile.
pub(super) const TILE_CELLS: i32 = 64;

/// Column and row of a tile. Keys are ordered column by column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TileKey {
    pub(super) column: i32,
    pub(super) row: i32,
}

/// The allocated tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct TileGrid<T> {
    tiles: Vec<T>,
    place_at: BTreeMap<TileKey, usize>,
    /// The tile used last: nearly every access hits it.
    recent: Option<(TileKey, usize)>,
}

impl<T> TileGrid<T> {
    /// Number of tiles.
    pub(super) fn len(&self) -> usize {
        self.tiles.len()
    }

    pub(super) fn get(&self, key: TileKey) -> Option<&T> {
        self.tiles.get(*self.place_at.get(&key)?)
    }

    /// Tiles in the order of their keys: column by column.
    pub(super) fn iter(&self) -> impl Iterator<Item = (TileKey, &T)> {
        let places = self.place_at.iter();
        places.filter_map(|(key, place)| Some((*key, self.tiles.get(*place)?)))
    }

    /// Keys and indices of the tiles, in the order of their keys.
    pub(super) fn places(&self) -> impl Iterator<Item = (TileKey, usize)> {
        self.place_at.iter().map(|(key, place)| (*key, *place))
    }

    /// The tile at an index.
    pub(super) fn at_mut(&mut self, place: usize) -> Option<&mut T> {
        self.tiles.get_mut(place)
    }

    /// The index of a tile, which is allocated if missing; `None` if `make` refuses.
    pub(super) fn place(&mut self, key: TileKey, make: impl FnOnce() -> Option<T>) -> Option<usize> {
        if let Some((recent, place)) = self.recent
            && recent == key
        {
            return Some(place);
        }
        let place = match self.place_at.get(&key) {
            Some(place) => *place,
            None => {
                self.tiles.push(make()?);
                self.place_at.insert(key, self.tiles.len() - 1);
                self.tiles.len() - 1
            }
        };
        self.recent = Some((key, place));
        Some(place)
    }
}

/// The lowest cell of a tile.
pub(super) const fn first_cell(key: TileKey) -> Cell {
    Cell {
        x: key.column * TILE_CELLS,
        y: key.row * TILE_CELLS,
    }
}

/// The position of a cell in the tiles.
pub(super) struct Located {
    /// Its tile.
    pub(super) key: TileKey,
    /// Row and column in the tile.
    pub(super) row: usize,
    pub(super) column: usize,
}

impl Located {
    pub(super) fn index(&self) -> usize {
        self.row * TILE_CELLS as usize + self.column
    }
}

pub(super) fn locate(cell: Cell) -> Located {
    Located {
        key: TileKey {
            column: cell.x.div_euclid(TILE_CELLS),
            row: cell.y.div_euclid(TILE_CELLS),
        },
        row: cell.y.rem_euclid(TILE_CELLS) as usize,
        column: cell.x.rem_euclid(TILE_CELLS) as usize,
    }
}
