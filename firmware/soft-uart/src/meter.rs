//! The rate of the line from the letter `U`: 0x55 with its start and stop bit makes ten edges, each one bit after the
//! other.

use crate::baud::{Baud, BitTime};
use crate::edge::{Edge, Level};

const EDGES: usize = 10;
const INTERVALS: u32 = 9;
/// Places for times: the power of two above.
const PLACES: usize = 16;
/// How far a measured rate may lie from a known one: 1/20 is 5 %.
const TOLERANCE: u32 = 20;
/// How far a single interval may lie from the mean: 7/20 of a bit. An edge may be noticed a quarter of a bit late.
const UNEVEN_NUMERATOR: u32 = 7;
const UNEVEN_DENOMINATOR: u32 = 20;

/// Looks for `U` in the edges of a line, before any noise is taken out: at the wrong rate a true bit may be too short for
/// the decoder.
#[derive(Clone, Debug)]
pub struct RateMeter {
    bits: [BitTime; Baud::ALL.len()],
    /// No interval is longer than this, in counts.
    longest: u32,
    /// Times of the last edges; `newest` is the place of the last one.
    times: [u32; PLACES],
    newest: usize,
    last: u32,
    /// Between the last two edges, in counts.
    interval: u32,
    /// How many edges belong to a run of about equal intervals.
    run: u32,
}

impl RateMeter {
    /// A meter for edges stamped by a counter of so many counts a second.
    #[must_use]
    pub fn new(counts_per_second: u32) -> Self {
        let bits = Baud::ALL.map(|baud| BitTime::new(baud, counts_per_second));
        Self {
            bits,
            longest: 2 * bits.iter().map(|bit| bit.counts()).max().unwrap_or(0),
            times: [0; PLACES],
            newest: 0,
            last: 0,
            interval: 0,
            run: 0,
        }
    }

    /// Takes an edge. Ten edges at the pace of a known rate, within 5 %, the first falling, give that rate.
    #[inline]
    pub fn edge(&mut self, edge: Edge) -> Option<Baud> {
        self.extend(edge.at);
        if (self.run as usize) < EDGES || edge.level == Level::Low {
            return None;
        }
        self.measure()
    }

    /// Forgets the edges so far.
    pub fn restart(&mut self) {
        self.run = 0;
    }

    fn extend(&mut self, at: u32) {
        let interval = at.wrapping_sub(self.last);
        self.last = at;
        self.newest = (self.newest + 1) % PLACES;
        if let Some(newest) = self.times.get_mut(self.newest) {
            *newest = at;
        }
        self.run = if self.run == 0 || interval > self.longest {
            1
        } else if self.run == 1 || !alike(self.interval, interval) {
            2
        } else {
            self.run.saturating_add(1)
        };
        self.interval = interval;
    }

    /// The times of the run, oldest first.
    fn run(&self) -> [u32; EDGES] {
        core::array::from_fn(|index| {
            let place = (self.newest + PLACES + 1 - EDGES + index) % PLACES;
            self.times.get(place).copied().unwrap_or(0)
        })
    }

    #[cold]
    #[inline(never)]
    fn measure(&mut self) -> Option<Baud> {
        let times = self.run();
        let [first, .., last] = times;
        let whole = last.wrapping_sub(first);
        let even = times.iter().zip(times.iter().skip(1)).all(|(from, to)| {
            let off = (to.wrapping_sub(*from) * INTERVALS).abs_diff(whole);
            off * UNEVEN_DENOMINATOR <= whole * UNEVEN_NUMERATOR
        });
        if !even {
            return None;
        }
        let parts = bit_parts(&times);
        let rate = self.bits.iter().zip(Baud::ALL).find_map(|(bit, baud)| {
            let nominal = bit.parts().get();
            (parts.abs_diff(nominal) * TOLERANCE <= nominal).then_some(baud)
        });
        if rate.is_some() {
            self.run = 0;
        }
        rate
    }
}

/// The bit time in 256 parts of a count: the slope of the straight line with the least squares through all ten edges. It
/// halves the error of the two outer edges alone when each edge was noticed a little late.
fn bit_parts(times: &[u32; EDGES]) -> u32 {
    let [first, ..] = *times;
    // Weights are twice the distance from the middle, -9, -7 .. 9; twice the sum of their squares over four is 165.
    let weighted: i32 = times
        .iter()
        .zip((-9_i32..=9).step_by(2))
        .map(|(time, weight)| (time.wrapping_sub(first) as i32).wrapping_mul(weight))
        .fold(0, i32::wrapping_add);
    (weighted.max(0) as u32).wrapping_mul(256) / 165
}

/// Whether one interval is less than twice the other. Two intervals of one bit each differ by 5:3 at most when the edge
/// between them was noticed a quarter of a bit late.
fn alike(one: u32, other: u32) -> bool {
    one < 2 * other && other < 2 * one
}
