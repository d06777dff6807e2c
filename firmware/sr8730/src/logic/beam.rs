//! Decodes the dock's beams from the edges of an infrared receiver.
//!
//! The real dock's beams have not been recorded. This decodes the placeholder of
//! `robots/samsung-sr8730/dock-signal.md`: eight bits, highest first, four units of time a bit, carrier for three of
//! them for a 1 and for one for a 0. Without calibration values the beams are reported as absent.

/// Symbol of the beam to the dock's left, as the host knows it.
pub const LEFT: u8 = 1;
/// Symbol of the beam to the dock's right.
pub const RIGHT: u8 = 2;
/// Symbol of the weak beam around the dock.
pub const NEAR: u8 = 4;

/// A beam counts as received for this long: its code comes every 120 ms, and one may be lost.
const HELD_MS: u32 = 250;
/// Counts of the core timer in a microsecond.
const COUNTS_PER_US: u32 = 40;
const BITS: u8 = 8;

/// Codes and timing, from the calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BeamCodes {
    codes: [u8; 3],
    unit_counts: u32,
}

impl BeamCodes {
    /// `None` unless all four are known and valid. `unit_us` is the length of the shortest carrier burst.
    #[must_use]
    pub fn new(codes: [Option<i32>; 3], unit_us: Option<i32>) -> Option<Self> {
        let [left, right, near] = codes.map(|code| u8::try_from(code?).ok());
        let unit_us = u32::try_from(unit_us?)
            .ok()
            .filter(|unit| (100..=3_000).contains(unit))?;
        Some(Self {
            codes: [left?, right?, near?],
            unit_counts: unit_us * COUNTS_PER_US,
        })
    }

    fn symbol(&self, code: u8) -> u8 {
        let symbols = [LEFT, RIGHT, NEAR];
        let matching = self.codes.iter().zip(symbols).find(|(known, _)| **known == code);
        matching.map_or(0, |(_, symbol)| symbol)
    }
}

/// State of a receiver after an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// It sees the carrier.
    Carrier,
    /// It does not.
    Dark,
}

/// One receiver.
#[derive(Clone, Copy, Debug, Default)]
pub struct BeamReceiver {
    carrier_since: Option<u32>,
    last_edge: u32,
    code: u8,
    bits: u8,
    held: [Option<u32>; 3],
}

impl BeamReceiver {
    /// Takes an edge: the state after it, and the core timer's count at that moment.
    pub fn edge(&mut self, light: Light, at: u32, codes: &BeamCodes) {
        let silent = at.wrapping_sub(self.last_edge);
        self.last_edge = at;
        match light {
            Light::Carrier => {
                if silent > 4 * codes.unit_counts {
                    self.bits = 0;
                }
                self.carrier_since = Some(at);
            }
            Light::Dark => {
                let burst = self.carrier_since.take().map(|since| at.wrapping_sub(since));
                self.take_burst(burst.unwrap_or(0), codes);
            }
        }
    }

    /// Called once a millisecond: the silence after a code ends it, and old codes expire. Returns the sum of the
    /// symbols of all beams received recently.
    pub fn poll(&mut self, count: u32, tick_ms: u32, codes: &BeamCodes) -> u8 {
        let silent = count.wrapping_sub(self.last_edge);
        if self.bits != 0 && self.carrier_since.is_none() && silent > 4 * codes.unit_counts {
            if self.bits == BITS {
                self.hear(codes.symbol(self.code), tick_ms);
            }
            self.bits = 0;
        }
        let mut symbols = 0;
        for (held, symbol) in self.held.iter_mut().zip([LEFT, RIGHT, NEAR]) {
            if held.is_some_and(|since| tick_ms.wrapping_sub(since) > HELD_MS) {
                *held = None;
            }
            if held.is_some() {
                symbols |= symbol;
            }
        }
        symbols
    }

    fn take_burst(&mut self, burst: u32, codes: &BeamCodes) {
        let unit = codes.unit_counts;
        // One unit or three, each within half a unit plus the distortion of the receiver module.
        let fits = burst > unit / 4 && burst < 4 * unit;
        if !fits || self.bits > BITS {
            // More bits than a code has: noise until the next silence.
            self.bits = BITS + 1;
            return;
        }
        self.code = self.code << 1 | u8::from(burst > 2 * unit);
        self.bits += 1;
    }

