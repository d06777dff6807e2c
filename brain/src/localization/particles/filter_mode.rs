//! Whether the filter searches for the pose or tracks it.

/// How particles treat the sensor readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::localization) enum FilterMode {
    /// The robot may be elsewhere: particles are spread, and readings of a surface count independently.
    Searching,
    /// The pose is known: particles keep their headings, and remember the reflectance of the surfaces that they see.
    Holding,
}
