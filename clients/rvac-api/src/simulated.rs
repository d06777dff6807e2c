//! What only a simulator can report: the true home, and the true pose of the robot in it.

use alloc::string::String;
use serde::{Deserialize, Serialize};

use crate::{Pose, Rle};

/// The floor plan of a simulated home, in the map frame of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulatedPlan {
    /// Name of the home.
    pub name: String,
    /// Metres per cell.
    pub cell_m: f64,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pose of the lower left corner of cell (0, 0) in the map frame.
    pub origin: Pose,
    /// 0 outside, 1 floor, 2 obstacle, 3 cliff, 4 rug.
    pub cells: Rle,
    /// Pose of the dock in the map frame.
    #[serde(default)]
    pub dock: Option<Pose>,
}

/// Where a simulated robot really is, in its map frame, and how much it really swept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulatedTruth {
    /// True pose.
    pub pose: Pose,
    /// True covered share of the reachable floor, 0..1.
    pub covered: f64,
    /// Violations of the global safety monitor so far.
    pub violations: u32,
    /// Simulated seconds.
    pub sim_s: f64,
}
