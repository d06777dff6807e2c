//! Clamping that cannot panic.

/// Clamps `value` between `least` and `most`. `Ord::clamp` panics if `least` exceeds `most`, which a nonsensical board
/// parameter could cause; here `most` wins.
pub(crate) fn within<T: Ord>(value: T, least: T, most: T) -> T {
    value.max(least).min(most)
}
