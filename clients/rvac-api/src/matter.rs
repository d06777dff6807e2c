//! The code by which a home lets the robot in by Matter.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// What `rvac-matter` tells the panel's server, for administrators.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MatterInvitation {
    /// Text of the QR code, while a home can join.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub code: Option<String>,
    /// The same as digits that people type.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digits: Option<String>,
    /// Seconds for which a home can join still.
    pub open_s: u32,
    /// It has joined a home.
    pub joined: bool,
}
