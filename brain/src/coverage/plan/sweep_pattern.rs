//! In which way floor is swept.

use crate::model::room_settings::Pattern;

/// How floor is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SweepPattern {
    /// By lanes.
    Lines,
    /// By rings, those along its border first.
    Inwards,
    /// By rings, those in its middle first.
    Outwards,
}

impl From<Pattern> for SweepPattern {
    fn from(pattern: Pattern) -> Self {
        match pattern {
            Pattern::Lines => Self::Lines,
            Pattern::Contour => Self::Inwards,
        }
    }
}
