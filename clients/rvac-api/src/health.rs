//! How worn or dirty parts are: by the loads of their motors where these are measured, else by hours of work.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// A part whose motor's current is measured, or whose hours are counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ComponentHealth {
    /// `brush-main`, `wheel-left`, `wheel-right`, `brush-sides`, `filter` or `sensors`.
    pub component: String,
    /// `learning`: less than ten minutes of work were measured since the reset, or the robot measures no currents; `fine`; `hard`: 1.4
    /// times the usual load or more; `light`: 0.6 times or less; `unmeasured`: nothing but hours is known of it.
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
    /// Its hours of work, if it is one that is replaced or cleaned after hours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hours: Option<PartHours>,
    /// What to do about it, for people; empty when there is nothing to do.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub text: String,
}

/// How long a part has worked since somebody replaced or cleaned it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartHours {
    /// Hours of work: those in which its motor ran, or for `sensors` those in which the robot cleaned.
    pub worked_h: f64,
    /// Hours of work after which people commonly see to such a part. A habit, no measurement.
    pub usual_h: f64,
    /// What is done then.
    pub care: PartCare,
    /// When that was done last, seconds since 1970; absent = never, or with a clock that was not set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since_s: Option<i64>,
    /// Hours that it had before that: the word that it was done can be taken back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before_h: Option<f64>,
}

impl PartHours {
    /// It has worked for as long as such parts usually do.
    #[must_use]
    pub fn is_due(&self) -> bool {
        self.worked_h >= self.usual_h
    }
}

/// What a person does with a part that is due.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PartCare {
    /// Puts in a new one.
    #[default]
    Replace,
    /// Wipes it.
    Clean,
}
