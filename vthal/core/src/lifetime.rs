//! What all runs come to, as it is stored: JSON of the file `statistics.json`.
//!
//! Runs are counted once each, in the order of their numbers. The sums are kept apart from the records of the runs, of which the oldest
//! are removed.

use std::collections::BTreeMap;

use rvac_api::{Run, RunJob, Statistics};
use serde::{Deserialize, Serialize};

use crate::stored_version::OtherVersion;

const VERSION: u32 = 1;
/// Different names that are counted of one kind; the catalogue of reasons has fewer.
const NAMES_MAX: usize = 200;
const SECONDS_PER_HOUR: f64 = 3_600.0;
const METRES_PER_KILOMETRE: f64 = 1_000.0;

/// The sums, and which runs are in them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lifetime {
    /// Number of the newest run that is counted, 0 if none is.
    newest: u64,
    statistics: Statistics,
}

impl Lifetime {
    /// Number of the newest run that is counted, 0 if none is.
    #[must_use]
    pub const fn newest(&self) -> u64 {
        self.newest
    }

    /// The sums.
    #[must_use]
    pub const fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Counts a run with the named reasons of its stops. `false` when it was counted before.
    pub fn count<'stop>(&mut self, run: &Run, stops: impl IntoIterator<Item = &'stop str>) -> bool {
        if run.number <= self.newest {
            return false;
        }
        self.newest = run.number;
        let sums = &mut self.statistics;
        let earlier = |since_s: i64| run.start_s.map_or(since_s, |start_s| since_s.min(start_s));
        sums.since_s = sums.since_s.map(earlier).or(run.start_s);
        one_more(&mut sums.runs, job_name(&run.job));
        one_more(&mut sums.results, run.result.name());
        for reason in stops {
            one_more(&mut sums.stops, reason);
        }
        add(&mut sums.duration_h, run.duration_s / SECONDS_PER_HOUR);
        add(&mut sums.moving_h, run.moving_s / SECONDS_PER_HOUR);
        add(&mut sums.swept_m2, run.swept_m2);
        add(&mut sums.path_km, run.path_m / METRES_PER_KILOMETRE);
        sums.bumps = sums.bumps.saturating_add(u64::from(run.bumps));
        true
    }
}

/// A figure of a record that makes no sense must not spoil the sum for ever.
fn add(sum: &mut f64, figure: f64) {
    if figure.is_finite() && figure >= 0.0 {
        *sum += figure;
    }
}

fn one_more(counts: &mut BTreeMap<String, u64>, name: &str) {
    if let Some(count) = counts.get_mut(name) {
        *count = count.saturating_add(1);
    } else if counts.len() < NAMES_MAX {
        counts.insert(name.to_owned(), 1);
    }
}

const fn job_name(job: &RunJob) -> &'static str {
    match job {
        RunJob::Clean { .. } => "clean",
        RunJob::Spot => "spot",
        RunJob::GoTo => "go-to",
        RunJob::Dock => "dock",
    }
}

/// Version, newest run and sums.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredLifetime {
    version: u32,
    newest: u64,
    statistics: Statistics,
}

