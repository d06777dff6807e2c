//! Straight walls: lines that many surface cells agree on.
//!
//! *Surface*: occupied cells beside free ones. Each votes for the lines through it that run across the direction in which
//! the distance to obstacles grows there; the line with most votes becomes walls, its cells are taken away, and so on.

use std::collections::BTreeMap;

use super::cell::neighbours;
use super::{CELL_M, Cell, CellKnowledge, DistanceField, Raster};
use crate::model::geometry::Point2;

/// A straight piece of wall, or of furniture that stands like one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallSegment {
    /// One end.
    pub from: Point2,
    /// The other end.
    pub to: Point2,
    /// Standard deviation of its place across, in metres: scatter of its cells and uncertainty of the poses.
    pub sigma_m: f64,
}

/// Directions of lines that are told apart: 3 degrees.
const DIRECTIONS: i32 = 60;
/// Lines side by side, metres.
const LINE_STEP_M: f64 = 2.0 * CELL_M;
/// Cells this far from a line belong to it, metres.
const NEAR_M: f64 = 1.6 * CELL_M;
/// A longer gap ends a wall, metres: where another wall meets it, cells see neither side clearly, and doors are wider.
const GAP_M: f64 = 0.45;
/// Shorter pieces are not walls, metres.
const LENGTH_MIN_M: f64 = 0.5;
/// Lines that are looked at, at most.
const LINES_MAX: usize = 400;

#[derive(Clone, Copy)]
struct Surface {
    at: Point2,
    /// Direction in which the free space lies, as a number of half of the [`DIRECTIONS`] of a full turn.
    direction: i32,
    sigma_m: f64,
}

/// A line: points whose way along the direction is the number of steps.
type Line = (i32, i32);

/// The walls of what is known. `sigma_m` tells how sure the pose was when a cell was seen.
pub(super) fn walls(
    knowledge: &Raster<CellKnowledge>,
    distance: &DistanceField,
    sigma_m: impl Fn(Cell) -> f64,
) -> Vec<WallSegment> {
    let mut surface = surface(knowledge, distance, sigma_m);
    let mut votes: BTreeMap<Line, u32> = BTreeMap::new();
    for line in surface.iter().flat_map(lines_of) {
        *votes.entry(line).or_default() += 1;
    }
    let mut walls = Vec::new();
    let votes_min = (LENGTH_MIN_M / CELL_M) as u32;
    for _ in 0..LINES_MAX {
        let strongest = votes
            .iter()
            .max_by_key(|(line, count)| (**count, core::cmp::Reverse(**line)));
        let Some((&line, _)) = strongest.filter(|(_, count)| **count >= votes_min) else {
            break;
        };
        let (mut on_it, others): (Vec<Surface>, Vec<Surface>) =
            surface.iter().partition(|cell| lies_on(cell, line));
        surface = others;
        for spent in on_it.iter().flat_map(lines_of) {
            if let Some(count) = votes.get_mut(&spent) {
                *count = count.saturating_sub(1);
            }
        }
        walls.extend(pieces(&mut on_it, line));
    }
    walls
}

fn surface(
    knowledge: &Raster<CellKnowledge>,
    distance: &DistanceField,
    sigma_m: impl Fn(Cell) -> f64,
) -> Vec<Surface> {
    let mut surface = Vec::new();
    for (index, kind) in knowledge.values().iter().enumerate() {
        if *kind != CellKnowledge::Occupied {
            continue;
        }
        let cell = knowledge.cell(index);
        let free = neighbours(cell).map(|next| knowledge.get(next) == Some(&CellKnowledge::Free));
        if !free.contains(&true) {
            continue;
        }
        let at = cell.middle();
        if let Some(direction) = outward(distance, at) {
            surface.push(Surface {
                at,
                direction,
                sigma_m: sigma_m(cell),
            });
        }
    }
    surface
}

