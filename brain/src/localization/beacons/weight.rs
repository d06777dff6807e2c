//! How much a range counts.

/// How much a range counts that is off by so many deviations: that of Student's t with three degrees of freedom.
pub(super) fn weight(off: f64) -> f64 {
    4.0 / (3.0 + off * off)
}
