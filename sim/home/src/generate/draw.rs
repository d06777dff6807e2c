//! Random choices of the generator.

use crate::Pcg;

/// Random choices of a home.
pub(super) struct Draw(Pcg);

/// All drawn lengths are multiples of this, metres: the cell of the plans.
const STEP_M: f64 = 0.02;

impl Draw {
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        Self(Pcg::new(seed, stream))
    }

    /// A length within these borders, metres; the lower one when they are in the wrong order.
    pub(super) fn length(&mut self, low_m: f64, high_m: f64) -> f64 {
        let drawn = low_m + self.0.unit() * (high_m - low_m).max(0.0);
        libm::round(drawn / STEP_M) * STEP_M
    }

    /// Any number within these borders.
    pub(super) fn number(&mut self, low: f64, high: f64) -> f64 {
        low + self.0.unit() * (high - low)
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.0.unit() < share
    }

    /// A number below `bound`.
    pub(super) fn below(&mut self, bound: usize) -> usize {
        self.0.below(bound as u32) as usize
    }

    /// One of them; the default of the type when there is none.
    pub(super) fn pick<T: Copy + Default>(&mut self, among: &[T]) -> T {
        let chosen = self.below(among.len());
        among.get(chosen).copied().unwrap_or_default()
    }
}
