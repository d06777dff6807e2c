//! Bounded queues between an interrupt and the main loop: one producer, one consumer, nothing but loads and stores of
//! whole words. No compare-and-swap is used, which not every small core has.

use crate::edge::Edge;
use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};

/// What [`EdgeRing::pop`] hands out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Queued {
    /// The oldest edge.
    Edge(Edge),
    /// Here, after everything handed out before, at least one edge was lost.
    Overrun,
}

/// Edges on their way from the interrupt to the decoder. `N` is a power of two.
///
/// After it was full once, it takes nothing more until the consumer has emptied it and has been told: so the gap has one
/// place, and no decoder joins the edges before it with those after it.
#[derive(Debug)]
pub struct EdgeRing<const N: usize> {
    slots: [AtomicU32; N],
    /// Pushed so far; written by the producer.
    head: AtomicU32,
    /// Popped so far; written by the consumer.
    tail: AtomicU32,
    overrun: AtomicBool,
}

impl<const N: usize> EdgeRing<N> {
    /// An empty queue.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N.is_power_of_two(), "the size of a ring is a power of two") };
        Self {
            slots: [const { AtomicU32::new(0) }; N],
            head: AtomicU32::new(0),
            tail: AtomicU32::new(0),
            overrun: AtomicBool::new(false),
        }
    }

    /// Adds an edge; called by one producer only. A full queue loses it and remembers that.
    #[inline(always)]
    pub fn push(&self, edge: Edge) {
        let head = self.head.load(Ordering::Relaxed);
        let taken = head.wrapping_sub(self.tail.load(Ordering::Acquire));
        let full = taken >= N as u32 || self.overrun.load(Ordering::Relaxed);
        match self.slots.get(head as usize & (N - 1)) {
            Some(slot) if !full => {
                slot.store(edge.packed(), Ordering::Relaxed);
                self.head.store(head.wrapping_add(1), Ordering::Release);
            }
            _ => self.overrun.store(true, Ordering::Release),
        }
    }

    /// The oldest entry; called by one consumer only.
    #[inline]
    pub fn pop(&self) -> Option<Queued> {
        let tail = self.tail.load(Ordering::Relaxed);
        if self.head.load(Ordering::Acquire) == tail {
            if !self.overrun.load(Ordering::Acquire) {
                return None;
            }
            // While it is set the producer adds nothing. Empty also now: all before the gap has been handed out.
            if self.head.load(Ordering::Acquire) == tail {
                self.overrun.store(false, Ordering::Release);
                return Some(Queued::Overrun);
            }
        }
        let head = self.head.load(Ordering::Acquire);
        if head.wrapping_sub(tail) > N as u32 {
            // No producer does that: a bit of an index has flipped, and to follow it would take for ever.
            self.tail.store(head, Ordering::Release);
            return Some(Queued::Overrun);
        }
        let word = self.slots.get(tail as usize & (N - 1))?.load(Ordering::Relaxed);
        self.tail.store(tail.wrapping_add(1), Ordering::Release);
        Some(Queued::Edge(Edge::unpacked(word)))
    }
}

impl<const N: usize> Default for EdgeRing<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Bytes on their way to the transmitter, or from it. `N` is a power of two.
#[derive(Debug)]
pub struct ByteRing<const N: usize> {
    slots: [AtomicU8; N],
    head: AtomicU32,
    tail: AtomicU32,
}

impl<const N: usize> ByteRing<N> {
    /// An empty queue.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N.is_power_of_two(), "the size of a ring is a power of two") };
        Self {
            slots: [const { AtomicU8::new(0) }; N],
            head: AtomicU32::new(0),
            tail: AtomicU32::new(0),
        }
    }

    /// Adds as many of `bytes` as fit, from the front, and returns how many; called by one producer only.
    pub fn push(&self, bytes: &[u8]) -> usize {
        let head = self.head.load(Ordering::Relaxed);
        let room = (N as u32).saturating_sub(head.wrapping_sub(self.tail.load(Ordering::Acquire)));
        let taken = bytes.len().min(room as usize);
        for (offset, byte) in bytes.iter().take(taken).enumerate() {
            if let Some(slot) = self.slots.get((head as usize).wrapping_add(offset) & (N - 1)) {
                slot.store(*byte, Ordering::Relaxed);
            }
        }
        self.head
            .store(head.wrapping_add(taken as u32), Ordering::Release);
        taken
    }

    /// The oldest byte; called by one consumer only.
    #[inline(always)]
    pub fn pop(&self) -> Option<u8> {
        let tail = self.tail.load(Ordering::Relaxed);
        let head = self.head.load(Ordering::Acquire);
        if head == tail {
            return None;
        }
        if head.wrapping_sub(tail) > N as u32 {
            // As for edges above: a bit of an index has flipped.
            self.tail.store(head, Ordering::Release);
            return None;
        }
        let byte = self.slots.get(tail as usize & (N - 1))?.load(Ordering::Relaxed);
        self.tail.store(tail.wrapping_add(1), Ordering::Release);
        Some(byte)
    }

    /// Bytes in it, as seen at some moment during the call.
    pub fn len(&self) -> usize {
        let tail = self.tail.load(Ordering::Acquire);
        self.head.load(Ordering::Acquire).wrapping_sub(tail) as usize
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<const N: usize> Default for ByteRing<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{ByteRing, EdgeRing, Queued};
    use crate::edge::{Edge, Level};
    use core::sync::atomic::Ordering;

    #[test]
    fn an_index_with_a_flipped_bit_costs_what_waits_and_no_more() {
        let edge = Edge {
            at: 8,
            level: Level::Low,
        };
        for bit in 5..32 {
            let ring = EdgeRing::<16>::new();
            ring.push(edge);
            ring.tail.fetch_xor(1 << bit, Ordering::Relaxed);
            assert_eq!(ring.pop(), Some(Queued::Overrun));
            assert_eq!(ring.pop(), None);
            ring.push(edge);
            assert_eq!(ring.pop(), Some(Queued::Edge(edge)));
        }
    }
    #[test]
    fn so_it_is_with_bytes() {
        for bit in 5..32 {
            let ring = ByteRing::<16>::new();
            assert_eq!(ring.push(&[1, 2]), 2);
            ring.head.fetch_xor(1 << bit, Ordering::Relaxed);
            assert_eq!(ring.push(&[3]), 0);
            assert_eq!(ring.pop(), None);
            assert_eq!(ring.push(&[4]), 1);
            assert_eq!((ring.pop(), ring.pop()), (Some(4), None));
        }
    }
}
