//! How long answers took.

/// Delays, milliseconds.
#[derive(Clone, Copy, Debug)]
pub struct Delays {
    /// In the middle.
    pub median: f64,
    /// Of a hundred one took longer.
    pub p99: f64,
    /// The longest.
    pub most: f64,
}

impl Delays {
    /// Of these; none of none.
    pub fn of(mut delays_ms: Vec<f64>) -> Option<Self> {
        delays_ms.sort_by(f64::total_cmp);
        let rank = |share: f64| delays_ms.get((delays_ms.len() as f64 * share) as usize).copied();
        Some(Self {
            median: rank(0.5)?,
            p99: rank(0.99)?,
            most: *delays_ms.last()?,
        })
    }
}
