//! Random choices of a day.

use home::Pcg;

use super::shape::Point;

/// Draws.
pub(super) struct Draw(pub(super) Pcg);

impl Draw {
    /// Below `bound`; 0 when that is 0.
    pub(super) fn below(&mut self, bound: usize) -> usize {
        self.0.below(u32::try_from(bound).unwrap_or(u32::MAX)) as usize
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }

    pub(super) fn is_lucky(&mut self, chance: f64) -> bool {
        self.0.unit() < chance
    }

    /// A step of a length in between, in any direction.
    pub(super) fn step(&mut self, low_m: f64, high_m: f64) -> Point {
        let (length_m, direction_rad) = (
            self.between(low_m, high_m),
            self.between(0.0, core::f64::consts::TAU),
        );
        [length_m * direction_rad.cos(), length_m * direction_rad.sin()]
    }

    /// One of some.
    pub(super) fn pick<T: Copy>(&mut self, some: &[T]) -> Option<T> {
        some.get(self.below(some.len())).copied()
    }
}
