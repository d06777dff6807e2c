//! Robust weight of a range.

/// Squared deviation at which a range loses three quarters of its weight.
const SCALE: f64 = 9.0;

/// Weight of a range that is off by so many standard deviations, of Geman and McClure's kernel: it falls so fast that long stretches
/// of wrong ranges do not pull.
pub(super) fn weight(off: f64) -> f64 {
    let share = SCALE / (SCALE + off * off);
    (share * share).max(1e-9)
}

/// The square of a deviation as that kernel counts it: hardly more than [`SCALE`] for any outlier, so that single ones decide nothing.
pub(super) fn robust_square(off: f64) -> f64 {
    let square = (off * off).min(1e9);
    SCALE * square / (SCALE + square)
}
