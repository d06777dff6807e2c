//! Every trial at many phases.

use std::io::{self, Write};

use pic32::board::CYCLES_PER_MS;
use rayon::prelude::*;
use rvac_protocol::message::Inhibit;
use serde::Serialize;

use crate::limits::period_ms;
use crate::scene::OperatingState;
use crate::testbed::{Fixture, Testbed, TestbedError};
use crate::trial::{Trial, TrialOutcome};

/// Robots of each operating state: each with a calibration and a noise of its own, and with another phase between its core
/// and its surroundings.
const ROBOTS_PER_STATE: u64 = 20;

/// Result of one trial at all its phases.
#[derive(Clone, Debug, Serialize)]
pub struct TrialSummary {
    /// Its name in rules.toml.
    pub name: &'static str,
    /// Rule of SAFETY.md.
    pub rule: &'static str,
    /// What happened.
    pub what: &'static str,
    /// Name of the limit.
    pub limit: &'static str,
    /// What an observer adds to it.
    pub allowance: Option<&'static str>,
    /// How often.
    pub phases: usize,
    /// Over how many milliseconds the events were spread.
    pub spread_ms: u32,
    /// Longest reaction, ms; `None` = at least once there was no reaction within the observed time.
    pub worst_ms: Option<f64>,
    /// Mean reaction, ms.
    pub mean_ms: f64,
    /// Limit, ms.
    pub limit_ms: u32,
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

    /// Runs a trial at `phases` moments chosen by `seed`, spread over the longest period of its rule.
    #[must_use]
    pub fn judge(&self, trial: &Trial, phases: usize, seed: u64) -> TrialSummary {
        let spread_ms = period_ms(trial.rule());
        let mut random = home::Pcg::new(seed, 0);
        let mut moments: Vec<u64> = (0..phases)
            .map(|_| (random.unit() * (u64::from(spread_ms) * CYCLES_PER_MS) as f64) as u64)
            .collect();
        let robots = self
            .robots
            .iter()
            .find(|(scene, _)| *scene == trial.scene)
            .map_or(&[][..], |(_, testbeds)| testbeds.as_slice());
        let share = phases.div_ceil(robots.len().max(1)).max(1);
        let outcomes: Vec<TrialOutcome> = moments
            .chunks_mut(share)
            .zip(robots)
            .par_bridge()
            .flat_map_iter(|(moments, testbed)| at_all(trial, testbed, moments))
            .collect();
        TrialSummary::of(trial, spread_ms, &outcomes)
    }
}

/// The trial with one robot, which goes on in its state from one moment to the next.
fn at_all(trial: &Trial, testbed: &Testbed, moments: &mut [u64]) -> Vec<TrialOutcome> {
    moments.sort_unstable();
    let mut testbed = testbed.clone();
    let mut passed_ms = 0;
    let run = |moment: &u64| {
        let at_ms = moment / CYCLES_PER_MS;
        testbed.run(at_ms - passed_ms);
        passed_ms = at_ms;
        trial.run(testbed.clone(), moment % CYCLES_PER_MS)
    };
    moments.iter().map(run).collect()
}

impl TrialSummary {
    fn of(trial: &Trial, spread_ms: u32, outcomes: &[TrialOutcome]) -> Self {
        let reactions: Option<Vec<f64>> = outcomes.iter().map(|outcome| outcome.reaction_ms).collect();
        let known: Vec<f64> = outcomes
            .iter()
            .filter_map(|outcome| outcome.reaction_ms)
            .collect();
        Self {
            name: trial.name,
            rule: trial.rule(),
            what: trial.what,
            limit: trial.limit.name,
            allowance: trial.expected.allowance().map(|allowance| allowance.name),
            phases: outcomes.len(),
            spread_ms,
            worst_ms: reactions.map(|all| all.into_iter().fold(0.0, f64::max)),
            mean_ms: known.iter().sum::<f64>() / known.len().max(1) as f64,
            limit_ms: trial.limit.ms,
            broken: outcomes.iter().filter(|outcome| !trial.is_kept(outcome)).count(),
            violations: outcomes.iter().map(|outcome| outcome.violations).sum(),
            said: outcomes
                .iter()
                .find(|outcome| !trial.is_kept(outcome))
                .map(|outcome| outcome.inhibits.iter().map(Inhibit::name).collect())
                .unwrap_or_default(),
        }
    }

    /// Prints a line for people.
    ///
    /// # Errors
    /// When `out` takes nothing.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        let worst = self
            .worst_ms
            .map_or_else(|| "never".to_owned(), |worst_ms| format!("{worst_ms:.2}"));
        let remark = if self.is_kept() {
            String::new()
        } else {
            format!(
                "  BROKEN {} of {} times, {} breaches; said: {}",
                self.broken,
                self.phases,
                self.violations,
                self.said.join(", ")
            )
        };
        writeln!(
            out,
            "{:<6} {:<28} {worst:>9} {:>9.2} {:>7}  {}{remark}",
            self.rule, self.name, self.mean_ms, self.limit_ms, self.what
        )?;
        out.flush()
    }

    /// Whether the rule held at every phase.
    #[must_use]
    pub const fn is_kept(&self) -> bool {
        self.phases > 0 && self.broken == 0 && self.violations == 0
    }
}
