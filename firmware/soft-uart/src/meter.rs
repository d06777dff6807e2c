//! The rate of the line from the letter `U`: 0x55 with its start and stop bit makes ten edges, each one bit after the
//! other.

use crate::baud::{Baud, BitTime};
use crate::edge::{Edge, Level};

const EDGES: usize = 10;
const INTERVALS: u32 = 9;
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
    /// Times of the last edges, oldest first.
    times: [u32; EDGES],
    /// How many of them belong to a run of about equal intervals.
    run: usize,
}

impl RateMeter {
    /// A meter for edges stamped by a counter of so many counts a second.
    #[must_use]
    pub fn new(counts_per_second: u32) -> Self {
        Self {
            bits: Baud::ALL.map(|baud| BitTime::new(baud, counts_per_second)),
            times: [0; EDGES],
            run: 0,
        }
    }

    /// Takes an edge. Ten edges at the pace of a known rate, within 5 %, the first falling, give that rate.
    pub fn edge(&mut self, edge: Edge) -> Option<Baud> {
        self.extend(edge.at);
        if self.run < EDGES || edge.level == Level::Low {
            return None;
        }
        let rate = self.measure();
        if rate.is_some() {
            self.run = 0;
        }
        rate
    }

    /// Forgets the edges so far.
    pub fn restart(&mut self) {
        self.run = 0;
    }

    fn extend(&mut self, at: u32) {
        let [.., before, last] = self.times;
        self.times.rotate_left(1);
        let [.., newest] = &mut self.times;
        *newest = at;
        let interval = at.wrapping_sub(last);
        let slowest = self.bits.first().map_or(0, |bit| bit.counts());
        self.run = match self.run {
            0 => 1,
            _ if interval > 2 * slowest => 1,
            1 => 2,
            run if alike(last.wrapping_sub(before), interval) => (run + 1).min(EDGES),
            _ => 2,
        };
    }

    fn measure(&self) -> Option<Baud> {
        let [first, .., last] = self.times;
        let whole = last.wrapping_sub(first);
        let even = self
            .times
            .iter()
            .zip(self.times.iter().skip(1))
            .all(|(from, to)| {
                let off = (to.wrapping_sub(*from) * INTERVALS).abs_diff(whole);
                off * UNEVEN_DENOMINATOR <= whole * UNEVEN_NUMERATOR
            });
        if !even {
            return None;
        }
        let parts = self.bit_parts(first);
        self.bits.iter().zip(Baud::ALL).find_map(|(bit, baud)| {
            let nominal = bit.parts().get();
            (parts.abs_diff(nominal) * TOLERANCE <= nominal).then_some(baud)
        })
    }

    /// The bit time in 256 parts of a count: the slope of the straight line with the least squares through all ten
    /// edges. It halves the error of the two outer edges alone when each edge was noticed a little late.
    fn bit_parts(&self, first: u32) -> u32 {
        // Weights are twice the distance from the middle, -9, -7 .. 9; twice the sum of their squares over four is 165.
        let weighted: i32 = self
            .times
            .iter()
            .zip((-9_i32..=9).step_by(2))
            .map(|(time, weight)| (time.wrapping_sub(first) as i32).wrapping_mul(weight))
            .fold(0, i32::wrapping_add);
        (weighted.max(0) as u32).wrapping_mul(256) / 165
    }
}

/// Whether one interval is less than twice the other. Two intervals of one bit each differ by 5:3 at most when the edge
/// between them was noticed a quarter of a bit late.
fn alike(one: u32, other: u32) -> bool {
    let (short, long) = if one < other { (one, other) } else { (other, one) };
    long < 2 * short
}
