//! Bytes from the times of edges, at a known rate.
//!
//! Terms: a *frame* has ten bits: start (position 0, low), eight data bits, lowest first (1 to 8), stop (9, high). A
//! *boundary* is where a bit begins. The *anchor* is the last accepted edge. Times are measured from it and not from
//! the start of the frame, so that a difference between the two clocks only accumulates over bits of the same level.

use crate::baud::BitTime;
use crate::edge::{Edge, Level};

/// Something received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Received {
    /// A byte that arrived well.
    Byte(u8),
    /// A byte whose stop bit was low. Its data bits are not usable.
    FramingError,
    /// The line was low for a whole frame: the other side is unpowered, restarts, or calls for attention.
    Break,
    /// Edges were lost before they could be decoded, and with them at least one byte.
    Overrun,
}

/// Position of the stop bit.
const STOP: u32 = 9;
/// Boundaries of a frame, the one behind the stop bit included.
const BOUNDARIES: usize = 11;
/// A pulse shorter than this share of a bit is noise: 2/5. A true pulse of one bit whose first edge was noticed a
/// quarter of a bit late, from a sender 2.5 % fast, still has 0.72 bits.
const NOISE_NUMERATOR: u32 = 2;
const NOISE_DENOMINATOR: u32 = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DecoderPhase {
    /// A falling edge begins a frame.
    Idle,
    /// After a wrong stop bit: only a line that became high again can be idle.
    AwaitHigh,
    Frame(DecodedFrame),
}

/// A frame being received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct DecodedFrame {
    /// Time of the last edge.
    anchor: u32,
    /// Boundary of the last edge.
    position: u32,
    /// Bit n is the level at position n if no edge follows. An edge inverts all bits from its boundary on.
    bits: u32,
    /// The middle of the stop bit, measured from the anchor. Here the frame ends.
    end: u32,
}

/// Knowledge about the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LineState {
    /// Nothing: before the first edge, and after edges were lost.
    Unknown,
    /// Its level; all edges so far were accepted.
    Level(Level),
    /// This edge came. It is accepted once the level has been stable for long enough.
    Edge(Edge),
    /// This edge came, and at this moment, soon after it, the line went back. One of the two pulses around that moment
    /// is noise; the next edge shows which.
    Back(Edge, u32),
}

/// Decodes frames at one rate. [`crate::Receiver`] adds finding the rate.
#[derive(Clone, Debug)]
pub struct Decoder {
    /// Half a bit, in counts.
    half: u32,
    /// 2^40 by the bit time's parts: counts times this, by 2^32, are bits.
    bits_per_count: u32,
    /// Pulses shorter than this are noise, in counts.
    noise: u32,
    /// From each boundary to the middle of the stop bit, in counts.
    ends: [u32; BOUNDARIES],
    signal: LineState,
    phase: DecoderPhase,
}

impl Decoder {
    /// A decoder for bits of this length, in counts of the counter that stamps the edges.
    #[must_use]
    pub fn new(bit: BitTime) -> Self {
        let parts = bit.parts().get();
        let halves = |boundary: usize| (2 * STOP + 1).saturating_sub(2 * boundary as u32);
        Self {
            half: parts >> 9,
            bits_per_count: ((1_u64 << 40) / u64::from(parts)).min(u64::from(u32::MAX)) as u32,
            noise: bit.counts() * NOISE_NUMERATOR / NOISE_DENOMINATOR,
            ends: core::array::from_fn(|boundary| (parts * halves(boundary)) >> 9),
            signal: LineState::Unknown,
            phase: DecoderPhase::Idle,
        }
    }

    /// Takes the next edge. A byte that ends before it goes to `sink`.
    #[inline(always)]
    pub fn edge(&mut self, edge: Edge, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_edge(edge) {
            sink(received);
        }
    }

    /// Sets the time, after all edges before `now` were given. A byte whose stop bit is half over goes to `sink`.
    #[inline(always)]
    pub fn poll(&mut self, now: u32, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_time(now) {
            sink(received);
        }
    }

    /// Edges were lost: the present frame is dropped, and the next falling edge begins a new one.
    #[inline(always)]
    pub fn overrun(&mut self, sink: &mut impl FnMut(Received)) {
        self.forget();
        sink(Received::Overrun);
    }