    fn hear(&mut self, symbol: u8, tick_ms: u32) {
        for (held, beam) in self.held.iter_mut().zip([LEFT, RIGHT, NEAR]) {
            if beam == symbol {
                *held = Some(tick_ms);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BeamCodes, BeamReceiver, LEFT, Light, NEAR, RIGHT};

    const UNIT: u32 = 40_000;
    const MS: u32 = 40_000;

    fn codes() -> BeamCodes {
        BeamCodes::new([Some(72), Some(68), Some(65)], Some(1_000)).unwrap()
    }

    /// Sends one code from `at` on, each burst longer by `stretch` counts, as receiver modules make them.
    fn send(receiver: &mut BeamReceiver, code: u8, at: u32, stretch: i32) {
        for bit in 0..8 {
            let units = if code >> (7 - bit) & 1 == 1 { 3 } else { 1 };
            let start = at.wrapping_add(bit * 4 * UNIT);
            receiver.edge(Light::Carrier, start, &codes());
            let end = start.wrapping_add(units * UNIT).wrapping_add_signed(stretch);
            receiver.edge(Light::Dark, end, &codes());
        }
    }

    #[test]
    fn codes_become_symbols_and_fade() {
        for stretch in [-15_000, 0, 15_000] {
            for start in [1_000_000, u32::MAX - 12 * UNIT] {
                let mut receiver = BeamReceiver::default();
                send(&mut receiver, 72, start, stretch);
                assert_eq!(receiver.poll(start.wrapping_add(32 * MS), 32, &codes()), 0);
                assert_eq!(receiver.poll(start.wrapping_add(37 * MS), 37, &codes()), LEFT);
                send(&mut receiver, 65, start.wrapping_add(80 * MS), stretch);
                assert_eq!(
                    receiver.poll(start.wrapping_add(118 * MS), 118, &codes()),
                    LEFT | NEAR
                );
                assert_eq!(receiver.poll(start.wrapping_add(300 * MS), 300, &codes()), NEAR);
                assert_eq!(receiver.poll(start.wrapping_add(400 * MS), 400, &codes()), 0);
            }
        }
    }

    #[test]
    fn two_codes_in_a_row_are_told_apart() {
        let mut receiver = BeamReceiver::default();
        send(&mut receiver, 72, 0, 0);
        assert_eq!(receiver.poll(39 * MS, 39, &codes()), LEFT);
        send(&mut receiver, 68, 40 * MS, 0);
        assert_eq!(receiver.poll(79 * MS, 79, &codes()), LEFT | RIGHT);
    }

    #[test]
    fn half_codes_unknown_codes_and_noise_mean_nothing() {
        let mut receiver = BeamReceiver::default();
        send(&mut receiver, 0x55, 0, 0);
        assert_eq!(receiver.poll(60 * MS, 60, &codes()), 0);
        for start in 0..5 {
            receiver.edge(Light::Carrier, (100 + 4 * start) * MS, &codes());
            receiver.edge(Light::Dark, (101 + 4 * start) * MS, &codes());
        }
        assert_eq!(receiver.poll(200 * MS, 200, &codes()), 0);
        let mut seed = 3_u32;
        let mut at = 300 * MS;
        for _ in 0..100_000 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            at = at.wrapping_add(seed >> 18);
            let light = if seed >> 31 == 1 {
                Light::Carrier
            } else {
                Light::Dark
            };
            receiver.edge(light, at, &codes());
        }
        assert_eq!(receiver.poll(at.wrapping_add(500 * MS), 60_000, &codes()), 0);
    }

    #[test]
    fn a_code_after_noise_is_heard() {
        let mut receiver = BeamReceiver::default();
        receiver.edge(Light::Dark, 5, &codes());
        receiver.edge(Light::Carrier, 9, &codes());
        receiver.edge(Light::Dark, 10, &codes());
        receiver.poll(20 * MS, 20, &codes());
        send(&mut receiver, 68, 30 * MS, 0);
        assert_eq!(receiver.poll(70 * MS, 70, &codes()), RIGHT);
    }

    #[test]
    fn unknown_codes_make_no_beams() {
        assert_eq!(BeamCodes::new([Some(72), None, Some(65)], Some(1_000)), None);
        assert_eq!(BeamCodes::new([Some(72), Some(68), Some(65)], None), None);
        assert_eq!(BeamCodes::new([Some(72), Some(68), Some(400)], Some(1_000)), None);
    }
}
