//! One fault of the Relax at one moment, and the expected reaction.

use super::scene::RelaxScene;
use super::testbed::RelaxTestbed;
use crate::campaign::TrialSummary;
use crate::limits::{self, Limit};
use crate::trial::{Expectation, MotorGroup};
use home::Pcg;
use rayon::prelude::*;
use rvac_protocol::message::Inhibit;
use stc90::board::{CYCLES_PER_MS, Motor};
use stc90::hosted::{HostedBlueprint, HostedError};

/// Observation time after the limit, so that a late reaction is measured.
const AFTER_MS: u64 = 150;
/// Events are spread over the longest period of what implements a rule.
const SPREAD_MS: u32 = 1_000;
/// The host finds its robot so soon after a reset: the check of the flash, and the handshake.
const RECONNECT_MS: u64 = limits::RECONNECT_MS as u64;

/// Makes the fault happen at this cycle, which lies within the next millisecond, and returns the cycle from which the
/// reaction counts. What can only happen between two milliseconds happens at once.
pub(super) type RelaxEvent = fn(&mut RelaxTestbed, u64) -> u64;

/// A fault and the expected reaction.
#[derive(Clone, Copy, Debug)]
pub struct RelaxTrial {
    /// Its name, that of the SR8730's trial where there is one.
    pub name: &'static str,
    /// What happens.
    pub what: &'static str,
    pub(super) scene: RelaxScene,
    pub(super) event: RelaxEvent,
    /// The expected reaction.
    pub expected: Expectation,
    /// In which time.
    pub limit: Limit,
    /// Longer observation than the limit asks for, ms.
    pub(super) watch_ms: u64,
    /// One in so many of the moments is tried, where a trial takes long.
    pub(super) share: usize,
}

/// What came of it.
#[derive(Clone, Debug)]
struct RelaxOutcome {
    reaction_ms: Option<f64>,
    violations: usize,
    is_kept: bool,
    said: Vec<&'static str>,
}

/// Robots in all scenes.
#[derive(Debug)]
pub struct RelaxCampaign {
    robots: Vec<(RelaxScene, RelaxTestbed)>,
}

impl RelaxCampaign {
    /// Brings a robot into each scene.
    ///
    /// # Errors
    /// When one does not get there.
    pub fn open(blueprint: &HostedBlueprint) -> Result<Self, HostedError> {
        let set = |scene: &RelaxScene| Ok((*scene, scene.set(blueprint)?));
        let robots = RelaxScene::ALL.par_iter().map(set);
        Ok(Self {
            robots: robots.collect::<Result<_, HostedError>>()?,
        })
    }

    /// Runs a trial at so many moments that `seed` chooses.
    #[must_use]
    pub fn judge(&self, trial: &RelaxTrial, phases: usize, seed: u64) -> TrialSummary {
        let mut random = Pcg::new(seed, 0);
        let count = phases.div_ceil(trial.share);
        let span = f64::from(SPREAD_MS) * CYCLES_PER_MS as f64;
        let moments: Vec<u64> = (0..count).map(|_| (random.unit() * span) as u64).collect();
        let robot = self.robots.iter().find(|(scene, _)| *scene == trial.scene);
        let outcomes: Vec<RelaxOutcome> = robot.map_or_else(Vec::new, |(_, testbed)| {
            let run = |moment: &u64| {
                let mut testbed = testbed.clone();
                testbed.run(moment / CYCLES_PER_MS);
                trial.run(testbed, moment % CYCLES_PER_MS)
            };
            moments.par_iter().map(run).collect()
        });
        trial.summary(&outcomes)
    }
}

