//! The one JSON object that a run without a browser ends with.

use serde::{Deserialize, Serialize};

/// What a run came to. The simulator writes the same object; the keys are a promise to scripts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DemoReport {
    /// Floor plan.
    pub(crate) home: String,
    /// Floor without obstacles, in square metres.
    pub(crate) free_area_m2: f64,
    /// Floor that the robot's body can come over, in square metres.
    pub(crate) reachable_area_m2: f64,
    /// Share of the reachable floor that was swept, 0..1.
    pub(crate) covered: f64,
    /// Lower bound of the time to sweep it all: reachable area over swath times speed, in seconds.
    pub(crate) t0_s: f64,
    /// True way in metres.
    pub(crate) path_m: f64,
    /// Contacts.
    pub(crate) bumps: u32,
    /// How often the robot was stuck.
    pub(crate) stuck: u32,
    /// Violations of the global safety monitor.
    pub(crate) monitor_violations: u64,
    /// Distance between the believed and the true pose, in metres.
    pub(crate) pose_rmse_m: f64,
    /// Simulated seconds.
    pub(crate) sim_seconds: f64,
    /// Seconds on the wall.
    pub(crate) wall_seconds: f64,
}

impl DemoReport {
    /// Why the run counts as failed; `None` when it does not.
    pub(crate) fn failure(&self) -> Option<String> {
        if self.monitor_violations > 0 {
            return Some(format!(
                "the safety monitor saw {} violations",
                self.monitor_violations
            ));
        }
        (self.path_m <= 0.0).then(|| "the robot did not move".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::DemoReport;

    fn report(violations: u64, path_m: f64) -> DemoReport {
        DemoReport {
            home: "flat".to_owned(),
            free_area_m2: 1.0,
            reachable_area_m2: 1.0,
            covered: 0.5,
            t0_s: 1.0,
            path_m,
            bumps: 0,
            stuck: 0,
            monitor_violations: violations,
            pose_rmse_m: 0.0,
            sim_seconds: 1.0,
            wall_seconds: 1.0,
        }
    }

    #[test]
    fn only_a_run_that_moved_and_violated_nothing_succeeds() {
        assert_eq!(report(0, 1.0).failure(), None);
        assert!(report(1, 1.0).failure().is_some());
        assert!(report(0, 0.0).failure().is_some());
    }
}
