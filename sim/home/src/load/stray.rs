//! Crumbs of floor far away from a map: one stray pixel would stretch the plan to its limits.

use std::path::Path;

use super::HomeNotice;
use crate::plan::{Cell, Grid};

/// Floor below this is a crumb, square metres: a disc of 0.1 m radius, in which no robot fits.
const CRUMB_M2: f64 = 0.03;
/// A crumb nearer to the rest than this harms nobody, metres.
const NEAR_M: f64 = 5.0;

/// Cells of one piece of floor, and the rectangle around them.
struct FloorPiece {
    cells: Vec<u32>,
    columns: (usize, usize),
    rows: (usize, usize),
}

/// Takes crumbs of floor that lie far from the largest piece out of the map, and says so.
pub(super) fn leave_out(path: &Path, grid: &mut Grid) -> Option<HomeNotice> {
    let crumb_cells = (CRUMB_M2 / grid.cell_area_m2()) as usize;
    let (largest, crumbs) = pieces(grid, crumb_cells);
    let largest = largest?;
    let (mut count, mut farthest_m) = (0, 0.0);
    for crumb in crumbs {
        let across = gap(crumb.columns, largest.columns);
        let up = gap(crumb.rows, largest.rows);
        let distance_m = libm::hypot(across as f64, up as f64) * grid.cell_m;
        if distance_m <= NEAR_M {
            continue;
        }
        count += 1;
        farthest_m = f64::max(farthest_m, distance_m);
        for index in crumb.cells {
            if let Some(cell) = grid.cells.get_mut(index as usize) {
                *cell = Cell::Outside;
            }
        }
    }
    (count > 0).then(|| HomeNotice::Strays {
        path: path.to_owned(),
        count,
        farthest_m,
    })
}

/// Cells between two ranges; 0 where they overlap.
fn gap(one: (usize, usize), other: (usize, usize)) -> usize {
    one.0.saturating_sub(other.1).max(other.0.saturating_sub(one.1))
}

/// The largest piece of floor (without its cells unless it is a crumb itself), and all crumbs but it.
fn pieces(grid: &Grid, crumb_cells: usize) -> (Option<FloorPiece>, Vec<FloorPiece>) {
    let mut seen = vec![false; grid.cells.len()];
    let mut crumbs = Vec::new();
    let (mut largest, mut largest_cells) = (None, 0);
    for index in 0..grid.cells.len() {
        if seen.get(index) == Some(&false) && is_floor(grid, index) {
            let (piece, size) = flood(grid, &mut seen, index, crumb_cells);
            if size > largest_cells {
                if largest_cells <= crumb_cells {
                    crumbs.extend(largest.replace(piece));
                } else {
                    largest = Some(piece);
                }
                largest_cells = size;
            } else if size <= crumb_cells {
                crumbs.push(piece);
            }
        }
    }
    (largest, crumbs)
}

fn is_floor(grid: &Grid, index: usize) -> bool {
    grid.cells.get(index).is_some_and(|cell| !cell.is_solid())
}

/// The piece around a cell and its size; it keeps no more cells than a crumb has.
fn flood(grid: &Grid, seen: &mut [bool], start: usize, crumb_cells: usize) -> (FloorPiece, usize) {
    let (column, row) = (start % grid.width, start / grid.width);
    let mut piece = FloorPiece {
        cells: Vec::new(),
        columns: (column, column),
        rows: (row, row),
    };
    let mut size = 0;
    let mut waiting = vec![start as u32];
    if let Some(mark) = seen.get_mut(start) {
        *mark = true;
    }
    while let Some(index) = waiting.pop() {
        let (column, row) = (index as usize % grid.width, index as usize / grid.width);
        size += 1;
        if size <= crumb_cells {
            piece.cells.push(index);
        }
        piece.columns = (piece.columns.0.min(column), piece.columns.1.max(column));
        piece.rows = (piece.rows.0.min(row), piece.rows.1.max(row));
        for up in [-1, 0, 1] {
            for right in [-1, 0, 1] {
                let next = column
                    .checked_add_signed(right)
                    .zip(row.checked_add_signed(up))
                    .filter(|(column, row)| *column < grid.width && *row < grid.height)
                    .map(|(column, row)| row * grid.width + column);
                if let Some(next) = next
                    && is_floor(grid, next)
                    && let Some(mark) = seen.get_mut(next)
                    && !*mark
                {
                    *mark = true;
                    waiting.push(next as u32);
                }
            }
        }
    }
    (piece, size)
}
