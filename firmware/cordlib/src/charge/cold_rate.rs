//! What a cold pack may get.

use crate::rules::charge_phase::{COLDEST_CC, COOL_CC, HYSTERESIS_CC};

/// The current that a pack may get by the least that its temperature can be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ColdRate {
    /// Below 0 °C.
    #[default]
    None,
    /// Below 5 °C: a tenth of the capacity an hour.
    Slow,
    /// Warm enough.
    Full,
}

impl ColdRate {
    pub(super) fn at(self, coldest_cc: i32) -> Self {
        let reaches = |limit_cc: i32, rate: Self| {
            let extra_cc = if self < rate { HYSTERESIS_CC } else { 0 };
            coldest_cc >= limit_cc.saturating_add(extra_cc)
        };
        if reaches(COOL_CC, Self::Full) {
            Self::Full
        } else if reaches(COLDEST_CC, Self::Slow) {
            Self::Slow
        } else {
            Self::None
        }
    }
}
