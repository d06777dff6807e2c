//! Progress of a job: the share of its floor that is swept.

/// Share of the job's known floor that is swept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SweptShare {
    /// Best estimate, 0..=1.
    pub share: f64,
    /// Lower estimate: with twice the present pose uncertainty.
    pub share_low: f64,
    /// Unswept floor, square metres.
    pub left_m2: f64,
}