/// Why what was kept cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LifetimeError {
    /// Of another daemon.
    #[error(transparent)]
    Version(#[from] OtherVersion),
    /// No robot has cleaned so much or so little.
    #[error("the sum of {0} cannot be: it is 0 or more")]
    Sum(&'static str),
    /// More than this daemon counts.
    #[error("it counts {0} different names, and there are at most {NAMES_MAX} of a kind")]
    Names(usize),
}

impl From<&Lifetime> for StoredLifetime {
    fn from(lifetime: &Lifetime) -> Self {
        Self {
            version: VERSION,
            newest: lifetime.newest,
            statistics: lifetime.statistics.clone(),
        }
    }
}

impl TryFrom<StoredLifetime> for Lifetime {
    type Error = LifetimeError;

    fn try_from(stored: StoredLifetime) -> Result<Self, LifetimeError> {
        OtherVersion::expect(stored.version, VERSION)?;
        let sums = &stored.statistics;
        let figures = [
            ("the hours", sums.duration_h),
            ("the hours in motion", sums.moving_h),
            ("the floor", sums.swept_m2),
            ("the distance", sums.path_km),
        ];
        let wrong = figures
            .into_iter()
            .find(|(_, sum)| !sum.is_finite() || *sum < 0.0);
        if let Some((what, _)) = wrong {
            return Err(LifetimeError::Sum(what));
        }
        let names = [&sums.runs, &sums.results, &sums.stops].map(BTreeMap::len);
        if let Some(count) = names.into_iter().find(|count| *count > NAMES_MAX) {
            return Err(LifetimeError::Names(count));
        }
        Ok(Self {
            newest: stored.newest,
            statistics: stored.statistics,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Lifetime, LifetimeError, NAMES_MAX, StoredLifetime};
    use rvac_api::{Run, RunAsker, RunJob, RunResult};

    fn run(number: u64, start_s: Option<i64>) -> Run {
        Run {
            number,
            job: RunJob::Spot,
            by: RunAsker::Button,
            start_s,
            end_s: None,
            clock_set_s: None,
            duration_s: 5_400.0,
            moving_s: 3_600.0,
            swept_m2: 12.5,
            share: None,
            path_m: 250.0,
            bumps: 7,
            charge_start: None,
            charge_end: None,
            result: RunResult::GaveUp,
            reason: "shut-in".to_owned(),
            text: "Gave up.".to_owned(),
            stop_count: 2,
            floor: None,
            map: None,
            recordings: Vec::new(),
        }
    }

    #[test]
    fn each_run_counts_once_and_the_sums_survive_the_file() {
        let mut lifetime = Lifetime::default();
        assert!(lifetime.count(&run(3, None), ["wheel-drop", "command"]));
        assert!(lifetime.count(&run(4, Some(1_800_000_000)), ["command"]));
        assert!(!lifetime.count(&run(4, Some(5)), ["command"]), "it was counted");
        assert!(
            !lifetime.count(&run(2, Some(5)), []),
            "an older one comes too late"
        );
        let sums = lifetime.statistics();
        assert_eq!((sums.runs["spot"], sums.results["gave-up"]), (2, 2));
        assert_eq!((sums.stops["command"], sums.stops["wheel-drop"]), (2, 1));
        assert_eq!(
            (sums.duration_h, sums.moving_h, sums.swept_m2, sums.path_km),
            (3.0, 2.0, 25.0, 0.5)
        );
        assert_eq!((sums.bumps, sums.since_s), (14, Some(1_800_000_000)));
        assert_eq!(lifetime.newest(), 4);
        assert_eq!(Lifetime::try_from(StoredLifetime::from(&lifetime)), Ok(lifetime));
    }

    #[test]
    fn a_record_that_makes_no_sense_spoils_no_sum() {
        let mut lifetime = Lifetime::default();
        let mut strange = run(1, None);
        (strange.swept_m2, strange.path_m) = (f64::NAN, -5.0);
        lifetime.count(&strange, []);
        let sums = lifetime.statistics();
        assert_eq!((sums.swept_m2, sums.path_km, sums.moving_h), (0.0, 0.0, 1.0));
        let names: Vec<String> = (0..=NAMES_MAX).map(|number| number.to_string()).collect();
        lifetime.count(&run(2, None), names.iter().map(String::as_str));
        assert_eq!(lifetime.statistics().stops.len(), NAMES_MAX);
        assert!(Lifetime::try_from(StoredLifetime::from(&lifetime)).is_ok());
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let mut stored = StoredLifetime::from(&Lifetime::default());
        stored.statistics.path_km = -1.0;
        assert_eq!(
            Lifetime::try_from(stored.clone()),
            Err(LifetimeError::Sum("the distance"))
        );
        stored.version = 2;
        assert!(matches!(
            Lifetime::try_from(stored),
            Err(LifetimeError::Version(_))
        ));
    }
}