impl RelaxTrial {
    /// Its rule in SAFETY.md.
    #[must_use]
    pub fn rule(&self) -> &'static str {
        self.limit.name.split('.').next().unwrap_or_default()
    }

    /// Limit with what an observer adds.
    #[must_use]
    pub fn bound_ms(&self) -> f64 {
        let allowance = self.expected.allowance().map_or(0, |allowance| allowance.ms);
        f64::from(self.limit.ms + allowance)
    }

    fn motors(&self) -> &'static [Motor] {
        match self.expected {
            Expectation::Off(group) | Expectation::OffSaying(group, _) => match group {
                MotorGroup::Wheels => &[Motor::WheelLeft, Motor::WheelRight],
                MotorGroup::Cleaners => &[Motor::Brush, Motor::Suction],
                MotorGroup::All => &[Motor::WheelLeft, Motor::WheelRight, Motor::Brush, Motor::Suction],
            },
            _ => &[],
        }
    }

    fn said(&self) -> Option<Inhibit> {
        match self.expected {
            Expectation::Says(inhibit)
            | Expectation::SaysAfterReset(inhibit)
            | Expectation::SaysBroken(inhibit)
            | Expectation::OffSaying(_, inhibit) => Some(inhibit),
            Expectation::Lawful | Expectation::Off(_) | Expectation::DrivesOff => None,
        }
    }

    fn run(&self, mut testbed: RelaxTestbed, late_cycles: u64) -> RelaxOutcome {
        let before = testbed.pair.robot().monitor().count();
        let at = testbed.cycle() + late_cycles;
        let from = (self.event)(&mut testbed, at);
        let mut said_ms = None;
        let mut left_ms = (self.bound_ms() as u64).max(self.watch_ms) + AFTER_MS;
        while left_ms > 0 {
            testbed.tick();
            left_ms -= 1;
            let says = self
                .said()
                .is_some_and(|inhibit| testbed.pair.inhibits().contains(inhibit));
            if says && said_ms.is_none() {
                said_ms = Some(since_ms(from, testbed.cycle()));
                if self.motors().is_empty() {
                    left_ms = left_ms.min(AFTER_MS);
                }
            }
        }
        let reaction_ms = match self.expected {
            Expectation::Lawful => Some(0.0),
            Expectation::Off(_) | Expectation::OffSaying(..) => self.off_ms(&testbed, from),
            _ => said_ms,
        };
        // A broken machine violates what its firmware cannot hold.
        let violations = match self.expected {
            Expectation::SaysBroken(_) => 0,
            _ => (testbed.pair.robot().monitor().count() - before) as usize,
        };
        let is_said = self.said().is_none() || said_ms.is_some();
        let in_time = reaction_ms.is_some_and(|reaction_ms| reaction_ms <= self.bound_ms());
        RelaxOutcome {
            reaction_ms,
            violations,
            is_kept: in_time && is_said && violations == 0,
            said: testbed.pair.inhibits().iter().map(Inhibit::name).collect(),
        }
    }

    /// Time until the last of the motors was off for good; `None` if one is on at the end.
    fn off_ms(&self, testbed: &RelaxTestbed, from: u64) -> Option<f64> {
        let robot = testbed.pair.robot();
        let until = self.motors().iter().map(|motor| robot.on_until(*motor));
        let last = until.max().unwrap_or(0);
        // Pulses may be some milliseconds apart.
        let is_on = last + AFTER_MS / 3 * CYCLES_PER_MS > testbed.cycle();
        (!is_on).then(|| since_ms(from, last.max(from)))
    }

    fn summary(&self, outcomes: &[RelaxOutcome]) -> TrialSummary {
        let known: Vec<f64> = outcomes
            .iter()
            .filter_map(|outcome| outcome.reaction_ms)
            .collect();
        let broken: Vec<&RelaxOutcome> = outcomes.iter().filter(|outcome| !outcome.is_kept).collect();
        TrialSummary {
            name: self.name,
            rule: self.rule(),
            what: self.what,
            limit: self.limit.name,
            allowance: self.expected.allowance().map(|allowance| allowance.name),
            phases: outcomes.len(),
            spread_ms: SPREAD_MS,
            worst_ms: (known.len() == outcomes.len()).then(|| known.iter().copied().fold(0.0, f64::max)),
            mean_ms: known.iter().sum::<f64>() / known.len().max(1) as f64,
            limit_ms: self.limit.ms,
            broken: broken.len(),
            violations: outcomes.iter().map(|outcome| outcome.violations).sum(),
            said: broken
                .first()
                .map(|outcome| outcome.said.clone())
                .unwrap_or_default(),
        }
    }
}

/// A host finds a robot again that was reset; gives the cycle at which it had.
pub(super) fn reconnect(testbed: &mut RelaxTestbed) -> u64 {
    for _ in 0..RECONNECT_MS {
        testbed.tick();
        if testbed.pair.is_connected() {
            break;
        }
    }
    testbed.cycle()
}

fn since_ms(from: u64, to: u64) -> f64 {
    to.saturating_sub(from) as f64 / CYCLES_PER_MS as f64
}
