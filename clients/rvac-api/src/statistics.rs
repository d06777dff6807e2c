//! What all runs since the first one come to.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
use core::cmp::Reverse;
use serde::{Deserialize, Serialize};

/// Sums over every run that was ever kept. They outlive the records of the runs, of which only the newest are kept.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// When the first of the runs began whose start is known, seconds since 1970; absent while none is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since_s: Option<i64>,
    /// How many runs were ordered, by what was asked for: `clean`, `spot`, `dock`.
    pub runs: BTreeMap<String, u64>,
    /// The same by what came of them, named as in [`crate::RunResult`]: `finished`, `stopped`, `gave-up` and so on.
    pub results: BTreeMap<String, u64>,
    /// Named reasons for which runs stopped or waited on their way, with how often.
    pub stops: BTreeMap<String, u64>,
    /// Hours from orders to ends, pauses included.
    pub duration_h: f64,
    /// Hours of it in motion.
    pub moving_h: f64,
    /// Floor that was swept, square metres, by the robot's own estimates.
    pub swept_m2: f64,
    /// Distance driven in runs, kilometres.
    pub path_km: f64,
    /// Bumps.
    pub bumps: u64,
}

impl Statistics {
    /// Reasons of stops with how often, the most frequent first, equal ones by name.
    #[must_use]
    pub fn stops_most_first(&self) -> Vec<(&str, u64)> {
        let stops = self.stops.iter();
        let mut stops: Vec<_> = stops.map(|(reason, count)| (reason.as_str(), *count)).collect();
        stops.sort_by_key(|(_, count)| Reverse(*count));
        stops
    }
}
