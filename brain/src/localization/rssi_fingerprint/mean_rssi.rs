//! Mean signal strength of a beacon.

/// Beacons that are remembered.
pub(super) const BEACONS_MAX: u16 = 32;

/// Mean signal strength of a beacon over a short path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::localization) struct MeanRssi {
    pub(in crate::localization) beacon: u16,
    pub(in crate::localization) dbm: f64,
}
