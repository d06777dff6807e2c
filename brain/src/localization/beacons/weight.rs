//! Robust weight of a range.

/// Weight of a range that is off by so many standard deviations, of Student's t with three degrees of freedom.
pub(super) fn weight(off: f64) -> f64 {
    4.0 / (3.0 + off * off)
}
