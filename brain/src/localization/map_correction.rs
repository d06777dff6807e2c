//! Corrections of the map when past poses turn out to be wrong.

use crate::mapping::Keyframe;

/// A correction of what was drawn so far.
#[derive(Clone, Debug)]
pub enum MapCorrection {
    /// Redraw the map with better past poses.
    Redraw {
        /// The corrected poses.
        keyframes: Vec<Keyframe>,
    },
    /// Roll back what was drawn at a wrong pose.
    RollBack {
        /// Everything seen from this time on, microseconds.
        since_us: u64,
        /// The poses before that time.
        keyframes: Vec<Keyframe>,
    },
}
