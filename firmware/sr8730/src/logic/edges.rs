//! Queue of the link's edges from the interrupt, which is written in assembly, to the decoder.

use core::sync::atomic::{AtomicU32, Ordering};

use soft_uart::{Edge, Level, Queued};

/// Edges that wait for the main loop: 2.2 ms of the densest pattern at 230,400 baud.
pub const EDGES: usize = 512;

/// The queue. The interrupt relies on the order of the fields.
///
/// The main loop gives room back to the interrupt once a millisecond only, however often it empties the queue. If there is
/// no room, the interrupt sets a flag and disables itself, until the main loop enables it in its next millisecond. A wire
/// that oscillates, whatever its rate, therefore costs at most [`EDGES`] interrupts in a millisecond, and as many edges to
/// decode.
#[derive(Debug)]
#[repr(C)]
pub struct EdgeQueue {
    /// Pushed so far; written by the interrupt.
    head: AtomicU32,
    /// Up to here the places are free for the interrupt; written by the main program.
    tail: AtomicU32,
    /// Level at the last edge, 0 or 1; written by the interrupt.
    level: AtomicU32,
    /// Not 0 when edges were lost; set by the interrupt, cleared by the main program.
    lost: AtomicU32,
    edges: [AtomicU32; EDGES],
    /// Taken so far by the main program.
    taken: AtomicU32,
}

impl EdgeQueue {
    /// Empty, the line high.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            head: AtomicU32::new(0),
            tail: AtomicU32::new(0),
            level: AtomicU32::new(1),
            lost: AtomicU32::new(0),
            edges: [const { AtomicU32::new(0) }; EDGES],
            taken: AtomicU32::new(0),
        }
    }

    /// Gives the places of what was taken back to the interrupt. Called once a millisecond.
    pub fn give_back(&self) {
        self.tail
            .store(self.taken.load(Ordering::Relaxed), Ordering::Release);
    }

    /// The oldest entry. Reports a gap after everything before it has been taken.
    pub fn pop(&self) -> Option<Queued> {
        // Read first: while the flag is set, the interrupt adds nothing.
        let lost = self.lost.load(Ordering::Acquire) != 0;
        let taken = self.taken.load(Ordering::Relaxed);
        let head = self.head.load(Ordering::Acquire);
        if head == taken {
            if lost {
                self.lost.store(0, Ordering::Release);
                return Some(Queued::Overrun);
            }
            return None;
        }
        if head.wrapping_sub(taken) > EDGES as u32 {
            // The interrupt never does that: a bit of an index has flipped, and following it would take too long.
            self.taken.store(head, Ordering::Relaxed);
            self.give_back();
            return Some(Queued::Overrun);
        }
        let word = self.edges.get(taken as usize % EDGES)?.load(Ordering::Relaxed);
        self.taken.store(taken.wrapping_add(1), Ordering::Relaxed);
        Some(Queued::Edge(Edge::unpacked(word)))
    }

    /// The level at the last edge.
    #[must_use]
    pub fn level(&self) -> Level {
        Level::of_bit(self.level.load(Ordering::Relaxed))
    }

    /// Notes the level before the interrupt is switched on, at the start and after a gap.
    pub fn set_level(&self, level: Level) {
        self.level
            .store(u32::from(level == Level::High), Ordering::Relaxed);
    }

    /// Adds an edge as the interrupt does; false if it must disable itself.
    #[must_use]
    pub fn push(&self, edge: Edge) -> bool {
        self.set_level(edge.level);
        let head = self.head.load(Ordering::Relaxed);
        let full = head.wrapping_sub(self.tail.load(Ordering::Acquire)) >= EDGES as u32;
        match self.edges.get(head as usize % EDGES) {
            Some(place) if !full => {
                place.store(edge.packed(), Ordering::Relaxed);
                self.head.store(head.wrapping_add(1), Ordering::Release);
                true
            }
            _ => {
                self.lost.store(1, Ordering::Release);
                false
            }
        }
    }
}

impl Default for EdgeQueue {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{EDGES, EdgeQueue};
    use core::sync::atomic::Ordering;
    use soft_uart::{Edge, Level, Queued};

    fn edge(number: u32) -> Edge {
        Edge {
            at: number * 100,
            level: Level::of_bit(number),
        }
    }

    #[test]
    fn edges_come_out_in_their_order_across_the_end_of_the_queue() {
        let queue = EdgeQueue::new();
        for round in 0..20 {
            queue.give_back();
            for number in 0..100 {
                assert!(queue.push(edge(round + number)));
            }
            assert_eq!(queue.level(), Level::of_bit(round + 99));
            for number in 0..100 {
                assert_eq!(queue.pop(), Some(Queued::Edge(edge(round + number))));
            }
            assert_eq!(queue.pop(), None);
        }
    }

    #[test]
    fn an_index_with_a_flipped_bit_costs_what_waits_and_no_more() {
        for bit in 10..32 {
            let queue = EdgeQueue::new();
            assert!(queue.push(edge(1)));
            queue.head.fetch_xor(1 << bit, Ordering::Relaxed);
            assert_eq!(queue.pop(), Some(Queued::Overrun));
            assert_eq!(queue.pop(), None);
            assert!(queue.push(edge(2)));
            assert_eq!(queue.pop(), Some(Queued::Edge(edge(2))));
        }
    }

    #[test]
    fn a_full_queue_tells_of_the_gap_behind_what_it_holds() {
        let queue = EdgeQueue::new();
        for number in 0..EDGES as u32 {
            assert!(queue.push(edge(number)));
        }
        assert!(!queue.push(edge(7)));
        for number in 0..EDGES as u32 {
            assert_eq!(queue.pop(), Some(Queued::Edge(edge(number))));
        }
        assert_eq!(queue.pop(), Some(Queued::Overrun));
        assert_eq!(queue.pop(), None);
        queue.give_back();
        assert!(queue.push(edge(9)));
    }

    #[test]
    fn a_consumer_that_keeps_up_bounds_the_edges_of_a_millisecond_too() {
        let queue = EdgeQueue::new();
        for _ in 0..3 {
            queue.give_back();
            let mut taken = 0;
            while queue.push(edge(taken)) {
                assert_eq!(queue.pop(), Some(Queued::Edge(edge(taken))));
                taken += 1;
            }
            assert_eq!(taken, EDGES as u32);
            assert_eq!(queue.pop(), Some(Queued::Overrun));
        }
    }
}
