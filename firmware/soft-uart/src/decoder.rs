//! Bytes from the times of edges, at a known rate.
//!
//! Words used here: a *frame* has ten bits: start (position 0, low), eight data bits, lowest first (1 to 8), stop (9,
//! high). A *boundary* is where a bit begins. The *anchor* is the last edge that was believed: times are measured from it
//! and not from the start of the frame, so that a difference between the two clocks only adds up over bits of the same
//! level.

use crate::baud::BitTime;
use crate::edge::{Edge, Level};

/// What the line brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Received {
    /// A byte that arrived well.
    Byte(u8),
    /// A byte whose stop bit was low. What its data bits were is not worth knowing.
    FramingError,
    /// The line was low for a whole frame: the other side is unpowered, restarts, or calls for attention.
    Break,
    /// Edges were lost before they could be decoded, and with them at least one byte.
    Overrun,
}

/// Bits of a frame.
const STOP: u32 = 9;
/// The middle of the stop bit in half bits from the start of the frame. Here a frame ends.
const STOP_MIDDLE_HALVES: u32 = 19;
/// A pulse shorter than this share of a bit is noise: 2/5. A true pulse of one bit whose first edge was noticed a quarter
/// of a bit late, from a sender 2.5 % fast, still has 0.72 bits.
const NOISE_NUMERATOR: u32 = 2;
const NOISE_DENOMINATOR: u32 = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// A falling edge begins a frame.
    Idle,
    /// After a wrong stop bit: only a line that became high again can be idle.
    AwaitHigh,
    /// `bits` holds the bits before `position`, which is the boundary of the anchor.
    Frame { anchor: u32, position: u32, bits: u32 },
}

/// Decodes frames at one rate. [`crate::Receiver`] adds finding the rate.
#[derive(Clone, Debug)]
pub struct Decoder {
    bit: BitTime,
    /// 2^40 by the bit time's parts: counts times this, by 2^32, are bits.
    bits_per_count: u32,
    /// Pulses shorter than this are noise, in counts.
    noise: u32,
    /// Since the last edge that was believed; `None` before the first and after edges were lost.
    line: Option<Level>,
    /// An edge that is believed once it has stood long enough.
    pending: Option<Edge>,
    /// When the line went back soon after the pending edge. One of the two pulses around this moment is noise; what comes
    /// next shows which.
    back: Option<u32>,
    phase: Phase,
}

impl Decoder {
    /// A decoder for bits of this length, in counts of the counter that stamps the edges.
    #[must_use]
    pub fn new(bit: BitTime) -> Self {
        Self {
            bit,
            bits_per_count: ((1_u64 << 40) / u64::from(bit.parts().get())).min(u64::from(u32::MAX)) as u32,
            noise: bit.counts() * NOISE_NUMERATOR / NOISE_DENOMINATOR,
            line: None,
            pending: None,
            back: None,
            phase: Phase::Idle,
        }
    }

    /// Takes the next edge. A byte that ends before it goes to `sink`.
    #[inline(always)]
    pub fn edge(&mut self, edge: Edge, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_edge(edge) {
            sink(received);
        }
    }

    /// Tells the time, after every edge before `now` was given. A byte whose stop bit is half over goes to `sink`.
    #[inline(always)]
    pub fn poll(&mut self, now: u32, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_time(now) {
            sink(received);
        }
    }

    /// Tells that edges were lost: the frame under way is given up, the next falling edge begins a new one.
    #[inline(always)]
    pub fn overrun(&mut self, sink: &mut impl FnMut(Received)) {
        self.forget();
        sink(Received::Overrun);
    }

    pub(crate) fn forget(&mut self) {
        self.line = None;
        self.pending = None;
        self.back = None;
        self.phase = Phase::Idle;
    }

