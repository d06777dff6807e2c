//! Swept floor, and dirt taken up.

use crate::home::Home;
use crate::{Pcg, Pose};

/// Share of a cell's dirt that one pass of the disc over one centimetre takes up, of 256.
const TAKE_256: u16 = 28;
/// Side of the patches that share an amount of dirt, cells.
const PATCH_CELLS: usize = 16;
/// A cell over which the disc comes after so long is swept once more, milliseconds: longer than a turn on the spot takes.
const AGAIN_MS: u64 = 10_000;

/// The floor for a cleaner.
#[derive(Clone, Debug)]
pub(crate) struct Dirt {
    radius_m: f64,
    step_m: f64,
    last: Option<(f64, f64)>,
    /// Cells of the reachable floor that the disc has passed.
    pub(crate) swept: Vec<bool>,
    pub(crate) swept_cells: u32,
    /// When the disc was over a cell last, milliseconds.
    passed_ms: Vec<u32>,
    /// Cells that the disc has passed again after [`AGAIN_MS`].
    twice: Vec<bool>,
    pub(crate) twice_cells: u32,
    /// Part of the job in which a cell was cleaned last, 0 = in none; empty while it is not counted.
    stretches: Vec<u8>,
    stretch: u8,
    again_cells: u32,
    dirt: Vec<u8>,
    total: u64,
    taken: u64,
}

impl Dirt {
    pub(crate) fn new(home: &Home, swath_m: f64, random: &mut Pcg) -> Self {
        let grid = home.grid();
        let across = grid.width / PATCH_CELLS + 1;
        let patches: Vec<u8> = (0..across * (grid.height / PATCH_CELLS + 1))
            .map(|_| (random.below(200) + 20) as u8)
            .collect();
        let dirt: Vec<u8> = home
            .reachable()
            .iter()
            .enumerate()
            .map(|(index, reachable)| {
                let (column, row) = (index % grid.width, index / grid.width);
                let patch = row / PATCH_CELLS * across + column / PATCH_CELLS;
                if *reachable {
                    patches.get(patch).copied().unwrap_or(0)
                } else {
                    0
                }
            })
            .collect();
        Self {
            radius_m: 0.5 * swath_m,
            step_m: (0.5 * grid.cell_m).min(0.01),
            last: None,
            swept: vec![false; grid.cells.len()],
            swept_cells: 0,
            passed_ms: vec![0; grid.cells.len()],
            twice: vec![false; grid.cells.len()],
            twice_cells: 0,
            stretches: Vec::new(),
            stretch: 0,
            again_cells: 0,
            total: dirt.iter().map(|amount| u64::from(*amount)).sum(),
            dirt,
            taken: 0,
        }
    }

    /// Begins a part of a job. From the first part on it counts the cells that are cleaned again in a later one.
    pub(crate) fn begin_stretch(&mut self) {
        self.stretches.resize(self.swept.len(), 0);
        self.stretch = self.stretch.saturating_add(1);
    }

    /// Cells of the reachable floor that were cleaned again in a later part.
    pub(crate) fn again_cells(&self) -> u32 {
        self.again_cells
    }

    fn count_again(&mut self, home: &Home, cells: core::ops::Range<usize>) {
        let (Some(stretches), Some(reachable)) =
            (self.stretches.get_mut(cells.clone()), home.reachable().get(cells))
        else {
            return;
        };
        for (stretch, _) in stretches
            .iter_mut()
            .zip(reachable)
            .filter(|(_, reachable)| **reachable)
        {
            self.again_cells += u32::from(*stretch != 0 && *stretch != self.stretch);
            *stretch = self.stretch;
        }
    }

    /// Sweeps at the present place if the robot has moved far enough since the last time; dirt is taken up only when
    /// `cleaning`.
    pub(crate) fn pass(&mut self, home: &Home, pose: Pose, (now_ms, cleaning): (u64, bool)) {
        let (x_m, y_m) = (pose.x_m, pose.y_m);
        if let Some((last_x, last_y)) = self.last {
            let (dx, dy) = (x_m - last_x, y_m - last_y);
            if dx * dx + dy * dy < self.step_m * self.step_m {
                return;
            }
        }
        self.last = Some((x_m, y_m));
        let grid = home.grid();
        let per_m = 1.0 / grid.cell_m;
        let first = ((y_m - self.radius_m) * per_m + 0.5).max(0.0) as usize;
        let end = (((y_m + self.radius_m) * per_m + 0.5).max(0.0) as usize).min(grid.height);
        for row in first..end {
            let dy = (row as f64 + 0.5) * grid.cell_m - y_m;
            let half = libm::sqrt((self.radius_m * self.radius_m - dy * dy).max(0.0));
            let left = ((x_m - half) * per_m + 0.5).max(0.0) as usize;
            let right = (((x_m + half) * per_m + 0.5).max(0.0) as usize).min(grid.width);
            if left < right {
                let cells = row * grid.width + left..row * grid.width + right;
                self.count_twice(home, cells.clone(), now_ms);
                self.sweep_row(home, cells, cleaning);
            }
        }
    }

    /// Must come before the cells are swept.
    fn count_twice(&mut self, home: &Home, cells: core::ops::Range<usize>, now_ms: u64) {
        for index in cells {
            let (Some(passed_ms), Some(twice)) = (self.passed_ms.get_mut(index), self.twice.get_mut(index))
            else {
                continue;
            };
            let before_ms = core::mem::replace(passed_ms, now_ms as u32);
            if !*twice && self.swept[index] && now_ms.saturating_sub(u64::from(before_ms)) > AGAIN_MS {
                *twice = true;
                self.twice_cells += u32::from(home.reachable().get(index) == Some(&true));
            }
        }
    }

    fn sweep_row(&mut self, home: &Home, cells: core::ops::Range<usize>, cleaning: bool) {
        let (Some(swept), Some(reachable)) = (
            self.swept.get_mut(cells.clone()),
            home.reachable().get(cells.clone()),
        ) else {
            return;
        };
        for (swept, reachable) in swept.iter_mut().zip(reachable) {
            if *reachable && !*swept {
                *swept = true;
                self.swept_cells += 1;
            }
        }
        if cleaning && !self.stretches.is_empty() {
            self.count_again(home, cells.clone());
        }
        if cleaning && let Some(dirt) = self.dirt.get_mut(cells) {
            for amount in dirt.iter_mut().filter(|amount| **amount > 0) {
                let take = ((u16::from(*amount) * TAKE_256) / 256).max(1) as u8;
                *amount -= take;
                self.taken += u64::from(take);
            }
        }
    }

    /// Share of all dirt that was taken up.
    pub(crate) fn share(&self) -> f64 {
        if self.total == 0 {
            0.0
        } else {
            self.taken as f64 / self.total as f64
        }
    }
}
