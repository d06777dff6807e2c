//! Ways between places over free ground: a coarse graph finds them, lines of sight straighten them.

use std::collections::VecDeque;

use super::bucket_queue::{LONGEST, Queue};
use super::configuration_space::Ground;
use crate::mapping::CELL_M;
use crate::model::gradual::StepBudget;

/// Cells along the edge of a block of the coarse graph.
const BLOCK: usize = 4;
/// Cost of a step to a neighbour, and to a diagonal one.
const STEP: u32 = 10;
const DIAGONAL: u32 = LONGEST;
/// Work of looking at a cell, of finding out where one gets from a block, and of leaving one.
const LOOK_WORK: usize = 2;
const DOORS_WORK: usize = 100;
const LEAVE_WORK: usize = 22;
/// Blocks that are left between two looks at the budget.
const LEAVES: usize = 32;
/// No block.
const NONE: u32 = u32::MAX;

/// Finds ways over blocks of cells.
pub(crate) struct Router<'ground> {
    ground: &'ground Ground,
    columns: usize,
    /// A free cell for each block, `NONE` if it has none.
    anchors: Vec<u32>,
    /// Bit n: the body gets from the block to the nth of those around it.
    doors: Vec<u8>,
    /// Bit n: it gets there straight from one anchor to the other.
    sights: Vec<u8>,
}

/// Costs and parents of the blocks around a place.
pub(crate) struct Spread {
    costs: Vec<u32>,
    parents: Vec<u32>,
    touched: Vec<u32>,
}

impl<'ground> Router<'ground> {
    pub(crate) async fn new(ground: &'ground Ground, budget: &mut StepBudget) -> Self {
        let columns = ground.width / BLOCK + 1;
        let mut router = Self {
            ground,
            columns,
            anchors: vec![NONE; columns * (ground.height / BLOCK + 1)],
            doors: Vec::new(),
            sights: Vec::new(),
        };
        // The free cell nearest to the middle of its block stands for it.
        let mut best = vec![u32::MAX; router.anchors.len()];
        for index in 0..ground.free.len() {
            if index.is_multiple_of(ground.width) {
                budget.spend(LOOK_WORK * ground.width).await;
            }
            if !ground.free[index] {
                continue;
            }
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
        router.doors = Vec::with_capacity(router.anchors.len());
        router.sights = Vec::with_capacity(router.anchors.len());
        for block in 0..router.anchors.len() {
            let (doors, sights) = router.doors_of(block);
            router.doors.push(doors);
            router.sights.push(sights);
            let is_ground = router.anchors[block] != NONE;
            budget.spend(if is_ground { DOORS_WORK } else { LOOK_WORK }).await;
        }
        router
    }

    /// Where the body gets from a block, and where straight.
    fn doors_of(&self, block: usize) -> (u8, u8) {
        if self.anchors[block] == NONE {
            return (0, 0);
        }
        let (mut doors, mut sights) = (0, 0);
        for (number, (next, step)) in self.around(block).into_iter().enumerate() {
            let is_ground = self.anchors.get(next).is_some_and(|anchor| *anchor != NONE);
            if !is_ground {
                continue;
            }
            let (from, to) = (self.anchors[block] as usize, self.anchors[next] as usize);
            if self.ground.sees(from, to) {
                doors |= 1 << number;
                sights |= 1 << number;
            } else if step == STEP && self.touch(block, next) {
                doors |= 1 << number;
            }
        }
        (doors, sights)
    }

    pub(crate) fn ground(&self) -> &Ground {
        self.ground
    }

    /// The block of a cell.
    pub(crate) fn block(&self, index: usize) -> usize {
        let (column, row) = self.ground.place(index);
        row / BLOCK * self.columns + column / BLOCK
    }

    pub(crate) fn spread(&self) -> Spread {
        Spread {
            costs: vec![u32::MAX; self.anchors.len()],
            parents: vec![NONE; self.anchors.len()],
            touched: Vec::new(),
        }
    }

    /// Spreads from a cell until `enough` says so; it is asked with each block that is reached, nearest first.
    pub(crate) async fn explore(
        &self,
        from: usize,
        (spread, budget): (&mut Spread, &mut StepBudget),
        mut enough: impl FnMut(usize) -> bool,
    ) {
        spread.reset();
        let start = self.block(from);
        spread.set(start, 0, NONE);
        let mut queue = Queue::of(start);
        let mut left = 0;
        while let Some((cost, block)) = queue.pop() {
            if cost > spread.costs[block] {
                continue;
            }
            if enough(block) {
                return;
            }
            left += 1;
            if left % LEAVES == 0 {
                budget.spend(LEAVE_WORK * LEAVES).await;
            }
            self.leave(block, cost, (spread, &mut queue));
        }
    }

    /// Goes to all blocks that the body gets to from one.
    fn leave(&self, block: usize, cost: u32, (spread, queue): (&mut Spread, &mut Queue)) {
        let doors = self.doors[block];
        for (number, (next, step)) in self.around(block).into_iter().enumerate() {
            if doors & 1 << number == 0 {
                continue;
            }
            let through = cost + step;
            if through < spread.costs[next] {
                spread.set(next, through, block as u32);
                queue.push(through, next);
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
    pub(crate) fn way(&self, spread: &Spread, from: usize, to: usize) -> Vec<usize> {
        let mut blocks = vec![self.block(to)];
        while let Some(block) = blocks.last()
            && spread.parents[*block] != NONE
        {
            blocks.push(spread.parents[*block] as usize);
        }
        blocks.reverse();
        self.straightened(&self.joined_up(&blocks, (from, to)))
    }

    /// The anchors of the blocks after the first one, between two cells in the first and the last one, and cells put in
    /// between two that do not see each other though their blocks touch.
    fn joined_up(&self, blocks: &[usize], (from, to): (usize, usize)) -> Vec<usize> {
        let mut whole = Vec::with_capacity(blocks.len() + 1);
        whole.push(from);
        for (position, pair) in blocks.windows(2).enumerate() {
            let anchor = self.anchors[pair[1]] as usize;
            let is_seen = if position == 0 {
                self.ground.sees(from, anchor)
            } else {
                self.is_seen(pair[0], pair[1])
            };
            self.join(&mut whole, anchor, is_seen);
        }
        let is_seen = whole.last().is_some_and(|last| self.ground.sees(*last, to));
        self.join(&mut whole, to, is_seen);
        whole
    }

    /// Lengthens a chain by a cell, and by those between if its end does not see it.
    fn join(&self, chain: &mut Vec<usize>, cell: usize, is_seen: bool) {
        if let Some(last) = chain.last().filter(|_| !is_seen) {
            chain.extend(self.cells_between(*last, cell));
        }
        chain.push(cell);
    }

    /// Whether the anchor of a block sees that of the next one.
    fn is_seen(&self, block: usize, next: usize) -> bool {
        let around = self.around(block);
        let number = around.iter().position(|(beside, _)| *beside == next);
        number.is_some_and(|number| self.sights[block] & 1 << number != 0)
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
    pub(crate) fn way_m(&self, block: usize) -> Option<f64> {
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