    pub(crate) fn take_edge(&mut self, edge: Edge) -> Option<Received> {
        let before = *self.line.get_or_insert(edge.level.inverted());
        let newest = match (self.pending, self.back) {
            (Some(pending), None) => pending.level,
            _ => before,
        };
        if edge.level == newest {
            // Two edges came so close that the interrupt saw only the level after both.
            return None;
        }
        match (self.pending, self.back.take()) {
            (Some(pending), None) if since(pending.at, edge.at) < self.noise => {
                self.back = Some(edge.at);
                return None;
            }
            (Some(pending), None) => self.believe(pending),
            // The line went there, back, and there again: the shorter of the two pulses was noise.
            (Some(pending), Some(back)) if since(back, edge.at) < since(pending.at, back) => return None,
            _ => {}
        }
        self.pending = Some(edge);
        self.finish_before(edge.at)
    }

    pub(crate) fn take_time(&mut self, now: u32) -> Option<Received> {
        if let Some(pending) = self.pending {
            let newest = self.back.unwrap_or(pending.at);
            if since(newest, now) < self.noise {
                return None;
            }
            self.pending = None;
            if self.back.take().is_none() {
                self.believe(pending);
            }
        }
        self.finish_before(now)
    }

    /// Takes an edge for true. A frame that ends before it has been ended when the edge came.
    fn believe(&mut self, edge: Edge) {
        self.line = Some(edge.level);
        match (self.phase, edge.level) {
            (Phase::Idle, Level::Low) => {
                self.phase = Phase::Frame {
                    anchor: edge.at,
                    position: 0,
                    bits: 0,
                };
            }
            (Phase::AwaitHigh, Level::High) => self.phase = Phase::Idle,
            (Phase::Idle | Phase::AwaitHigh, _) => {}
            (
                Phase::Frame {
                    anchor,
                    position,
                    bits,
                },
                level,
            ) => {
                let boundary = position + self.bits_between(anchor, edge.at);
                if boundary == 0 && level == Level::High {
                    // A start bit of less than half a bit is none.
                    self.phase = Phase::Idle;
                } else if boundary != position {
                    self.phase = Phase::Frame {
                        anchor: edge.at,
                        position: boundary,
                        bits: fill(bits, position..boundary, level.inverted()),
                    };
                }
            }
        }
    }

    /// Ends the frame under way when the middle of its stop bit lies at or before `now`.
    fn finish_before(&mut self, now: u32) -> Option<Received> {
        let Phase::Frame {
            anchor,
            position,
            bits,
        } = self.phase
        else {
            return None;
        };
        let halves = STOP_MIDDLE_HALVES.saturating_sub(2 * position);
        if since(anchor, now) < (self.bit.parts().get() * halves) >> 9 {
            return None;
        }
        let level = self.line.unwrap_or(Level::Low);
        let bits = fill(bits, position..STOP + 1, level);
        let data = (bits >> 1) as u8;
        let (received, phase) = if bits & (1 << STOP) != 0 {
            (Received::Byte(data), Phase::Idle)
        } else if data == 0 {
            (Received::Break, Phase::AwaitHigh)
        } else {
            (Received::FramingError, Phase::AwaitHigh)
        };
        self.phase = phase;
        Some(received)
    }

    /// Whole bits, rounded, at most ten. The caller has ended frames that are over, so more cannot be asked for.
    fn bits_between(&self, from: u32, to: u32) -> u32 {
        let counts = since(from, to) + (self.bit.parts().get() >> 9);
        let bits = (u64::from(counts) * u64::from(self.bits_per_count)) >> 32;
        (bits as u32).min(STOP + 1)
    }
}

/// Counts from `from` to `to`; 0 when `to` is the earlier one.
fn since(from: u32, to: u32) -> u32 {
    let counts = to.wrapping_sub(from);
    if counts > i32::MAX as u32 { 0 } else { counts }
}

/// Sets the bits of `range` in `bits` when the line was high.
fn fill(bits: u32, range: core::ops::Range<u32>, level: Level) -> u32 {
    let below = |boundary: u32| (1_u32 << boundary.min(STOP + 1)) - 1;
    match level {
        Level::Low => bits,
        Level::High => bits | (below(range.end) & !below(range.start)),
    }
}