    pub(crate) fn forget(&mut self) {
        self.signal = LineState::Unknown;
        self.phase = DecoderPhase::Idle;
    }

    pub(crate) fn take_edge(&mut self, edge: Edge) -> Option<Received> {
        if let LineState::Edge(pending) = self.signal {
            if edge.level == pending.level {
                // Two edges came so close that the interrupt saw only the level after both.
                return None;
            }
            if since(pending.at, edge.at) < self.noise {
                self.signal = LineState::Back(pending, edge.at);
                return None;
            }
            self.believe(pending);
        } else if !self.is_news(edge) {
            return None;
        }
        self.signal = LineState::Edge(edge);
        self.finish_before(edge.at)
    }

    /// Whether the edge begins something while no edge or pulse is pending.
    fn is_news(&mut self, edge: Edge) -> bool {
        match self.signal {
            LineState::Unknown => true,
            LineState::Level(level) | LineState::Edge(Edge { level, .. }) => edge.level != level,
            LineState::Back(pending, _) if edge.level != pending.level => false,
            // The line went there, back, and there again: the shorter of the two pulses was noise.
            LineState::Back(pending, back) => {
                let is_second_shorter = since(back, edge.at) < since(pending.at, back);
                if is_second_shorter {
                    self.signal = LineState::Edge(pending);
                }
                !is_second_shorter
            }
        }
    }

    pub(crate) fn take_time(&mut self, now: u32) -> Option<Received> {
        match self.signal {
            LineState::Edge(pending) => {
                if since(pending.at, now) < self.noise {
                    return None;
                }
                self.signal = LineState::Level(pending.level);
                self.believe(pending);
            }
            LineState::Back(pending, back) => {
                if since(back, now) < self.noise {
                    return None;
                }
                self.signal = LineState::Level(pending.level.inverted());
            }
            LineState::Unknown | LineState::Level(_) => {}
        }
        self.finish_before(now)
    }

    /// Accepts an edge. A frame that ends before it was ended when the edge came.
    #[inline(always)]
    fn believe(&mut self, edge: Edge) {
        match (&mut self.phase, edge.level) {
            (DecoderPhase::Frame(frame), level) => {
                let counts = since(frame.anchor, edge.at) + self.half;
                let bits = (u64::from(counts) * u64::from(self.bits_per_count)) >> 32;
                let boundary = (frame.position + bits as u32).min(STOP + 1);
                frame.bits ^= u32::MAX << boundary;
                if boundary != frame.position {
                    frame.position = boundary;
                    frame.anchor = edge.at;
                    let rest = self.ends.get(boundary as usize).copied().unwrap_or(0);
                    frame.end = edge.at.wrapping_add(rest);
                } else if boundary == 0 && level == Level::High {
                    // A start bit of less than half a bit is noise.
                    self.phase = DecoderPhase::Idle;
                }
            }
            (DecoderPhase::Idle, Level::Low) => {
                let [whole, ..] = self.ends;
                self.phase = DecoderPhase::Frame(DecodedFrame {
                    anchor: edge.at,
                    position: 0,
                    bits: 0,
                    end: edge.at.wrapping_add(whole),
                });
            }
            (DecoderPhase::AwaitHigh, Level::High) => self.phase = DecoderPhase::Idle,
            (DecoderPhase::Idle, Level::High) | (DecoderPhase::AwaitHigh, Level::Low) => {}
        }
    }

    /// Ends the present frame if its end lies at or before `now`.
    #[inline(always)]
    fn finish_before(&mut self, now: u32) -> Option<Received> {
        let DecoderPhase::Frame(frame) = &self.phase else {
            return None;
        };
        if (now.wrapping_sub(frame.end) as i32) < 0 {
            return None;
        }
        let data = (frame.bits >> 1) as u8;
        let (received, phase) = if frame.bits & (1 << STOP) != 0 {
            (Received::Byte(data), DecoderPhase::Idle)
        } else if data == 0 {
            (Received::Break, DecoderPhase::AwaitHigh)
        } else {
            (Received::FramingError, DecoderPhase::AwaitHigh)
        };
        self.phase = phase;
        Some(received)
    }
}

/// Counts from `from` to `to`; 0 when `to` is the earlier one.
fn since(from: u32, to: u32) -> u32 {
    let counts = to.wrapping_sub(from);
    if counts > i32::MAX as u32 { 0 } else { counts }
}
