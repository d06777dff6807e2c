//! How hard brushes and suction run.

use serde::{Deserialize, Serialize};

/// How hard brushes and suction run while a person drives or in a room, each 0..=1. What a robot lacks is ignored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CleaningPower {
    /// Suction.
    pub suction: f64,
    /// The main brush.
    pub main_brush: f64,
    /// The side brushes.
    pub side_brushes: f64,
}

impl CleaningPower {
    /// As hard as they can.
    pub const FULL: Self = Self {
        suction: 1.0,
        main_brush: 1.0,
        side_brushes: 1.0,
    };
    /// For daily dust, and less to be heard.
    pub const NORMAL: Self = Self {
        suction: 0.7,
        main_brush: 0.8,
        side_brushes: 0.8,
    };
    /// As little as still cleans.
    pub const QUIET: Self = Self {
        suction: 0.4,
        main_brush: 0.6,
        side_brushes: 0.6,
    };
}
