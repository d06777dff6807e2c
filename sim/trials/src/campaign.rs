//! Every trial at many phases.

use pic32::board::CYCLES_PER_MS;
use rayon::prelude::*;
use rvac_protocol::message::Inhibit;
use serde::Serialize;

use crate::testbed::{Fixture, Testbed, TestbedError};
use crate::trial::{OperatingState, Trial, TrialOutcome};

/// Robots of each operating state: each with another phase between its core and its surroundings.
const ROBOTS_PER_STATE: u64 = 8;
/// An event comes within this many milliseconds: more than all periods of the firmware.
const SPREAD_MS: u64 = 100;

/// Result of one trial at all its phases.
#[derive(Clone, Debug, Serialize)]
pub struct TrialSummary {
    /// Rule of SAFETY.md.
    pub rule: &'static str,
    /// What happened.
    pub what: &'static str,
    /// How often.
    pub phases: usize,
    /// Longest reaction, ms; `None` = at least once there was no reaction within the observed time.
    pub worst_ms: Option<f64>,
    /// Mean reaction, ms.
    pub mean_ms: f64,
    /// Limit, ms.
    pub limit_ms: u64,
    /// Times that it was too late, or the robot did not report what it had to.
    pub broken: usize,
    /// Breaches that the monitor saw, in all phases together.
    pub violations: usize,
    /// Inhibits that the robot reported at the end of the first broken one.
    pub said: Vec<&'static str>,
}

/// Robots in all operating states that the trials need.
#[derive(Debug)]
pub struct Campaign {
    robots: Vec<(OperatingState, Vec<Testbed>)>,
}

impl Campaign {
    /// Brings robots into the operating states of `trials`.
    ///
    /// # Errors
    /// When one does not reach its state.
    pub fn open(fixture: &Fixture, trials: &[Trial], phases: usize) -> Result<Self, TestbedError> {
        let size = ROBOTS_PER_STATE.min(phases as u64).max(1);
        let wanted = |scene: &OperatingState| trials.iter().any(|trial| trial.scene == *scene);
        let cast = |scene: OperatingState| -> Result<_, TestbedError> {
            let testbeds = (0..size)
                .into_par_iter()
                .map(|number| scene.set(fixture, number + 1, number * CYCLES_PER_MS / size))
                .collect::<Result<_, _>>()?;
            Ok((scene, testbeds))
        };
        let robots = OperatingState::ALL.into_iter().filter(wanted).map(cast);
        Ok(Self {
            robots: robots.collect::<Result<_, _>>()?,
        })
    }

    /// Runs a trial at `phases` moments chosen by `seed`.
    #[must_use]
    pub fn judge(&self, trial: &Trial, phases: usize, seed: u64) -> TrialSummary {
        let mut random = home::Pcg::new(seed, 0);
        let testbeds = self
            .robots
            .iter()
            .find(|(scene, _)| *scene == trial.scene)
            .map_or(&[][..], |(_, testbeds)| testbeds.as_slice());
        let mut phase = || (random.unit() * (SPREAD_MS * CYCLES_PER_MS) as f64) as u64;
        let moments: Vec<(&Testbed, u64)> = testbeds
            .iter()
            .cycle()
            .take(phases)
            .map(|testbed| (testbed, phase()))
            .collect();
        let outcomes: Vec<TrialOutcome> = moments
            .into_par_iter()
            .map(|(testbed, phase)| trial.run(testbed.clone(), phase))
            .collect();
        TrialSummary::of(trial, &outcomes)
    }
}

impl TrialSummary {
    fn of(trial: &Trial, outcomes: &[TrialOutcome]) -> Self {
        let reactions: Option<Vec<f64>> = outcomes.iter().map(|outcome| outcome.reaction_ms).collect();
        let known: Vec<f64> = outcomes
            .iter()
            .filter_map(|outcome| outcome.reaction_ms)
            .collect();
        Self {
            rule: trial.rule,
            what: trial.what,
            phases: outcomes.len(),
            worst_ms: reactions.map(|all| all.into_iter().fold(0.0, f64::max)),
            mean_ms: known.iter().sum::<f64>() / known.len().max(1) as f64,
            limit_ms: trial.limit_ms,
            broken: outcomes.iter().filter(|outcome| !trial.is_kept(outcome)).count(),
            violations: outcomes.iter().map(|outcome| outcome.violations).sum(),
            said: outcomes
                .iter()
                .find(|outcome| !trial.is_kept(outcome))
                .map(|outcome| outcome.inhibits.iter().map(Inhibit::name).collect())
                .unwrap_or_default(),
        }
    }

    /// Whether the rule held at every phase.
    #[must_use]
    pub const fn is_kept(&self) -> bool {
        self.phases > 0 && self.broken == 0 && self.violations == 0
    }
}
