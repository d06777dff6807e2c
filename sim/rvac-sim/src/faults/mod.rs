//! A thousand households in trouble: random faults from seeds, the safety monitor in every millisecond.
//!
//! A *trial* is one seed: its home, its noise, its faults and their times all follow from the number, so a violation is
//! replayed by naming it. Trials share nothing and run on as many threads as there are cores.

mod draw;
mod homes;
mod rooms;
mod summary;
mod trial;

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use home::{HomeError, RobotModel};
use monitor::Bridges;

use crate::Firmware;
pub use draw::FaultKind;
use homes::Homes;
pub use summary::Summary;
pub use trial::{Outcome, TrialSettings};

/// What all trials have in common: the homes, the model of robot and its firmware.
#[derive(Clone, Debug)]
pub struct Campaign {
    homes: Homes,
    model: RobotModel,
    firmware: Firmware,
}

impl Campaign {
    /// Prepares trials of this model with this firmware.
    ///
    /// # Errors
    /// When one of the project's homes does not suit the model.
    pub fn load(model: RobotModel, firmware: Firmware) -> Result<Self, HomeError> {
        Ok(Self {
            homes: Homes::load(&model)?,
            model,
            firmware,
        })
    }

    /// Runs one seed.
    #[must_use]
    pub fn trial(&self, settings: TrialSettings) -> Outcome {
        trial::run(self, settings)
    }
}

/// Runs the trials of all `seeds` for `duration_ms` each. `progress` is told how many are done. Outcomes come in the order
/// of their seeds.
pub fn trials(
    campaign: &Campaign,
    (seeds, duration_ms): (Range<u64>, u64),
    progress: &(dyn Fn(u64) + Sync),
) -> Vec<Outcome> {
    let next = AtomicU64::new(seeds.start);
    let done = AtomicU64::new(0);
    let outcomes = Mutex::new(Vec::new());
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end {
                return;
            }
            let settings = TrialSettings {
                seed,
                duration_ms,
                bridges: Bridges::Sound,
            };
            let outcome = campaign.trial(settings);
            outcomes
                .lock()
                .expect("no trial panics while it holds the list")
                .push(outcome);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        }
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(work);
        }
    });
    let mut outcomes = outcomes.into_inner().expect("all threads have ended well");
    outcomes.sort_by_key(|outcome| outcome.seed);
    outcomes
}
