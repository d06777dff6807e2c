//! One run of a life.

use rvac_sim::RunReport;
use serde::Serialize;

/// The figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LifeRun {
    /// Seed of the chain.
    pub seed: u64,
    /// Which run of the chain it was, from 1.
    pub run: u32,
    /// Bytes of the newest map on the disk; `null` = none was kept.
    pub map_bytes: Option<usize>,
    /// The figures.
    #[serde(flatten)]
    pub report: RunReport,
    /// Times of this machine; left out unless requested, since they differ from run to run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timing: Option<LifeTiming>,
}

/// Times of this machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LifeTiming {
    /// Longest step of the daemon's core before the job began, milliseconds: what was kept is loaded then.
    pub load_step_max_ms: f64,
    /// Longest step while the job ran.
    pub job_step_max_ms: f64,
    /// Longest step after the job: the map is finished and handed to the store then.
    pub save_step_max_ms: f64,
    /// The step that ends the daemon, which writes the map down at once: nobody waits for it.
    pub shutdown_ms: f64,
    /// Reading the state folder at the start, milliseconds.
    pub read_ms: f64,
    /// Longest write to the state folder, milliseconds.
    pub write_max_ms: f64,
    /// Simulated time over time on the wall.
    pub times_real_time: f64,
}
