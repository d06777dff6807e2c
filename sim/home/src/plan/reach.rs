//! The floor that the robot can reach, and the floor that it can sweep from there.

use super::distance::{DistanceField, squared_distances};
use super::grid::{Cell, Grid};

/// Cells whose centre the middle of the body can take, by region.
pub(crate) struct Regions {
    /// Region of each cell, 0 = the body does not fit.
    labels: Vec<u32>,
    /// Cells of region 1, 2, ...
    sizes: Vec<u32>,
}

impl Regions {
    /// Flood-fills the places where `radius_m` around the centre is floor: neither solid nor a drop.
    pub(crate) fn new(grid: &Grid, blocked: &DistanceField, radius_m: f64) -> Self {
        let mut regions = Self {
            labels: vec![0; grid.cells.len()],
            sizes: Vec::new(),
        };
        let fits = |index: usize| grid.cells[index].is_floor() && f64::from(blocked.cell(index)) >= radius_m;
        for seed in 0..grid.cells.len() {
            if regions.labels[seed] == 0 && fits(seed) {
                regions.fill(seed, grid.width, &fits);
            }
        }
        regions
    }

    fn fill(&mut self, seed: usize, width: usize, fits: &impl Fn(usize) -> bool) {
        let label = self.sizes.len() as u32 + 1;
        let mut size = 0;
        self.labels[seed] = label;
        let mut stack = vec![seed];
        while let Some(index) = stack.pop() {
            size += 1;
            // The grid has a solid margin, so left and right neighbours of a cell that fits lie in the same row.
            for neighbour in [
                index.wrapping_sub(1),
                index + 1,
                index.wrapping_sub(width),
                index + width,
            ] {
                if self.labels.get(neighbour) == Some(&0) && fits(neighbour) {
                    self.labels[neighbour] = label;
                    stack.push(neighbour);
                }
            }
        }
        self.sizes.push(size);
    }

    /// The region with most cells, the first of equals; `None` when the body fits nowhere.
    pub(crate) fn biggest(&self) -> Option<u32> {
        let most = self.sizes.iter().max()?;
        let position = self.sizes.iter().position(|size| size == most)?;
        Some(position as u32 + 1)
    }

    /// Share of all places where the body fits that belong to this region.
    pub(crate) fn share(&self, region: u32) -> f64 {
        let all: u32 = self.sizes.iter().sum();
        let index = (region as usize).checked_sub(1);
        let own = index
            .and_then(|index| self.sizes.get(index))
            .copied()
            .unwrap_or(0);
        f64::from(own) / f64::from(all.max(1))
    }

    /// Region of a cell, 0 = the body does not fit there.
    pub(crate) fn label(&self, index: usize) -> u32 {
        self.labels.get(index).copied().unwrap_or(0)
    }

    /// Indices of a region's cells, rising.
    pub(crate) fn cells(&self, region: u32) -> impl Iterator<Item = usize> + '_ {
        self.labels
            .iter()
            .enumerate()
            .filter(move |(_, label)| **label == region)
            .map(|(index, _)| index)
    }

    /// Floor cells that a disc of `swath_m` sweeps when its centre visits every cell of the region.
    pub(crate) fn swept_from(&self, region: u32, grid: &Grid, swath_m: f64) -> Vec<bool> {
        let limit = (0.5 * swath_m / grid.cell_m) * (0.5 * swath_m / grid.cell_m);
        squared_distances(grid.width, grid.height, |index| self.labels[index] == region)
            .iter()
            .zip(&grid.cells)
            .map(|(squared, cell)| cell.is_floor() && f64::from(*squared) <= limit)
            .collect()
    }
}

/// Distance to the nearest cell that the body must not overlap: solid or a drop.
pub(crate) fn blocked_field(grid: &Grid) -> DistanceField {
    DistanceField::new(grid.cell_m, grid.width, grid.height, |index| {
        !grid.cells[index].is_floor()
    })
}

/// Distance to the nearest solid cell, which stops bumpers and beams.
pub(crate) fn solid_field(grid: &Grid) -> DistanceField {
    DistanceField::new(grid.cell_m, grid.width, grid.height, |index| {
        grid.cells[index].is_solid()
    })
}

/// Distance to the nearest drop, if the home has any.
pub(crate) fn cliff_field(grid: &Grid) -> Option<DistanceField> {
    grid.cells.contains(&Cell::Cliff).then(|| {
        DistanceField::new(grid.cell_m, grid.width, grid.height, |index| {
            grid.cells[index] == Cell::Cliff
        })
    })
}