/// Direction in which the distance grows around a place, from some cells around so that single cells do not matter.
fn outward(distance: &DistanceField, at: Point2) -> Option<i32> {
    const AROUND: i32 = 3;
    let (mut x, mut y) = (0.0, 0.0);
    for row in -AROUND..=AROUND {
        for column in -AROUND..=AROUND {
            let there = Point2 {
                x_m: at.x_m + f64::from(column) * CELL_M,
                y_m: at.y_m + f64::from(row) * CELL_M,
            };
            let value = distance.cell_m(Cell::under(there));
            x += value * f64::from(column);
            y += value * f64::from(row);
        }
    }
    if x == 0.0 && y == 0.0 {
        return None;
    }
    let turns = libm::atan2(y, x) / core::f64::consts::TAU;
    Some(libm::round(turns * f64::from(2 * DIRECTIONS)) as i32)
}

/// Unit vector across a line.
fn normal(direction: i32) -> (f64, f64) {
    let (sin, cos) = libm::sincos(f64::from(direction) * core::f64::consts::PI / f64::from(DIRECTIONS));
    (cos, sin)
}

fn across_m(at: Point2, direction: i32) -> f64 {
    let (x, y) = normal(direction);
    at.x_m * x + at.y_m * y
}

/// The lines for which a cell votes.
fn lines_of(cell: &Surface) -> [Line; 3] {
    [-1, 0, 1].map(|turned| {
        let direction = (cell.direction + turned).rem_euclid(2 * DIRECTIONS);
        let step = libm::round(across_m(cell.at, direction) / LINE_STEP_M) as i32;
        (direction, step)
    })
}

fn lies_on(cell: &Surface, (direction, step): Line) -> bool {
    let off_m = across_m(cell.at, direction) - f64::from(step) * LINE_STEP_M;
    let turned = (cell.direction - direction).rem_euclid(2 * DIRECTIONS);
    off_m.abs() <= NEAR_M && (turned <= 4 || turned >= 2 * DIRECTIONS - 4)
}

/// The cells of one line in pieces without gaps, each as a fitted segment.
fn pieces(cells: &mut [Surface], (direction, _): Line) -> Vec<WallSegment> {
    let (x, y) = normal(direction);
    let along_m = |cell: &Surface| cell.at.y_m * x - cell.at.x_m * y;
    cells.sort_by(|one, other| along_m(one).total_cmp(&along_m(other)));
    cells
        .chunk_by(|one, next| along_m(next) - along_m(one) <= GAP_M)
        .filter_map(fitted)
        .filter(|wall| wall.from.distance_m(wall.to) >= LENGTH_MIN_M)
        .collect()
}

/// The straight line through cells with the least squares across it.
fn fitted(cells: &[Surface]) -> Option<WallSegment> {
    let count = cells.len() as f64;
    if count < 2.0 {
        return None;
    }
    let mean = |value: &dyn Fn(&Surface) -> f64| cells.iter().map(value).sum::<f64>() / count;
    let (x_m, y_m) = (mean(&|cell| cell.at.x_m), mean(&|cell| cell.at.y_m));
    let xx = mean(&|cell| (cell.at.x_m - x_m) * (cell.at.x_m - x_m));
    let yy = mean(&|cell| (cell.at.y_m - y_m) * (cell.at.y_m - y_m));
    let xy = mean(&|cell| (cell.at.x_m - x_m) * (cell.at.y_m - y_m));
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
    let along = |cell: &Surface| (cell.at.x_m - x_m) * cos + (cell.at.y_m - y_m) * sin;
    let first = cells.iter().map(along).fold(f64::INFINITY, f64::min);
    let last = cells.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
    let scatter_m2 = (xx * sin * sin + yy * cos * cos - 2.0 * xy * sin * cos).max(0.0);
    let pose_m = mean(&|cell| cell.sigma_m);
    let end = |way_m: f64| Point2 {
        x_m: x_m + way_m * cos,
        y_m: y_m + way_m * sin,
    };
    Some(WallSegment {
        from: end(first - 0.5 * CELL_M),
        to: end(last + 0.5 * CELL_M),
        sigma_m: libm::sqrt(scatter_m2 + pose_m * pose_m),
    })
}
