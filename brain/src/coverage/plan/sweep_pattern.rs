//! The pattern in which floor is swept.

use crate::model::room_settings::Pattern;

/// How floor is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SweepPattern {
    /// By lanes.
    Lines,
    /// By rings, the outermost first.
    Inwards,
    /// By rings, the innermost first.
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
