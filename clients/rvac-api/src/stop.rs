//! Why the robot stopped by itself, with what its sensors reported before and what it tried.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{Decision, Pose};

/// The robot waits, or gave up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Standstill {
    /// Rising number since the daemon's start, from 1.
    pub number: u64,
    /// Seconds since the daemon's start.
    pub t: f64,
    /// State, as in [`crate::Status::state`].
    pub state: String,
    /// Why, by name.
    pub reason: String,
    /// The same as a sentence for people.
    pub text: String,
    /// What to do about it; absent when there is nothing to do, and from older daemons.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub remedy: String,
    /// The estimated pose.
    pub place: Pose,
    /// It did not know where it was.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub lost: bool,
    /// What its sensors reported and what it tried before.
    #[serde(flatten)]
    pub evidence: Evidence,
}

/// What the sensors reported in the last ten seconds, and what the robot tried in the last half minute.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// Five a second, oldest first.
    #[serde(default, rename = "felt", skip_serializing_if = "Vec::is_empty")]
    pub samples: Vec<EvidenceSample>,
    /// Decisions, oldest first; twelve at most.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tried: Vec<Decision>,
}

impl Evidence {
    /// Whether it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty() && self.tried.is_empty()
    }
}

/// A fifth of a second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EvidenceSample {
    /// Its end in seconds before the moment that is explained: -10..=0.
    pub at_s: f64,
    /// Speed by the wheels' counts, m/s.
    pub v: f64,
    /// Turn rate by gyro, or by the wheels' counts where there is none, rad/s, counter-clockwise positive.
    pub w: f64,
    /// Contacts and alarms during it, by name: `bumper-left`, `cliff-front`, `wheel-drop`, `link-lost`, `docked` and the names of
    /// what kept the firmware from moving.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signs: Vec<String>,
    /// Strongest echo of the sensors at the front and the sides, 0 (nothing) to 1. Only of robots that have some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub echo: Option<f32>,
    /// Motor currents in amperes: left wheel, right wheel, main brush. Only of robots that measure them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub currents_a: Option<[f32; 3]>,
}
