//! Calibration of a robot by a client: where the procedure stands, and what was measured.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// What a page of the procedure shows. Each update is whole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CalibrationPage {
    /// Counts up with each question. An answer names it, so that a late one answers nothing else.
    pub page: u32,
    /// What it waits for; absent while it measures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asks: Option<CalibrationAsk>,
    /// Name of the value.
    #[serde(default)]
    pub value: String,
    /// Its unit; `1` for a plain number.
    #[serde(default)]
    pub unit: String,
    /// Its number among those that are measured, from 1; 0 before the first.
    #[serde(default)]
    pub number: u32,
    /// How many those are.
    #[serde(default)]
    pub of: u32,
    /// What was kept before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<i64>,
    /// What was found, while it asks whether to keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<i64>,
    /// What a person does or reads off: `push`, `spin`, `roll-left`, `roll-right`, `light-floor`, `dark-floor`, `drop`, `free-front`,
    /// `paper`, `hold-wheel-read`, `hold-wheel`; `distance-mm`, `at-rest-ma`, `pulled-ma`, `pack-mv`, `room-dc`, `value`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// Which of the sensors the paper is held against, from the right, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<u32>,
    /// What moves by itself: `moves`, `pulls`, `brush`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub danger: Option<String>,
    /// Newest reading, counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reading: Option<i64>,
    /// Share of the readings that are taken, 0..=100.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub percent: Option<u8>,
    /// Counts of both wheels since the step began, left and right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts: Option<[i64; 2]>,
    /// Duty that is tried, permille.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub permille: Option<i32>,
    /// Why the step failed, or why the procedure is over, by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The same in English, with figures.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub text: String,
    /// The procedure is over, and the robot is the daemon's again.
    #[serde(default)]
    pub over: bool,
}

/// What a page waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CalibrationAsk {
    /// Whether the person is ready: `go` or `skip`.
    Ready,
    /// That the person has done it: `go`.
    Done,
    /// A whole number.
    Number,
    /// That the person holds the motors on: [`crate::RequestBody::HoldCalibration`].
    Hold,
    /// Whether the value is kept: `go`, `again` or `skip`.
    Keep,
    /// Whether to try again after a failure: `again` or `skip`.
    Retry,
}

/// How a person answers a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CalibrationAnswer {
    /// Yes, or done.
    Go,
    /// Once more.
    Again,
    /// Leave this value out.
    Skip,
    /// This number.
    Number(i64),
}

/// A value that can be measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CalibrationValue {
    /// Name.
    pub name: String,
    /// Unit of the whole number; `1` for a plain number.
    pub unit: String,
    /// What was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<i64>,
    /// What the firmware takes without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assumed: Option<i64>,
}
