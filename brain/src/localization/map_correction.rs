//! What the map has to do when the robot finds out where it was.

use crate::mapping::Keyframe;

/// A correction of what was drawn up to now.
#[derive(Clone, Debug)]
pub enum MapCorrection {
    /// The map is to be drawn again with better poses of the past.
    Redraw {
        /// Where the robot was.
        keyframes: Vec<Keyframe>,
    },
    /// What was drawn by a robot that was not where it believed to be is to be taken back.
    RollBack {
        /// All that was seen from this time on, microseconds.
        since_us: u64,
        /// Where the robot was before.
        keyframes: Vec<Keyframe>,
    },
}
