//! What all runs that the daemon keeps have done together.

use std::collections::BTreeMap;

use rvac_api::{RequestBody, Run};

/// Runs at once: the most that the daemon gives.
const PAGE: u8 = 50;
/// More than a daemon keeps.
const RUNS_MAX: usize = 1_000;

/// Runs by their numbers, so that none counts twice.
#[derive(Clone, Debug, Default)]
pub(crate) struct Totals {
    runs: BTreeMap<u64, Tally>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    moving_s: f64,
    swept_m2: f64,
}

/// The question for the newest runs.
pub(crate) const fn newest() -> RequestBody {
    RequestBody::Runs {
        before: None,
        count: Some(PAGE),
    }
}

impl Totals {
    /// Counts runs; gives the question for older ones, if there are some that nobody has asked for.
    pub(crate) fn take(&mut self, runs: &[Run], more: bool) -> Option<RequestBody> {
        let before = runs.iter().map(|run| run.number).min()?;
        let is_known = self.runs.contains_key(&before);
        for run in runs {
            self.add(run);
        }
        let asks = more && !is_known && self.runs.len() < RUNS_MAX;
        asks.then_some(RequestBody::Runs {
            before: Some(before),
            count: Some(PAGE),
        })
    }

    pub(crate) fn add(&mut self, run: &Run) {
        let tally = Tally {
            moving_s: run.moving_s,
            swept_m2: run.swept_m2,
        };
        self.runs.insert(run.number, tally);
        while self.runs.len() > RUNS_MAX {
            self.runs.pop_first();
        }
    }

    /// Seconds in motion, square metres, and how many.
    pub(crate) fn sums(&self) -> (f64, f64, usize) {
        let sum = |of: fn(&Tally) -> f64| self.runs.values().map(of).sum();
        (sum(|run| run.moving_s), sum(|run| run.swept_m2), self.runs.len())
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{RequestBody, Run, RunAsker, RunJob, RunResult};

    use super::Totals;

    fn run(number: u64) -> Run {
        Run {
            number,
            job: RunJob::Spot,
            by: RunAsker::Button,
            start_s: None,
            end_s: None,
            duration_s: 100.0,
            moving_s: 60.0,
            swept_m2: 2.5,
            share: None,
            path_m: 1.0,
            bumps: 0,
            charge_start: None,
            charge_end: None,
            result: RunResult::Finished,
            reason: "finished".to_owned(),
            text: String::new(),
            stop_count: 0,
            floor: None,
            map: None,
            recordings: Vec::new(),
        }
    }

    #[test]
    fn pages_are_asked_for_until_all_are_known_and_no_run_counts_twice() {
        let mut totals = Totals::default();
        let asked = totals.take(&[run(9), run(8)], true);
        assert_eq!(
            asked,
            Some(RequestBody::Runs {
                before: Some(8),
                count: Some(50)
            })
        );
        assert_eq!(totals.take(&[run(7)], false), None);
        totals.add(&run(10));
        totals.add(&run(10));
        // After a break all begins again, and ends at what is known.
        assert_eq!(totals.take(&[run(10), run(9)], true), None);
        assert_eq!(totals.sums(), (240.0, 10.0, 4));
    }
}
