//! Ways between places over free ground: a coarse graph finds them, lines of sight straighten them.

use core::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use super::ground::Ground;
use crate::mapping::CELL_M;

/// Cells along the edge of a block of the coarse graph.
const BLOCK: usize = 4;
/// Cost of a step to a neighbour, and to a diagonal one.
const STEP: u32 = 10;
const DIAGONAL: u32 = 14;
/// No block.
const NONE: u32 = u32::MAX;

/// Finds ways over blocks of cells.
pub(super) struct Router<'ground> {
    ground: &'ground Ground,
    columns: usize,
    /// A free cell for each block, `NONE` if it has none.
    anchors: Vec<u32>,
    /// Bit n: the body gets from the block to the nth of those around it.
    doors: Vec<u8>,
}

/// Costs and parents of the blocks around a place.
pub(super) struct Spread {
    costs: Vec<u32>,
    parents: Vec<u32>,
    touched: Vec<u32>,
}

impl<'ground> Router<'ground> {
    pub(super) fn new(ground: &'ground Ground) -> Self {
        let columns = ground.width / BLOCK + 1;
        let mut router = Self {
            ground,
            columns,
            anchors: vec![NONE; columns * (ground.height / BLOCK + 1)],
            doors: Vec::new(),
        };
        // The free cell nearest to the middle of its block stands for it.
        let mut best = vec![u32::MAX; router.anchors.len()];
        for index in (0..ground.free.len()).filter(|index| ground.free[*index]) {
            let (column, row) = ground.place(index);
            let (x, y) = (2 * (column % BLOCK) as i32, 2 * (row % BLOCK) as i32);
            let middle = BLOCK as i32 - 1;
            let off = ((x - middle) * (x - middle) + (y - middle) * (y - middle)) as u32;
            let block = router.block(index);
            if off < best[block] {
                best[block] = off;
                router.anchors[block] = index as u32;
            }
        }
        router.doors = (0..router.anchors.len())
            .map(|block| router.doors_of(block))
            .collect();
        router
    }

    fn doors_of(&self, block: usize) -> u8 {
        if self.anchors[block] == NONE {
            return 0;
        }
        let mut doors = 0;
        for (number, (next, step)) in self.around(block).into_iter().enumerate() {
            let is_ground = self.anchors.get(next).is_some_and(|anchor| *anchor != NONE);
            if is_ground && self.joined(block, next, step) {
                doors |= 1 << number;
            }
        }
        doors
    }

    pub(super) fn ground(&self) -> &Ground {
        self.ground
    }

    /// The block of a cell.
    pub(super) fn block(&self, index: usize) -> usize {
        let (column, row) = self.ground.place(index);
        row / BLOCK * self.columns + column / BLOCK
    }

    pub(super) fn spread(&self) -> Spread {
        Spread {
            costs: vec![u32::MAX; self.anchors.len()],
            parents: vec![NONE; self.anchors.len()],
            touched: Vec::new(),
        }
    }

    /// Spreads from a cell until `enough` says so; it is asked with each block that is reached, nearest first.
    pub(super) fn explore(&self, from: usize, spread: &mut Spread, mut enough: impl FnMut(usize) -> bool) {
        spread.reset();
        let start = self.block(from);
        spread.set(start, 0, NONE);
        let mut queue = BinaryHeap::from([Reverse((0, start))]);
        while let Some(Reverse((cost, block))) = queue.pop() {
            if cost > spread.costs[block] {
                continue;
            }
            if enough(block) {
                return;
            }
            for (number, (next, step)) in self.around(block).into_iter().enumerate() {
                if self.doors[block] & 1 << number == 0 {
                    continue;
                }
                let through = cost + step;
                if through < spread.costs[next] {
                    spread.set(next, through, block as u32);
                    queue.push(Reverse((through, next)));
                }
            }
        }
    }

    fn around(&self, block: usize) -> [(usize, u32); 8] {
        let (up, down) = (block + self.columns, block.wrapping_sub(self.columns));
        [
            (block.wrapping_sub(1), STEP),
            (block + 1, STEP),
            (up, STEP),
            (down, STEP),
            (up.wrapping_sub(1), DIAGONAL),
            (up + 1, DIAGONAL),
            (down.wrapping_sub(1), DIAGONAL),
            (down.wrapping_add(1), DIAGONAL),
        ]
    }

    /// Whether the body gets from one block to the next.
    fn joined(&self, block: usize, next: usize, step: u32) -> bool {
        let (from, to) = (self.anchors[block] as usize, self.anchors[next] as usize);
        self.ground.sees(from, to) || (step == STEP && self.touch(block, next))
    }

