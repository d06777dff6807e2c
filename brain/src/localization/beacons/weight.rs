//! Robust weight of a range.

/// Squared deviation at which a range loses three quarters of its weight.
const SCALE: f64 = 9.0;

/// Weight of a range that is off by so many standard deviations, of Geman and McClure's kernel: it falls so fast that long stretches
/// of wrong ranges do not pull.
pub(super) fn weight(off: f64) -> f64 {
    let share = SCALE / (SCALE + off * off);
    (share * share).max(1e-9)
}
