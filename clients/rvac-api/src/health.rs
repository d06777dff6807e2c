//! How worn or dirty parts are, by the loads of their motors.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// A part whose motor's current is measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ComponentHealth {
    /// `brush-main`, `wheel-left` or `wheel-right`.
    pub component: String,
    /// `learning`: less than ten minutes of work were measured since the reset, or the robot measures no currents; `fine`; `hard`: 1.4
    /// times the usual load or more; `light`: 0.6 times or less.
    pub verdict: String,
    /// Minutes of work that were measured since the reset.
    pub minutes: u32,
    /// Load of the last ten minutes in amperes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_a: Option<f64>,
    /// Load of the first ten minutes after the reset in amperes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usual_a: Option<f64>,
    /// The first over the second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// What to do about it, for people; empty when there is nothing to do.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub text: String,
}
