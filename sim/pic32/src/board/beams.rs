//! The dock's homing beams on the robot's four 38 kHz receivers.
//!
//! The real ones have not been recorded. These are the placeholder of `robots/samsung-sr8730/dock-signal.md`: three
//! codes of eight bits, sent in turn, four units of time a bit, carrier for three of them for a 1 and for one for a 0.

use super::CYCLES_PER_MS;
use super::encoder::ScheduledEdge;
use super::wiring::DigitalLine;

/// Milliseconds from one code to the next.
const SLOT_MS: u64 = 40;
const BITS: u64 = 8;
const UNITS_PER_BIT: u64 = 4;
const ONE_UNITS: u64 = 3;
const CYCLES_PER_US: u64 = CYCLES_PER_MS / 1000;

/// The dock's transmitter and the robot's receivers.
#[derive(Clone, Debug)]
pub(super) struct Beams {
    receivers: [DigitalLine; 4],
    codes: [u8; 3],
    unit: u64,
    on: [bool; 4],
    /// What each receiver's beams were when the code began: a code is heard whole or not at all.
    heard: [bool; 4],
}

impl Beams {
    pub(super) fn new(receivers: [DigitalLine; 4], codes: [u8; 3], unit_us: u32) -> Self {
        Self {
            receivers,
            codes,
            unit: u64::from(unit_us.max(1)) * CYCLES_PER_US,
            on: [false; 4],
            heard: [false; 4],
        }
    }

    /// The levels now, as edges at `cycle`.
    pub(super) fn levels(&self, cycle: u64) -> [ScheduledEdge; 4] {
        [0, 1, 2, 3].map(|number| {
            let line = self.receivers[number];
            (cycle, line.pin, line.level(self.on[number]))
        })
    }

    /// Edges of the millisecond that begins at `from`. `symbols` are the beams that reach each receiver: the sum of
    /// [`home::DOCK_LEFT`], [`home::DOCK_RIGHT`] and [`home::DOCK_NEAR`].
    pub(super) fn pass_ms(&mut self, from: u64, symbols: [u8; 4], edges: &mut Vec<ScheduledEdge>) {
        let now_ms = from / CYCLES_PER_MS;
        let slot = (now_ms / SLOT_MS) as usize % self.codes.len();
        if now_ms.is_multiple_of(SLOT_MS) {
            let symbol = [home::DOCK_LEFT, home::DOCK_RIGHT, home::DOCK_NEAR][slot];
            self.heard = symbols.map(|symbols| symbols & symbol != 0);
        }
        let start = now_ms / SLOT_MS * SLOT_MS * CYCLES_PER_MS;
        // Bursts begin and end at whole units; the first that lies in this millisecond, and all others.
        let first = (from - start).div_ceil(self.unit);
        let mut place = first;
        while start + place * self.unit < from + CYCLES_PER_MS {
            let carrier = self.carrier(slot, place);
            self.switch(start + place * self.unit, carrier, edges);
            place += 1;
        }
    }

    /// Whether the code of this slot has its carrier on after so many units.
    fn carrier(&self, slot: usize, place: u64) -> bool {
        let bit = place / UNITS_PER_BIT;
        let one = bit < BITS && self.codes[slot] >> (BITS - 1 - bit) & 1 == 1;
        bit < BITS && place % UNITS_PER_BIT < if one { ONE_UNITS } else { 1 }
    }

    fn switch(&mut self, cycle: u64, carrier: bool, edges: &mut Vec<ScheduledEdge>) {
        for (number, line) in self.receivers.iter().enumerate() {
            let on = carrier && self.heard[number];
            if on != self.on[number] {
                self.on[number] = on;
                edges.push((cycle, line.pin, line.level(on)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Beams;
    use crate::board::pinout::Pinout;
    use crate::board::wiring::Wiring;
    use crate::board::{CYCLES_PER_MS, encoder::ScheduledEdge};

    fn beams() -> (Beams, crate::board::wiring::DigitalLine) {
        let wiring = Wiring::of(&Pinout::sr8730().unwrap()).unwrap();
        let left = wiring.beam_receivers[0];
        (Beams::new(wiring.beam_receivers, [72, 68, 65], 1_000), left)
    }

    /// Codes on one receiver, by the lengths of its bursts.
    fn codes(edges: &[ScheduledEdge], line: crate::board::wiring::DigitalLine) -> Vec<u8> {
        let (mut codes, mut code, mut bits, mut since, mut ended) = (Vec::new(), 0_u8, 0, 0, 0);
        for (cycle, pin, level) in edges {
            if *pin != line.pin {
                continue;
            }
            if *level == line.level(true) {
                since = *cycle;
                assert!(bits > 0 || codes.is_empty() || since - ended > 8 * CYCLES_PER_MS);
            } else {
                ended = *cycle;
                code = code << 1 | u8::from(ended - since > 2 * CYCLES_PER_MS);
                bits += 1;
                if bits == 8 {
                    codes.push(code);
                    (code, bits) = (0, 0);
                }
            }
        }
        codes
    }

    #[test]
    fn a_receiver_hears_the_beams_that_reach_it() {
        for (symbols, wanted) in [
            (home::DOCK_LEFT, vec![72, 72]),
            (home::DOCK_RIGHT | home::DOCK_NEAR, vec![68, 65, 68, 65]),
            (0, vec![]),
        ] {
            let (mut beams, left) = beams();
            let mut edges = Vec::new();
            for ms in 0..240 {
                beams.pass_ms(ms * CYCLES_PER_MS, [symbols, 0, 0, 0], &mut edges);
            }
            assert_eq!(codes(&edges, left), wanted);
            assert!(edges.iter().all(|(_, pin, _)| *pin == left.pin));
        }
    }

    #[test]
    fn a_beam_that_is_met_half_way_through_waits_for_its_next_turn() {
        let (mut beams, left) = beams();
        let mut edges = Vec::new();
        for ms in 0..200 {
            let symbols = if ms < 10 { 0 } else { home::DOCK_LEFT };
            beams.pass_ms(ms * CYCLES_PER_MS, [symbols, 0, 0, 0], &mut edges);
        }
        assert_eq!(codes(&edges, left), [72]);
    }
}
