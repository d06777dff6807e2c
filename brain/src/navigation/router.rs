//! Paths over free cells: Dijkstra on a coarse graph of blocks, then shortcuts along lines of sight.

use std::collections::VecDeque;

use super::bucket_queue::{BucketQueue, LONGEST_STEP_COST};
use super::configuration_space::ConfigurationSpace;
use crate::mapping::CELL_M;
use crate::model::gradual::StepBudget;

/// Cells along the edge of a block of the coarse graph.
const BLOCK: usize = 4;
/// Cost of a step to a neighbour, and to a diagonal one.
const STEP: u32 = 10;
const DIAGONAL: u32 = LONGEST_STEP_COST;
/// Work to read a cell, to find the links of a block, and to expand one.
const READ_WORK: usize = 2;
const LINKS_WORK: usize = 100;
const EXPAND_WORK: usize = 22;
/// Work to search a path to a nearby cell, beyond that for its goal.
pub(crate) const PATH_WORK: usize = 3_000;
/// Blocks that are expanded between two checks of the budget.
const EXPANSIONS: usize = 32;
/// No block.
const NONE: u32 = u32::MAX;

/// Finds paths over blocks of cells.
pub(crate) struct Router<'space> {
    space: &'space ConfigurationSpace,
    columns: usize,
    /// A free cell for each block, `NONE` if it has none.
    anchors: Vec<u32>,
    /// Bit n: the body can drive from the block to its nth neighbour.
    block_links: Vec<u8>,
    /// Bit n: it can drive there in a straight line between the anchors.
    straight_links: Vec<u8>,
}

/// Costs and parents of the blocks around the cell of the last exploration.
pub(crate) struct CostField<'router> {
    router: &'router Router<'router>,
    from: usize,
    costs: Vec<u32>,
    parents: Vec<u32>,
    touched: Vec<u32>,
}

impl<'space> Router<'space> {
    pub(crate) async fn new(space: &'space ConfigurationSpace, budget: &mut StepBudget) -> Self {
        let columns = space.width / BLOCK + 1;
        let mut router = Self {
            space,
            columns,
            anchors: vec![NONE; columns * (space.height / BLOCK + 1)],
            block_links: Vec::new(),
            straight_links: Vec::new(),
        };
        // The free cell nearest to the centre of a block is its anchor.
        let mut best = vec![u32::MAX; router.anchors.len()];
        for index in 0..space.free.len() {
            if index.is_multiple_of(space.width) {
                budget.spend(READ_WORK * space.width).await;
            }
            if !space.free[index] {
                continue;
            }
            let (column, row) = space.column_and_row(index);
            let (x, y) = (2 * (column % BLOCK) as i32, 2 * (row % BLOCK) as i32);
            let middle = BLOCK as i32 - 1;
            let off = ((x - middle) * (x - middle) + (y - middle) * (y - middle)) as u32;
            let block = router.block(index);
            if off < best[block] {
                best[block] = off;
                router.anchors[block] = index as u32;
            }
        }
        router.block_links = Vec::with_capacity(router.anchors.len());
        router.straight_links = Vec::with_capacity(router.anchors.len());
        for block in 0..router.anchors.len() {
            let (links, straight_links) = router.links_of(block);
            router.block_links.push(links);
            router.straight_links.push(straight_links);
            let is_free = router.anchors[block] != NONE;
            budget.spend(if is_free { LINKS_WORK } else { READ_WORK }).await;
        }
        router
    }

    /// The links of a block, and which of them are straight.
    fn links_of(&self, block: usize) -> (u8, u8) {
        if self.anchors[block] == NONE {
            return (0, 0);
        }
        let (mut links, mut straight_links) = (0, 0);
        for (number, (next, step)) in self.around(block).into_iter().enumerate() {
            let is_free = self.anchors.get(next).is_some_and(|anchor| *anchor != NONE);
            if !is_free {
                continue;
            }
            let (from, to) = (self.anchors[block] as usize, self.anchors[next] as usize);
            if self.space.has_line_of_sight(from, to) {
                links |= 1 << number;
                straight_links |= 1 << number;
            } else if step == STEP && self.are_adjacent(block, next) {
                links |= 1 << number;
            }
        }
        (links, straight_links)
    }

    pub(crate) fn space(&self) -> &ConfigurationSpace {
        self.space
    }

    /// The block of a cell.
    pub(crate) fn block(&self, index: usize) -> usize {
        let (column, row) = self.space.column_and_row(index);
        row / BLOCK * self.columns + column / BLOCK
    }

