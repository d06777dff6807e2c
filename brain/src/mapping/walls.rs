//! Straight walls, by a Hough transform.
//!
//! *Boundary cell*: an occupied cell next to a free one. Each votes for the lines through it that are perpendicular to the
//! gradient of the distance field there. The line with most votes becomes wall segments, its cells are removed, and the search
//! repeats.

use std::collections::BTreeMap;

use super::cell::neighbours;
use super::{CELL_M, Cell, CellKnowledge, DistanceField, Raster};
use crate::model::geometry::Point2;

/// A straight piece of wall, or of furniture that looks like one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallSegment {
    /// One end.
    pub from: Point2,
    /// The other end.
    pub to: Point2,
    /// Standard deviation across the segment, in metres: scatter of its cells and uncertainty of the poses.
    pub sigma_m: f64,
}

/// How straight walls are found in the occupied cells, by a Hough transform.
struct WallParameters {
    /// Number of line directions in a half turn: 3 degrees each.
    directions: i32,
    /// Distance between parallel lines, metres.
    line_step_m: f64,
    /// Largest distance of a cell from its line, metres.
    near_m: f64,
    /// A longer gap ends a wall, metres. Where another wall meets it, cells are not clearly seen from either side; doors are
    /// wider.
    gap_max_m: f64,
    /// Shorter pieces are not walls, metres.
    length_min_m: f64,
    /// Most lines in one search.
    lines_max: usize,
}

const PARAMETERS: WallParameters = WallParameters {
    directions: 60,
    line_step_m: 2.0 * CELL_M,
    near_m: 1.6 * CELL_M,
    gap_max_m: 0.45,
    length_min_m: 0.5,
    lines_max: 400,
};

#[derive(Clone, Copy)]
struct BoundaryCell {
    at: Point2,
    /// Direction of the free side, in steps of half a turn over `PARAMETERS.directions`.
    direction: i32,
    sigma_m: f64,
}

/// A line of the Hough transform.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HoughLine {
    /// Direction of its normal, in steps of half a turn over `PARAMETERS.directions`.
    direction: i32,
    /// Distance from the origin along the normal, in steps of `PARAMETERS.line_step_m`.
    step: i32,
}

/// The walls in a map. `sigma_m` is the uncertainty of the pose when a cell was observed.
pub(super) fn walls(
    knowledge: &Raster<CellKnowledge>,
    distance: &DistanceField,
    sigma_m: impl Fn(Cell) -> f64,
) -> Vec<WallSegment> {
    let mut boundary = boundary(knowledge, distance, sigma_m);
    let mut votes: BTreeMap<HoughLine, u32> = BTreeMap::new();
    for line in boundary.iter().flat_map(lines_of) {
        *votes.entry(line).or_default() += 1;
    }
    let mut walls = Vec::new();
    let votes_min = (PARAMETERS.length_min_m / CELL_M) as u32;
    for _ in 0..PARAMETERS.lines_max {
        let strongest = votes
            .iter()
            .max_by_key(|(line, count)| (**count, core::cmp::Reverse(**line)));
        let Some((&line, _)) = strongest.filter(|(_, count)| **count >= votes_min) else {
            break;
        };
        let (mut on_it, others): (Vec<BoundaryCell>, Vec<BoundaryCell>) =
            boundary.iter().partition(|cell| lies_on(cell, line));
        boundary = others;
        for spent in on_it.iter().flat_map(lines_of) {
            if let Some(count) = votes.get_mut(&spent) {
                *count = count.saturating_sub(1);
            }
        }
        walls.extend(pieces(&mut on_it, line));
    }
    walls
}

fn boundary(
    knowledge: &Raster<CellKnowledge>,
    distance: &DistanceField,
    sigma_m: impl Fn(Cell) -> f64,
) -> Vec<BoundaryCell> {
    let mut boundary = Vec::new();
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
            boundary.push(BoundaryCell {
                at,
                direction,
                sigma_m: sigma_m(cell),
            });
        }
    }
    boundary
}

/// Direction of the gradient of the distance field, averaged over neighbouring cells against noise.
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
    Some(libm::round(turns * f64::from(2 * PARAMETERS.directions)) as i32)
}

/// Unit normal of a line.
fn normal(direction: i32) -> (f64, f64) {
    let (sin, cos) =
        libm::sincos(f64::from(direction) * core::f64::consts::PI / f64::from(PARAMETERS.directions));
    (cos, sin)
}

fn across_m(at: Point2, direction: i32) -> f64 {
    let (x, y) = normal(direction);
    at.x_m * x + at.y_m * y
}

/// The lines for which a cell votes.
fn lines_of(cell: &BoundaryCell) -> [HoughLine; 3] {
    [-1, 0, 1].map(|turned| {
        let direction = (cell.direction + turned).rem_euclid(2 * PARAMETERS.directions);
        let step = libm::round(across_m(cell.at, direction) / PARAMETERS.line_step_m) as i32;
        HoughLine { direction, step }
    })
}

fn lies_on(cell: &BoundaryCell, line: HoughLine) -> bool {
    let off_m = across_m(cell.at, line.direction) - f64::from(line.step) * PARAMETERS.line_step_m;
    let turned = (cell.direction - line.direction).rem_euclid(2 * PARAMETERS.directions);
    off_m.abs() <= PARAMETERS.near_m && (turned <= 4 || turned >= 2 * PARAMETERS.directions - 4)
}

/// Splits the cells of one line at gaps and fits a segment to each piece.
fn pieces(cells: &mut [BoundaryCell], line: HoughLine) -> Vec<WallSegment> {
    let (x, y) = normal(line.direction);
    let along_m = |cell: &BoundaryCell| cell.at.y_m * x - cell.at.x_m * y;
    cells.sort_by(|one, other| along_m(one).total_cmp(&along_m(other)));
    cells
        .chunk_by(|one, next| along_m(next) - along_m(one) <= PARAMETERS.gap_max_m)
        .filter_map(fitted)
        .filter(|wall| wall.from.distance_m(wall.to) >= PARAMETERS.length_min_m)
        .collect()
}

/// Fits a line by least squares of the perpendicular distances.
fn fitted(cells: &[BoundaryCell]) -> Option<WallSegment> {
    let count = cells.len() as f64;
    if count < 2.0 {
        return None;
    }
    let mean = |value: &dyn Fn(&BoundaryCell) -> f64| cells.iter().map(value).sum::<f64>() / count;
    let (x_m, y_m) = (mean(&|cell| cell.at.x_m), mean(&|cell| cell.at.y_m));
    let xx = mean(&|cell| (cell.at.x_m - x_m) * (cell.at.x_m - x_m));
    let yy = mean(&|cell| (cell.at.y_m - y_m) * (cell.at.y_m - y_m));
    let xy = mean(&|cell| (cell.at.x_m - x_m) * (cell.at.y_m - y_m));
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
    let along = |cell: &BoundaryCell| (cell.at.x_m - x_m) * cos + (cell.at.y_m - y_m) * sin;
    let first = cells.iter().map(along).fold(f64::INFINITY, f64::min);
    let last = cells.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
    let scatter_m2 = (xx * sin * sin + yy * cos * cos - 2.0 * xy * sin * cos).max(0.0);
    let pose_m = mean(&|cell| cell.sigma_m);
    let end = |along_m: f64| Point2 {
        x_m: x_m + along_m * cos,
        y_m: y_m + along_m * sin,
    };
    Some(WallSegment {
        from: end(first - 0.5 * CELL_M),
        to: end(last + 0.5 * CELL_M),
        sigma_m: libm::sqrt(scatter_m2 + pose_m * pose_m),
    })
}
