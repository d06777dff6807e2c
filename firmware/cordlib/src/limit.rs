//! Limits that cannot panic.

/// `value`, but no less than `least` and no more than `most`. `Ord::clamp` panics when the two are the wrong way round, as
/// a nonsensical parameter of a board could make them; here `most` wins.
pub(crate) fn within<T: Ord>(value: T, least: T, most: T) -> T {
    value.max(least).min(most)
}