    /// A cost field for explorations over these blocks.
    pub(crate) fn cost_field(&self) -> CostField<'_> {
        CostField {
            router: self,
            from: 0,
            costs: vec![u32::MAX; self.anchors.len()],
            parents: vec![NONE; self.anchors.len()],
            touched: Vec::new(),
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

    /// Whether free cells of two blocks are adjacent.
    fn are_adjacent(&self, block: usize, next: usize) -> bool {
        let (low, high) = (block.min(next), block.max(next));
        let (column, row) = (low % self.columns * BLOCK, low / self.columns * BLOCK);
        let width = self.space.width;
        let free = |x: usize, y: usize| x < width && y < self.space.height && self.space.free[y * width + x];
        if high == low + 1 {
            let x = column + BLOCK;
            (row..row + BLOCK).any(|y| free(x - 1, y) && free(x, y))
        } else {
            let y = row + BLOCK;
            (column..column + BLOCK).any(|x| free(x, y - 1) && free(x, y))
        }
    }

    /// The anchors of the blocks after the first one, between the two end cells. Where two of them have no line of sight
    /// though their blocks are adjacent, the cells between them are inserted.
    fn joined(&self, blocks: &[usize], from: usize, to: usize) -> Vec<usize> {
        let mut whole = Vec::with_capacity(blocks.len() + 1);
        whole.push(from);
        for (position, pair) in blocks.windows(2).enumerate() {
            let anchor = self.anchors[pair[1]] as usize;
            let is_seen = if position == 0 {
                self.space.has_line_of_sight(from, anchor)
            } else {
                self.is_seen(pair[0], pair[1])
            };
            self.join(&mut whole, anchor, is_seen);
        }
        let is_seen = whole
            .last()
            .is_some_and(|last| self.space.has_line_of_sight(*last, to));
        self.join(&mut whole, to, is_seen);
        whole
    }

    /// Appends a cell to a chain, with the cells between where there is no line of sight.
    fn join(&self, chain: &mut Vec<usize>, cell: usize, is_seen: bool) {
        if let Some(last) = chain.last().filter(|_| !is_seen) {
            chain.extend(self.cells_between(*last, cell));
        }
        chain.push(cell);
    }

    /// Whether the anchors of two neighbouring blocks have a line of sight.
    fn is_seen(&self, block: usize, next: usize) -> bool {
        let around = self.around(block);
        let number = around.iter().position(|(beside, _)| *beside == next);
        number.is_some_and(|number| self.straight_links[block] & 1 << number != 0)
    }

    /// Adjacent free cells from one cell to another in the blocks around them, without the two; empty if there are none.
    fn cells_between(&self, from: usize, to: usize) -> Vec<usize> {
        let ((x0, y0), (x1, y1)) = (self.space.column_and_row(from), self.space.column_and_row(to));
        let (low_x, high_x) = (x0.min(x1).saturating_sub(BLOCK), x0.max(x1) + BLOCK);
        let (low_y, high_y) = (y0.min(y1).saturating_sub(BLOCK), y0.max(y1) + BLOCK);
        let width = high_x - low_x + 1;
        let local = |cell: usize| {
            let (x, y) = self.space.column_and_row(cell);
            let inside = (low_x..=high_x).contains(&x) && (low_y..=high_y).contains(&y);
            inside.then(|| (y - low_y) * width + x - low_x)
        };
        let mut parents = vec![NONE; width * (high_y - low_y + 1)];
        let mut waiting = VecDeque::from([to]);
        while let Some(cell) = waiting.pop_front() {
            if cell == from {
                break;
            }
            for next in self.space.neighbours(cell) {
                let Some(place) = local(next).filter(|_| self.space.free[next]) else {
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
        let mut path = Vec::new();
        let mut at = 0;
        while let Some(here) = chain.get(at) {
            path.push(*here);
            // The farthest cell in a line of sight without interruption; the next cell is accepted without one.
            let mut next = at + 1;
            while next + 1 < chain.len() && self.space.has_line_of_sight(*here, chain[next + 1]) {
                next += 1;
            }
            at = next;
        }
        path
    }
}

impl CostField<'_> {
    /// Runs Dijkstra's algorithm from a cell until `enough` returns true for a reached block, nearest first.
    pub(crate) async fn explore(
        &mut self,
        from: usize,
        mut enough: impl FnMut(usize) -> bool,
        budget: &mut StepBudget,
    ) {
        self.reset();
        self.from = from;
        let start = self.router.block(from);
        self.set(start, 0, NONE);
        let mut queue = BucketQueue::of(start);
        let mut expanded = 0;
        while let Some((cost, block)) = queue.pop() {
            if cost > self.costs[block] {
                continue;
            }
            if enough(block) {
                return;
            }
            expanded += 1;
            if expanded % EXPANSIONS == 0 {
                budget.spend(EXPAND_WORK * EXPANSIONS).await;
            }
            self.expand(block, &mut queue);
        }
    }

    /// Relaxes the links of a block.
    fn expand(&mut self, block: usize, queue: &mut BucketQueue) {
        let cost = self.costs[block];
        let links = self.router.block_links[block];
        for (number, (next, step)) in self.router.around(block).into_iter().enumerate() {
            if links & 1 << number == 0 {
                continue;
            }
            let through = cost + step;
            if through < self.costs[next] {
                self.set(next, through, block as u32);
                queue.push(through, next);
            }
        }
    }

    /// The shortened path from the start of the exploration to `to`, both ends included.
    pub(crate) fn path(&self, to: usize) -> Vec<usize> {
        let router = self.router;
        let mut blocks = vec![router.block(to)];
        while let Some(block) = blocks.last()
            && self.parents[*block] != NONE
        {
            blocks.push(self.parents[*block] as usize);
        }
        blocks.reverse();
        router.straightened(&router.joined(&blocks, self.from, to))
    }

    /// Length of the path to a block in metres; `None` when it was not reached.
    pub(crate) fn path_m(&self, block: usize) -> Option<f64> {
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
