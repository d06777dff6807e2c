//! Encoders: two lines a wheel in quadrature, and the pulses of the main brush.

use super::CYCLES_PER_MS;
use super::wiring::DigitalLine;
use crate::pins::{Level, Pin};

/// An edge that is to come: cycle, pin, level after it.
pub(super) type ScheduledEdge = (u64, Pin, Level);

/// Position of a wheel's encoder in counts: true and shown. They differ permanently after a sensor fault.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Position {
    pub(super) exact: f64,
    pub(super) shown: i32,
}

/// Two encoder lines. Rolling forward, line 1 leads, or line 2 if they are swapped.
#[derive(Clone, Debug)]
pub(super) struct Encoder {
    lines: [Pin; 2],
    before: Position,
}

/// Levels of the leading and the following line at count 0, 1, 2, 3.
const QUADRATURE: [[bool; 2]; 4] = [[false, false], [true, false], [true, true], [false, true]];

impl Encoder {
    /// Lines at count 0; `swapped` = line 2 leads.
    pub(super) fn new(lines: [Pin; 2], swapped: bool) -> Self {
        let [first, second] = lines;
        Self {
            lines: if swapped { [second, first] } else { [first, second] },
            before: Position::default(),
        }
    }

    /// The levels now, as edges at `cycle`.
    pub(super) fn levels(&self, cycle: u64) -> [ScheduledEdge; 2] {
        let levels = QUADRATURE[self.before.shown.rem_euclid(4) as usize];
        [0, 1].map(|line| (cycle, self.lines[line], Level::of(levels[line])))
    }

    /// The wheel moves to `after` in the millisecond that begins at `from`; its edges come at the moments at which
    /// whole counts are passed.
    pub(super) fn turn(&mut self, after: Position, from: u64, edges: &mut Vec<ScheduledEdge>) {
        let steps = after.shown.wrapping_sub(self.before.shown);
        let forward = steps >= 0;
        let count = steps.unsigned_abs();
        for step in 0..count {
            let share = self.share(after, (step, count));
            let number = if forward {
                self.before.shown.wrapping_add(1 + step as i32)
            } else {
                self.before.shown.wrapping_sub(1 + step as i32)
            };
            let (old, new) = (
                QUADRATURE[number.wrapping_sub(steps.signum()).rem_euclid(4) as usize],
                QUADRATURE[number.rem_euclid(4) as usize],
            );
            let line = usize::from(old[0] == new[0]);
            let cycle = from + (share * CYCLES_PER_MS as f64) as u64;
            edges.push((cycle, self.lines[line], Level::of(new[line])));
        }
        self.before = after;
    }

    /// When in the millisecond the step happens, 0..1: where the wheel passes a whole count, or evenly spread if the
    /// encoder shows something else than what the wheel does.
    fn share(&self, after: Position, (step, count): (u32, u32)) -> f64 {
        let travelled = after.exact - self.before.exact;
        let whole = after.exact.floor() - self.before.exact.floor();
        if whole.abs() != f64::from(count) || travelled == 0.0 {
            return (f64::from(step) + 0.5) / f64::from(count);
        }
        let boundary = if travelled > 0.0 {
            self.before.exact.floor() + f64::from(step) + 1.0
        } else {
            self.before.exact.floor() - f64::from(step)
        };
        ((boundary - self.before.exact) / travelled).clamp(0.0, 0.999_999)
    }
}

/// The main brush's encoder: as many pulses as the brush turns, half of each with the line on.
#[derive(Clone, Debug)]
pub(super) struct BrushEncoder {
    line: DigitalLine,
    pulses_per_ms: f64,
    /// Half pulses so far.
    halves: f64,
}

/// Share of full drive below which the brush does not turn. The tests do not depend on it, so it is not a parameter.
const BRUSH_DEAD_BAND: f64 = 0.15;

impl BrushEncoder {
    pub(super) fn new(line: DigitalLine, pulses_per_s: f64) -> Self {
        Self {
            line,
            pulses_per_ms: pulses_per_s / 1000.0,
            halves: 0.0,
        }
    }

    /// The level now, as an edge at `cycle`.
    pub(super) fn level(&self, cycle: u64) -> ScheduledEdge {
        (cycle, self.line.pin, self.line.level(self.is_on()))
    }

    fn is_on(&self) -> bool {
        self.halves as u64 % 2 == 1
    }

