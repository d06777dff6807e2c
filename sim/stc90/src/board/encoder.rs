//! Encoders with one line: it changes its level at each count, in whichever direction the wheel turns.

use super::CYCLES_PER_MS;
use crate::pins::{Edge, Level, Pin};

/// A wheel's line.
#[derive(Clone, Debug)]
pub(super) struct LineEncoder {
    pin: Pin,
    level: Level,
    exact: f64,
    shown: i32,
}

impl LineEncoder {
    /// At rest at count 0.
    pub(super) fn new(pin: Pin) -> Self {
        Self {
            pin,
            level: Level::High,
            exact: 0.0,
            shown: 0,
        }
    }

    /// Its line.
    pub(super) fn pin(&self) -> Pin {
        self.pin
    }

    /// The level now.
    pub(super) fn level(&self) -> Level {
        self.level
    }

    /// The wheel moves to a position in counts in the millisecond that begins at `from`, and the encoder shows so many; its
    /// edges come at the moments at which whole counts are passed.
    pub(super) fn turn(&mut self, (exact, shown): (f64, i32), from: u64, edges: &mut Vec<Edge>) {
        let count = shown.wrapping_sub(self.shown).unsigned_abs();
        for step in 0..count {
            self.level = Level::of(!self.level.is_high());
            let share = self.share(exact, (step, count));
            edges.push(Edge {
                cycle: from + (share * CYCLES_PER_MS as f64) as u64,
                pin: self.pin,
                level: self.level,
            });
        }
        (self.exact, self.shown) = (exact, shown);
    }

    /// When in the millisecond a step happens, 0..1: where the wheel passes a whole count, or evenly spread if the encoder
    /// shows something else than what the wheel does.
    fn share(&self, exact: f64, (step, count): (u32, u32)) -> f64 {
        let travelled = exact - self.exact;
        let whole = exact.floor() - self.exact.floor();
        if whole.abs() != f64::from(count) || travelled == 0.0 {
            return (f64::from(step) + 0.5) / f64::from(count);
        }
        let boundary = if travelled > 0.0 {
            self.exact.floor() + f64::from(step) + 1.0
        } else {
            self.exact.floor() - f64::from(step)
        };
        ((boundary - self.exact) / travelled).clamp(0.0, 0.999_999)
    }
}

#[cfg(test)]
mod tests {
    use super::LineEncoder;
    use crate::pins::Level;

    #[test]
    fn each_count_is_an_edge_at_its_moment() {
        let pin = "P0.4".parse().unwrap();
        let mut encoder = LineEncoder::new(pin);
        let mut edges = Vec::new();
        encoder.turn((0.75, 0), 0, &mut edges);
        assert_eq!(edges, []);
        encoder.turn((1.25, 1), 5_000, &mut edges);
        // Backward over the same place; the line does not tell.
        encoder.turn((0.75, 2), 10_000, &mut edges);
        let told: Vec<_> = edges.iter().map(|edge| (edge.cycle, edge.level)).collect();
        assert_eq!(told, [(7_500, Level::Low), (12_500, Level::High)]);
    }
}
