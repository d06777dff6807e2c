//! Whether the filter looks for the robot or holds on to it.

/// What guesses make of what they see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::localization) enum FilterMode {
    /// The robot may be elsewhere: guesses are spread, and each look at a surface counts by itself.
    Searching,
    /// The robot knows where it is: guesses hold headings, and know surfaces again that they have looked at.
    Holding,
}