    /// The brush is driven with this mean duty for the millisecond that begins at `from`.
    pub(super) fn turn(&mut self, duty: f64, from: u64, edges: &mut Vec<ScheduledEdge>) {
        let turning = (duty.abs() - BRUSH_DEAD_BAND).max(0.0) / (1.0 - BRUSH_DEAD_BAND);
        let step = 2.0 * self.pulses_per_ms * turning;
        let before = self.halves;
        let mut next = before.floor() + 1.0;
        while next <= before + step {
            self.halves = next;
            let share = ((next - before) / step).min(0.999_999);
            let cycle = from + (share * CYCLES_PER_MS as f64) as u64;
            edges.push(self.level(cycle));
            next += 1.0;
        }
        self.halves = before + step;
    }
}

#[cfg(test)]
mod tests {
    use super::{BrushEncoder, Encoder, Position, ScheduledEdge};
    use crate::board::wiring::DigitalLine;
    use crate::pins::{Level, Pin};

    fn pin(name: &str) -> Pin {
        name.parse().unwrap()
    }

    fn encoder(swapped: bool) -> Encoder {
        Encoder::new([pin("RD8"), pin("RD9")], swapped)
    }

    /// Counts as a firmware does: line 1 leading is up.
    fn decode(edges: &[ScheduledEdge]) -> i32 {
        let order = [0b00, 0b01, 0b11, 0b10];
        let (mut levels, mut total) = (0, 0);
        for (_, line, level) in edges {
            let bit = if *line == pin("RD8") { 1 } else { 2 };
            let next = if level.is_high() {
                levels | bit
            } else {
                levels & !bit
            };
            let place = |levels: i32| order.iter().position(|known| *known == levels).unwrap() as i32;
            let step = (place(next) - place(levels)).rem_euclid(4);
            assert!(step == 1 || step == 3, "one line at a time");
            total += if step == 1 { 1 } else { -1 };
            levels = next;
        }
        total
    }

    #[test]
    fn counts_become_quadrature_in_both_directions() {
        for swapped in [false, true] {
            let mut encoder = encoder(swapped);
            let mut edges = Vec::new();
            for (ms, exact) in [2.3, 5.9, 5.95, 3.1, -4.2, -4.9].into_iter().enumerate() {
                let position = Position {
                    exact,
                    shown: f64::floor(exact) as i32,
                };
                encoder.turn(position, ms as u64 * 80_000, &mut edges);
            }
            let wanted = if swapped { 5 } else { -5 };
            assert_eq!(decode(&edges), wanted);
            assert!(edges.is_sorted_by_key(|(cycle, ..)| *cycle));
        }
    }

    #[test]
    fn edges_come_where_whole_counts_are_passed() {
        let mut encoder = encoder(false);
        let mut edges = Vec::new();
        let at = |exact: f64| Position {
            exact,
            shown: exact.floor() as i32,
        };
        encoder.turn(at(0.5), 0, &mut edges);
        encoder.turn(at(2.5), 80_000, &mut edges);
        let cycles: Vec<u64> = edges.iter().map(|(cycle, ..)| *cycle).collect();
        assert_eq!(cycles, [100_000, 140_000]);
    }

    #[test]
    fn an_encoder_that_lies_spreads_its_edges() {
        let mut encoder = encoder(false);
        let mut edges = Vec::new();
        encoder.turn(Position { exact: 0.9, shown: 4 }, 0, &mut edges);
        let cycles: Vec<u64> = edges.iter().map(|(cycle, ..)| *cycle).collect();
        assert_eq!(cycles, [10_000, 30_000, 50_000, 70_000]);
    }

    #[test]
    fn a_brush_at_full_drive_gives_its_pulses() {
        let line = DigitalLine {
            pin: pin("RB5"),
            active: Level::Low,
        };
        let mut brush = BrushEncoder::new(line, 100.0);
        let mut edges = Vec::new();
        for ms in 0..1000 {
            brush.turn(1.0, ms * 80_000, &mut edges);
        }
        let falling = edges.iter().filter(|(.., level)| !level.is_high()).count();
        assert!((99..=100).contains(&falling), "{falling}");
        let driven = edges.len();
        for ms in 1000..2000 {
            brush.turn(0.1, ms * 80_000, &mut edges);
        }
        assert_eq!(edges.len(), driven, "below the dead band it stands");
    }
}
