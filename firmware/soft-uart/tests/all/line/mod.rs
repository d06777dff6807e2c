//! A line between two machines, as times of edges: a sender with an inexact clock, an interrupt that notices edges late,
//! pulses of noise, and a main loop that looks once a millisecond.

use soft_uart::{Baud, Edge, Level, Received, Receiver};

/// Counts of the receiver's counter a second.
pub(crate) const COUNTS_PER_S: u32 = 40_000_000;
/// How far the distance of two edges may be off in the counter's stamps, whose lowest bit is not kept, in counts.
const STAMP: f64 = 4.0;
/// Counts between two looks of the main loop.
pub(crate) const LOOK_COUNTS: u64 = 40_000;

/// A reproducible sequence (xorshift).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn below(&mut self, limit: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (((self.0 >> 32) * u64::from(limit)) >> 32) as u32
    }

    /// 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        f64::from(self.below(1 << 24)) / f64::from(1 << 24)
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }
}

/// How a sender and the line misbehave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Faults {
    /// How much too long its bits are: 0.025 is 2.5 %.
    pub(crate) clock_error: f64,
    /// Edges are noticed up to this share of a bit late.
    pub(crate) late_bits: f64,
}

pub(crate) const CLEAN: Faults = Faults {
    clock_error: 0.0,
    late_bits: 0.0,
};

/// What happened on the line: times of edges, in counts since some start, not wrapped.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) edges: Vec<(f64, Level)>,
    level: Level,
    /// Where the sender has come to.
    pub(crate) time: f64,
    faults: Faults,
    random: Random,
    /// When pulses of noise began, and how long they are.
    pulses: Vec<(f64, f64)>,
}

pub(crate) fn bit_counts(baud: Baud) -> f64 {
    f64::from(COUNTS_PER_S) / f64::from(baud.bits_per_second())
}

impl Line {
    /// An idle line.
    pub(crate) fn new(faults: Faults, seed: u64) -> Self {
        Self {
            edges: Vec::new(),
            level: Level::High,
            time: 100_000.0,
            faults,
            random: Random::new(seed),
            pulses: Vec::new(),
        }
    }

    pub(crate) fn hold(&mut self, level: Level, baud: Baud, bits: f64) {
        let bit = bit_counts(baud);
        if level != self.level {
            let late = self.faults.late_bits * self.random.share() * bit;
            self.edges.push((self.time + late, level));
            self.level = level;
        }
        self.time += bits * bit * (1.0 + self.faults.clock_error);
    }

    pub(crate) fn byte(&mut self, baud: Baud, byte: u8) {
        self.frame(baud, byte, Level::High);
    }

    pub(crate) fn frame(&mut self, baud: Baud, byte: u8, stop: Level) {
        self.hold(Level::Low, baud, 1.0);
        for position in 0..8 {
            self.hold(Level::of_bit(u32::from(byte) >> position), baud, 1.0);
        }
        self.hold(stop, baud, 1.0);
    }

    pub(crate) fn bytes(&mut self, baud: Baud, bytes: &[u8]) {
        for byte in bytes {
            self.byte(baud, *byte);
        }
    }

    pub(crate) fn pause_bits(&mut self, baud: Baud, bits: f64) {
        self.hold(Level::High, baud, bits);
    }

    pub(crate) fn pause_ms(&mut self, ms: f64) {
        self.hold(Level::High, Baud::B9600, ms * 9.6);
    }

    /// A pulse of the opposite level that begins at `at` and is `counts` long, wherever the line is then.
    pub(crate) fn noise(&mut self, at: f64, counts: f64) {
        let index = self.edges.partition_point(|(time, _)| *time <= at);
        if self
            .edges
            .get(index)
            .is_some_and(|(time, _)| *time <= at + counts)
        {
            // It would swallow an edge; on a wire it shifts it, which lateness covers.
            return;
        }
        let level = index
            .checked_sub(1)
            .map_or(Level::High, |before| self.edges[before].1);
        self.edges
            .splice(index..index, [(at, level.inverted()), (at + counts, level)]);
    }

    /// The same where no change is nearer than the pulse is long and no other pulse is nearer than that one is long;
    /// elsewhere nothing.
    pub(crate) fn noise_apart(&mut self, at: f64, counts: f64) {
        let end = at + counts;
        let is_change_near = self
            .edges
            .iter()
            .any(|(time, _)| *time > at - counts - STAMP && *time < end + counts + STAMP);
        let is_pulse_near = self
            .pulses
            .iter()
            .any(|(begins, counts)| end > begins - counts - STAMP && at < begins + 2.0 * counts + STAMP);
        if !is_change_near && !is_pulse_near {
            self.pulses.push((at, counts));
            self.noise(at, counts);
        }
    }
}

/// Lets a receiver hear the line as a main loop would. The counter begins at `offset`, so that it wraps somewhere.
pub(crate) fn hear(line: &Line, receiver: &mut Receiver, offset: u32) -> Vec<Received> {
    let mut heard = Vec::new();
    let mut sink = |received| heard.push(received);
    let wrapped = |time: u64| (time as u32).wrapping_add(offset);
    let mut edges = line.edges.iter().peekable();
    let mut look = LOOK_COUNTS;
    let end = line.time as u64 + 10 * LOOK_COUNTS;
    while look < end {
        while let Some((time, level)) = edges.next_if(|(time, _)| (*time as u64) < look) {
            let edge = Edge {
                at: wrapped(*time as u64),
                level: *level,
            };
            receiver.edge(Edge::unpacked(edge.packed()), &mut sink);
        }
        receiver.poll(wrapped(look), &mut sink);
        look += LOOK_COUNTS;
    }
    heard
}

pub(crate) fn good(bytes: &[u8]) -> Vec<Received> {
    bytes.iter().copied().map(Received::Byte).collect()
}