    /// Whether free cells of two blocks lie side by side.
    fn touch(&self, block: usize, next: usize) -> bool {
        let (low, high) = (block.min(next), block.max(next));
        let (column, row) = (low % self.columns * BLOCK, low / self.columns * BLOCK);
        let width = self.ground.width;
        let free =
            |x: usize, y: usize| x < width && y < self.ground.height && self.ground.free[y * width + x];
        if high == low + 1 {
            let x = column + BLOCK;
            (row..row + BLOCK).any(|y| free(x - 1, y) && free(x, y))
        } else {
            let y = row + BLOCK;
            (column..column + BLOCK).any(|x| free(x, y - 1) && free(x, y))
        }
    }

    /// The straightened way from the place that was explored from to `to`; both ends included.
    pub(super) fn way(&self, spread: &Spread, from: usize, to: usize) -> Vec<usize> {
        let mut chain = vec![to];
        let mut block = self.block(to);
        while spread.parents[block] != NONE {
            chain.push(self.anchors[block] as usize);
            block = spread.parents[block] as usize;
        }
        chain.push(from);
        chain.reverse();
        self.straightened(&self.joined_up(&chain))
    }

    /// The chain with cells put in between two that do not see each other, though their blocks touch.
    fn joined_up(&self, chain: &[usize]) -> Vec<usize> {
        let mut whole = Vec::with_capacity(chain.len());
        for (position, cell) in chain.iter().enumerate() {
            if let Some(before) = position.checked_sub(1).and_then(|before| chain.get(before))
                && !self.ground.sees(*before, *cell)
            {
                whole.extend(self.cells_between(*before, *cell));
            }
            whole.push(*cell);
        }
        whole
    }

    /// Neighbouring free cells from one cell to another in the blocks around them, without the two; empty if there are none.
    fn cells_between(&self, from: usize, to: usize) -> Vec<usize> {
        let ((x0, y0), (x1, y1)) = (self.ground.place(from), self.ground.place(to));
        let (low_x, high_x) = (x0.min(x1).saturating_sub(BLOCK), x0.max(x1) + BLOCK);
        let (low_y, high_y) = (y0.min(y1).saturating_sub(BLOCK), y0.max(y1) + BLOCK);
        let width = high_x - low_x + 1;
        let local = |cell: usize| {
            let (x, y) = self.ground.place(cell);
            let inside = (low_x..=high_x).contains(&x) && (low_y..=high_y).contains(&y);
            inside.then(|| (y - low_y) * width + x - low_x)
        };
        let mut parents = vec![NONE; width * (high_y - low_y + 1)];
        let mut waiting = VecDeque::from([to]);
        while let Some(cell) = waiting.pop_front() {
            if cell == from {
                break;
            }
            for next in self.ground.neighbours(cell) {
                let Some(place) = local(next).filter(|_| self.ground.free[next]) else {
                    continue;
                };
                if parents[place] == NONE && next != to {
                    parents[place] = cell as u32;
                    waiting.push_back(next);
                }
            }
        }
        let mut cells = Vec::new();
        let mut cell = from;
        while let Some(parent) = local(cell)
            .map(|place| parents[place])
            .filter(|parent| *parent != NONE)
        {
            cell = parent as usize;
            if cell == to {
                break;
            }
            cells.push(cell);
        }
        cells
    }

    fn straightened(&self, chain: &[usize]) -> Vec<usize> {
        let mut way = Vec::new();
        let mut at = 0;
        while let Some(here) = chain.get(at) {
            way.push(*here);
            // The farthest one in sight without a gap in between; a next one that is not in sight is taken as it is.
            let mut next = at + 1;
            while next + 1 < chain.len() && self.ground.sees(*here, chain[next + 1]) {
                next += 1;
            }
            at = next;
        }
        way
    }
}

impl Spread {
    /// Length of the way to a block in metres; `None` when it was not reached.
    pub(super) fn way_m(&self, block: usize) -> Option<f64> {
        let cost = self.costs.get(block).filter(|cost| **cost != u32::MAX)?;
        Some(f64::from(*cost) / f64::from(STEP) * BLOCK as f64 * CELL_M)
    }

    fn set(&mut self, block: usize, cost: u32, parent: u32) {
        self.costs[block] = cost;
        self.parents[block] = parent;
        self.touched.push(block as u32);
    }

    fn reset(&mut self) {
        for block in self.touched.drain(..) {
            self.costs[block as usize] = u32::MAX;
            self.parents[block as usize] = NONE;
        }
    }
}
