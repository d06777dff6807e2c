//! A thousand households with faults: random faults from seeds, checked by the safety monitor in every millisecond.
//!
//! A *trial* is one seed: its home, its noise, its faults and their times all follow from the number, so a violation is
//! replayed by its seed. Trials share nothing and run on as many threads as there are cores.

mod draw;
mod homes;
mod rooms;
mod summary;
mod trial;

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use home::{HomeError, RobotModel};
use monitor::Bridges;
use rayon::prelude::*;

use crate::Firmware;
pub use draw::FaultKind;
use homes::Homes;
pub use summary::Summary;
pub use trial::{FaultOutcome, TrialSettings};

/// What all trials have in common: the homes, the model of robot and its firmware.
#[derive(Clone, Debug)]
pub struct FaultCampaign {
    homes: Homes,
    model: RobotModel,
    firmware: Firmware,
    calibration: Calibration,
}

/// Whether firmware and host know the robot that they drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Calibration {
    /// They do.
    #[default]
    True,
    /// Every trial has a robot of its own, which they take for the original.
    Wrong,
}

impl FaultCampaign {
    /// Prepares trials of this model with this firmware.
    ///
    /// # Errors
    /// When one of the project's homes does not suit the model.
    pub fn load(model: RobotModel, firmware: Firmware) -> Result<Self, HomeError> {
        Ok(Self {
            homes: Homes::load(&model)?,
            model,
            firmware,
            calibration: Calibration::True,
        })
    }

    /// The same with another calibration.
    #[must_use]
    pub fn with_calibration(self, calibration: Calibration) -> Self {
        Self { calibration, ..self }
    }

    /// Runs one seed.
    #[must_use]
    pub fn trial(&self, settings: TrialSettings) -> FaultOutcome {
        trial::run(self, settings)
    }
}

/// Runs the trials of all `seeds` for `duration_ms` each. `progress` is called with the number that is done. Outcomes come in the
/// order of their seeds.
pub fn trials(
    campaign: &FaultCampaign,
    (seeds, duration_ms): (Range<u64>, u64),
    progress: &(dyn Fn(u64) + Sync),
) -> Vec<FaultOutcome> {
    let done = AtomicU64::new(0);
    seeds
        .into_par_iter()
        .map(|seed| {
            let outcome = campaign.trial(TrialSettings {
                seed,
                duration_ms,
                bridges: Bridges::Sound,
            });
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            outcome
        })
        .collect()
}
