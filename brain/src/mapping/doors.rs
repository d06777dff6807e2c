//! Doors: where the cells of two rooms lie beside each other.

use std::collections::BTreeMap;

use super::cell::neighbours;
use super::raster::CELLS;
use super::{CELL_M, Cell, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Cells of one door lie within this many cells of each other.
const DOOR_GAP_CELLS: i32 = 8;
/// Work of looking at a cell.
const DOOR_WORK: usize = 10;

/// A passage between two rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Door {
    /// Identities of the rooms, the lower one first.
    pub rooms: [u16; 2],
    /// Its middle.
    pub at: Point2,
    /// Its width in metres.
    pub width_m: f64,
}

/// Where cells of two rooms lie beside each other.
pub(super) async fn doors(labels: &Raster<u16>, squared: &[f32], budget: &mut StepBudget) -> Vec<Door> {
    let mut borders: BTreeMap<[u16; 2], Vec<(Cell, f32)>> = BTreeMap::new();
    for (index, label) in labels.values().iter().enumerate() {
        if index % CELLS == 0 {
            budget.spend(DOOR_WORK * CELLS).await;
        }
        if *label == 0 {
            continue;
        }
        let cell = labels.cell(index);
        for neighbour in neighbours(cell).iter().take(2) {
            let other = labels.get(*neighbour).copied().unwrap_or(0);
            if other > 0 && other != *label {
                let pair = [other.min(*label), other.max(*label)];
                let depth = squared.get(index).copied().unwrap_or(0.0);
                borders.entry(pair).or_default().push((cell, depth));
            }
        }
    }
    borders
        .into_iter()
        .flat_map(|(rooms, cells)| {
            clusters(cells).into_iter().map(move |cluster| Door {
                rooms,
                ..door(&cluster)
            })
        })
        .collect()
}

/// Cells joined to groups that lie together.
fn clusters(cells: Vec<(Cell, f32)>) -> Vec<Vec<(Cell, f32)>> {
    let mut groups: Vec<Vec<(Cell, f32)>> = Vec::new();
    for member in cells {
        let is_near = |other: &(Cell, f32)| {
            other.0.x.abs_diff(member.0.x) <= DOOR_GAP_CELLS as u32
                && other.0.y.abs_diff(member.0.y) <= DOOR_GAP_CELLS as u32
        };
        let (near, far): (Vec<_>, Vec<_>) = groups.into_iter().partition(|group| group.iter().any(is_near));
        let mut joined: Vec<(Cell, f32)> = near.into_iter().flatten().collect();
        joined.push(member);
        groups = far;
        groups.push(joined);
    }
    groups
}

fn door(cells: &[(Cell, f32)]) -> Door {
    let count = cells.len().max(1) as f64;
    let sum = cells.iter().fold((0.0, 0.0), |sum, (cell, _)| {
        let at = cell.middle();
        (sum.0 + at.x_m, sum.1 + at.y_m)
    });
    let widest = cells.iter().map(|(_, depth)| *depth).fold(0.0, f32::max);
    Door {
        rooms: [0, 0],
        at: Point2 {
            x_m: sum.0 / count,
            y_m: sum.1 / count,
        },
        // From centre to border is half a cell less than from centre to centre, on both sides.
        width_m: (2.0 * f64::from(widest).sqrt() - 1.0).max(0.0) * CELL_M,
    }
}
