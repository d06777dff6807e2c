//! How strongly a beacon is received.

/// Beacons that are remembered.
pub(super) const BEACONS_MAX: u16 = 32;

/// Mean strength of a beacon on a short way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::localization) struct MeanRssi {
    pub(in crate::localization) beacon: u16,
    pub(in crate::localization) dbm: f64,
}
