//! Walls and furniture of a plan as blocks that can be raised.
//!
//! Each tile of the plan has blocks of its own, and only those of a tile that changed are made again.

use rvac_api::{Pose, SimulatedPlan};

use crate::plan::kinds;

/// Kind of cells that rise from the floor.
const OBSTACLE: u32 = 2;
/// Cells along the side of a tile.
const TILE: usize = 64;

/// Numbers a block has: its two lowest and its two highest sides, metres in the frame of the plan.
pub const BLOCK_NUMBERS: usize = 4;

/// A block in cells of its plan, `x_end` and `y_end` not included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Block {
    x: usize,
    y: usize,
    x_end: usize,
    y_end: usize,
}

/// Blocks of a plan.
#[derive(Clone, Debug, Default)]
pub struct WallBlocks {
    width: usize,
    height: usize,
    cell_m: f64,
    origin: Pose,
    raised: Vec<bool>,
    tiles: Vec<Vec<Block>>,
    numbers: Vec<f32>,
}

impl WallBlocks {
    /// [`BLOCK_NUMBERS`] for each block.
    #[must_use]
    pub fn numbers(&self) -> &[f32] {
        &self.numbers
    }

    /// Takes the plan that is shown now, and returns how many tiles had to be made again.
    pub fn renew(&mut self, plan: Option<&SimulatedPlan>) -> usize {
        let Some((plan, cells)) = plan.and_then(|plan| Some((plan, kinds(plan)?))) else {
            *self = Self::default();
            return 0;
        };
        let raised: Vec<bool> = cells.into_iter().map(|kind| kind == OBSTACLE).collect();
        let (width, height) = (plan.width as usize, plan.height as usize);
        let is_another = (self.width, self.height) != (width, height)
            || self.cell_m != plan.cell_m
            || self.origin != plan.origin;
        if is_another {
            *self = Self {
                width,
                height,
                cell_m: plan.cell_m,
                origin: plan.origin,
                raised: vec![false; raised.len()],
                tiles: vec![Vec::new(); width.div_ceil(TILE) * height.div_ceil(TILE)],
                numbers: Vec::new(),
            };
        }
        let before = std::mem::replace(&mut self.raised, raised);
        let changed: Vec<usize> = (0..self.tiles.len())
            .filter(|tile| self.differs(*tile, &before))
            .collect();
        for tile in &changed {
            let blocks = self.blocks_of(*tile);
            if let Some(place) = self.tiles.get_mut(*tile) {
                *place = blocks;
            }
        }
        if is_another || !changed.is_empty() {
            self.gather();
        }
        changed.len()
    }

    /// Columns and rows of a tile.
    fn area(&self, tile: usize) -> (core::ops::Range<usize>, core::ops::Range<usize>) {
        let across = self.width.div_ceil(TILE).max(1);
        let (x, y) = (tile % across * TILE, tile / across * TILE);
        (x..(x + TILE).min(self.width), y..(y + TILE).min(self.height))
    }

    fn row<'cells>(
        &self,
        cells: &'cells [bool],
        columns: &core::ops::Range<usize>,
        y: usize,
    ) -> &'cells [bool] {
        let first = y * self.width;
        cells
            .get(first + columns.start..first + columns.end)
            .unwrap_or_default()
    }

    fn differs(&self, tile: usize, before: &[bool]) -> bool {
        let (columns, mut rows) = self.area(tile);
        rows.any(|y| self.row(before, &columns, y) != self.row(&self.raised, &columns, y))
    }

    /// Runs of a row are joined with those below them that are as long.
    fn blocks_of(&self, tile: usize) -> Vec<Block> {
        let (columns, rows) = self.area(tile);
        let mut done: Vec<Block> = Vec::new();
        let mut open: Vec<Block> = Vec::new();
        for y in rows {
            let mut above = Vec::new();
            for (x, x_end) in stretches(self.row(&self.raised, &columns, y)) {
                let (x, x_end) = (columns.start + x, columns.start + x_end);
                let below = open.iter().position(|block| (block.x, block.x_end) == (x, x_end));
                let from = below.map_or(y, |place| open.swap_remove(place).y);
                above.push(Block {
                    x,
                    y: from,
                    x_end,
                    y_end: y + 1,
                });
            }
            done.append(&mut open);
            open = above;
        }
        done.append(&mut open);
        done
    }

    fn gather(&mut self) {
        let metres = |cells: usize| (cells as f64 * self.cell_m) as f32;
        self.numbers = self
            .tiles
            .iter()
            .flatten()
            .flat_map(|block| [block.x, block.y, block.x_end, block.y_end].map(metres))
            .collect();
    }
}

