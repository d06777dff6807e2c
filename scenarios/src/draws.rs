//! One figure of several runs. A run is a draw: a byte more on the wire makes another one of it, so a bound on a single run holds by
//! chance. The median of several moves little, and the worst may be worse.

use core::ops::RangeInclusive;

use rayon::prelude::*;

/// Bounds on a figure that shall be small.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// On the median.
    pub median: f64,
    /// On the largest.
    pub worst: f64,
}

/// What came of several runs.
#[derive(Clone, Debug)]
pub struct Draws<T = f64> {
    /// By seed.
    values: Vec<T>,
}

impl<T: Send> Draws<T> {
    /// What comes of the run of each seed, on all processors.
    #[must_use]
    pub fn of(seeds: RangeInclusive<u64>, run: impl Fn(u64) -> T + Send + Sync) -> Self {
        let values = seeds.into_par_iter().map(run).collect();
        Self { values }
    }

    /// A figure of each run; infinity for a run that has none.
    #[must_use]
    pub fn map(&self, figure: impl Fn(&T) -> f64) -> Draws {
        let values = self.values.iter().map(figure).collect();
        Draws { values }
    }
}

impl Draws {
    /// The middle one; the larger one of two in the middle.
    #[must_use]
    pub fn median(&self) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    }

    /// How many are below a limit.
    #[must_use]
    pub fn below(&self, limit: f64) -> usize {
        self.values.iter().filter(|value| **value < limit).count()
    }

    /// Asserts that median and worst are within their bounds.
    ///
    /// # Panics
    /// When they are not.
    pub fn assert_within(&self, what: &str, bounds: Bounds) {
        println!("{what}: {:.4?}", self.values);
        let is_within =
            self.median() < bounds.median && self.values.iter().all(|value| *value < bounds.worst);
        assert!(is_within, "{what} by seed: {:?}, {bounds:?}", self.values);
    }
}
