//! The dock's receiver: decodes the robot's request for full current.
//!
//! The code is 33 bits of 0.5 ms on a carrier of 38 kHz, highest bit first, 1 = carrier
//! (`robots/samsung-sr8730/dock-signal.md`). The dock counts the carrier's periods in each bit; a bit with most of its
//! 19 periods is a 1, one with next to none a 0.

use super::CYCLES_PER_MS;
use crate::pins::Level;

/// The code with six leading ones.
const CODE: u64 = 0x1_F8C3_0CC3;
/// Its bits.
const BITS: u32 = 33;
const LEADING_ONES: u8 = 6;
/// Cycles of a bit.
const BIT: u64 = CYCLES_PER_MS / 2;
/// Periods in a bit from which it is a 1: more than half of the 19.
const ONE_PERIODS: u32 = 12;
/// Periods in a bit up to which it is a 0: one that began in the bit before.
const ZERO_PERIODS: u32 = 2;
/// Cycles of a period of the carrier: 38 kHz give or take a fifth, which is what receiver modules let through.
const PERIOD: std::ops::RangeInclusive<u64> = 1_750..=2_600;
/// Dark time before a code: longer than the longest run of zeros in it.
const GAP: u64 = 5 * BIT;
/// The dock gives full current for this long after a code: five codes come in a second, and one may be lost.
const HELD: u64 = 1_000 * CYCLES_PER_MS;

/// What the dock has understood.
#[derive(Clone, Debug)]
pub(super) struct DockEar {
    code: u64,
    bits: u32,
    start: Option<u64>,
    bit: u32,
    periods: u32,
    heard: u64,
    spoiled: bool,
    last_rise: Option<u64>,
    understood: Option<u64>,
    codes: u32,
}

impl DockEar {
    /// A dock that expects a code with this many leading ones.
    pub(super) fn new(leading_ones: u8) -> Self {
        let bits = BITS - u32::from(LEADING_ONES.saturating_sub(leading_ones));
        Self {
            code: CODE & ((1 << bits) - 1),
            bits,
            start: None,
            bit: 0,
            periods: 0,
            heard: 0,
            spoiled: false,
            last_rise: None,
            understood: None,
            codes: 0,
        }
    }

    /// The emitter that faces the dock turns on or off.
    pub(super) fn edge(&mut self, cycle: u64, light: Level) {
        if !light.is_high() {
            return;
        }
        let since = self.last_rise.map(|last| cycle - last);
        self.last_rise = Some(cycle);
        if since.is_none_or(|since| since > GAP) {
            self.finish(cycle);
            self.start = Some(cycle);
            (self.bit, self.periods, self.heard, self.spoiled) = (0, 0, 0, false);
        }
        let Some(start) = self.start else { return };
        // A rising edge half a period early or late still belongs to its bit.
        let bit = ((cycle - start + BIT / 40) / BIT) as u32;
        self.end_bits(bit);
        let in_carrier = since.is_some_and(|since| PERIOD.contains(&since));
        if self.periods > 0 && !in_carrier {
            self.spoiled = true;
        }
        self.periods += 1;
    }

    /// Time passes up to `cycle`: a code ends with the darkness after it.
    pub(super) fn advance(&mut self, cycle: u64) {
        if self.last_rise.is_some_and(|last| cycle - last > GAP) {
            self.finish(cycle);
        }
    }

    /// Takes note of all bits before this one.
    fn end_bits(&mut self, bit: u32) {
        while self.bit < bit && self.bit <= BITS {
            let one = self.periods >= ONE_PERIODS;
            self.spoiled |= !one && self.periods > ZERO_PERIODS;
            self.heard = self.heard << 1 | u64::from(one);
            self.bit += 1;
            self.periods = 0;
        }
    }

    fn finish(&mut self, cycle: u64) {
        if self.start.take().is_none() {
            return;
        }
        self.end_bits(self.bit + 1);
        let whole = self.bit == self.bits && !self.spoiled;
        if whole && self.heard == self.code {
            self.understood = Some(cycle);
            self.codes += 1;
        }
    }

    /// Whether the dock gives its full current now.
    pub(super) fn is_content(&self, cycle: u64) -> bool {
        self.understood.is_some_and(|at| cycle - at < HELD)
    }

    /// Codes understood so far.
    pub(super) const fn codes(&self) -> u32 {
        self.codes
    }
}

#[cfg(test)]
mod tests {
    use super::{BIT, CODE, DockEar};
    use crate::pins::Level;

    /// Sends bits on a carrier whose half period is `half` cycles; gives the end.
    fn send(ear: &mut DockEar, (code, bits): (u64, u32), from: u64, half: f64) -> u64 {
        for bit in 0..bits {
            let start = from as f64 + f64::from(bit) * 38.0 * half;
            if code >> (bits - 1 - bit) & 1 == 1 {
                for period in 0..19 {
                    let rise = start + f64::from(period) * 2.0 * half;
                    ear.edge(rise as u64, Level::High);
                    ear.edge((rise + half) as u64, Level::Low);
                }
            }
        }
        from + (f64::from(bits) * 38.0 * half) as u64
    }

    #[test]
    fn the_right_code_is_understood_and_forgotten() {
        for half in [1_052.6, 1_053.0, 1_050.0] {
            let mut ear = DockEar::new(6);
            let end = send(&mut ear, (CODE, 33), 1_000_000, half);
            assert!(!ear.is_content(end));
            ear.advance(end + 6 * BIT);
            assert!(ear.is_content(end + 6 * BIT), "half period {half}");
            assert!(!ear.is_content(end + 90_000_000));
        }
    }

    #[test]
    fn wrong_codes_carriers_and_pulses_are_not() {
        let mut ear = DockEar::new(6);
        let mut at = 1_000_000;
        for bit in 0..33 {
            at = send(&mut ear, (CODE ^ 1 << bit, 33), at, 1_052.6) + 10 * BIT;
        }
        at = send(&mut ear, (CODE >> 1, 32), at, 1_052.6) + 10 * BIT;
        at = send(&mut ear, (CODE, 33), at, 1_500.0) + 10 * BIT;
        for _ in 0..1_000 {
            ear.edge(at, Level::High);
            at += 14 * 80_000;
        }
        ear.advance(at);
        assert!(!ear.is_content(at));
        let end = send(&mut ear, (CODE, 33), at, 1_052.6);
        ear.advance(end + 6 * BIT);
        assert!(ear.is_content(end + 6 * BIT), "it still listens");
        assert_eq!(ear.codes(), 1);
    }

    #[test]
    fn a_dock_may_want_five_ones() {
        let five = CODE & 0xFFFF_FFFF;
        let mut ear = DockEar::new(5);
        let end = send(&mut ear, (CODE, 33), 0, 1_052.6);
        ear.advance(end + 6 * BIT);
        assert!(!ear.is_content(end + 6 * BIT));
        let end = send(&mut ear, (five, 32), end + 10 * BIT, 1_052.6);
        ear.advance(end + 6 * BIT);
        assert!(ear.is_content(end + 6 * BIT));
    }
}