/// Where the runs of raised cells begin and end.
fn stretches(row: &[bool]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut begun = None;
    for (x, raised) in row.iter().chain(&[false]).enumerate() {
        match (begun, *raised) {
            (None, true) => begun = Some(x),
            (Some(first), false) => {
                found.push((first, x));
                begun = None;
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{BLOCK_NUMBERS, WallBlocks};
    use rvac_api::{Pose, SimulatedPlan};

    const WIDTH: u32 = 150;

    fn plan(raised: &[(u32, u32)]) -> SimulatedPlan {
        let kind = |index: u32| 1 + u32::from(raised.contains(&(index % WIDTH, index / WIDTH)));
        SimulatedPlan {
            name: String::new(),
            cell_m: 0.5,
            width: WIDTH,
            height: 80,
            origin: Pose::default(),
            cells: (0..WIDTH * 80).flat_map(|index| [kind(index), 1]).collect(),
            dock: None,
        }
    }

    #[test]
    fn blocks_cover_what_is_raised_once_and_nothing_else() {
        let shape = [
            (2, 2),
            (3, 2),
            (4, 2),
            (2, 3),
            (3, 3),
            (4, 3),
            (3, 4),
            (63, 10),
            (64, 10),
            (9, 2),
        ];
        let mut blocks = WallBlocks::default();
        blocks.renew(Some(&plan(&shape)));
        let mut covered: Vec<(u32, u32)> = Vec::new();
        for block in blocks.numbers().chunks_exact(BLOCK_NUMBERS) {
            let cells: Vec<u32> = block.iter().map(|metres| (metres / 0.5) as u32).collect();
            for y in cells[1]..cells[3] {
                covered.extend((cells[0]..cells[2]).map(|x| (x, y)));
            }
        }
        covered.sort_unstable();
        let mut wanted = shape.to_vec();
        wanted.sort_unstable();
        assert_eq!(covered, wanted);
        assert_eq!(
            blocks.numbers().len() / BLOCK_NUMBERS,
            5,
            "a wall is one block in its tile"
        );
    }

    #[test]
    fn only_tiles_that_changed_are_made_anew() {
        let mut blocks = WallBlocks::default();
        assert_eq!(blocks.renew(Some(&plan(&[(1, 1), (70, 1)]))), 2);
        assert_eq!(blocks.renew(Some(&plan(&[(1, 1), (70, 1)]))), 0);
        assert_eq!(blocks.renew(Some(&plan(&[(1, 1), (70, 2)]))), 1);
        assert_eq!(blocks.renew(Some(&plan(&[(70, 2)]))), 1);
        assert_eq!(blocks.numbers(), [35.0, 1.0, 35.5, 1.5]);
        assert_eq!(blocks.renew(None), 0);
        assert!(blocks.numbers().is_empty());
    }

    #[test]
    fn a_plan_that_does_not_hold_together_raises_nothing_that_is_not_there() {
        let mut broken = plan(&[(1, 1)]);
        broken.cells.truncate(7);
        let mut blocks = WallBlocks::default();
        blocks.renew(Some(&broken));
        assert!(blocks.numbers().is_empty());
        broken.width = u32::MAX;
        blocks.renew(Some(&broken));
        assert!(blocks.numbers().is_empty());
    }
}
