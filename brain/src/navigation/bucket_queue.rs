//! A bucket queue (Dial's algorithm): a list of blocks for each cost, since costs are small whole numbers.

/// Cost of the longest step.
pub(super) const LONGEST_STEP_COST: u32 = 14;

/// Queued blocks, the lowest cost and then the lowest number first.
pub(super) struct BucketQueue {
    /// Blocks of equal cost. The costs in the queue differ by no more than the longest step, so the buckets are used
    /// cyclically.
    buckets: [Vec<u32>; LONGEST_STEP_COST as usize + 1],
    cost: u32,
    waiting: usize,
    /// The current bucket is sorted.
    is_sorted: bool,
}

impl BucketQueue {
    pub(super) fn of(start: usize) -> Self {
        let mut queue = Self {
            buckets: Default::default(),
            cost: 0,
            waiting: 0,
            is_sorted: false,
        };
        queue.push(0, start);
        queue
    }

    pub(super) fn push(&mut self, cost: u32, block: usize) {
        self.buckets[(cost % (LONGEST_STEP_COST + 1)) as usize].push(block as u32);
        self.waiting += 1;
    }

    pub(super) fn pop(&mut self) -> Option<(u32, usize)> {
        if self.waiting == 0 {
            return None;
        }
        loop {
            let bucket = &mut self.buckets[(self.cost % (LONGEST_STEP_COST + 1)) as usize];
            if !self.is_sorted {
                bucket.sort_unstable_by(|one, other| other.cmp(one));
                self.is_sorted = true;
            }
            if let Some(block) = bucket.pop() {
                self.waiting -= 1;
                return Some((self.cost, block as usize));
            }
            self.cost += 1;
            self.is_sorted = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BucketQueue, LONGEST_STEP_COST};

    #[test]
    fn the_lowest_cost_comes_first_and_then_the_lowest_number() {
        let mut queue = BucketQueue::of(7);
        assert_eq!(queue.pop(), Some((0, 7)));
        for (cost, block) in [(LONGEST_STEP_COST, 3), (10, 9), (10, 2)] {
            queue.push(cost, block);
        }
        assert_eq!(queue.pop(), Some((10, 2)));
        queue.push(10 + LONGEST_STEP_COST, 1);
        assert_eq!(queue.pop(), Some((10, 9)));
        assert_eq!(queue.pop(), Some((LONGEST_STEP_COST, 3)));
        assert_eq!(queue.pop(), Some((10 + LONGEST_STEP_COST, 1)));
        assert_eq!(queue.pop(), None);
    }
}
