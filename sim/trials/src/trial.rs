//! One fault at one moment, and the expected reaction.

use pic32::board::{CYCLES_PER_MS, MotorOutput};
use rvac_protocol::message::{Inhibit, Inhibits};

use crate::limits::{self, Limit};
use crate::scene::OperatingState;
use crate::testbed::Testbed;

/// Observation time after the limit, so that a late reaction is measured.
const AFTER_MS: u64 = 150;

/// Motors that must be off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorGroup {
    /// Both wheels.
    Wheels,
    /// Brushes and suction.
    Cleaners,
    /// Every motor.
    All,
}

impl MotorGroup {
    const fn motors(self) -> &'static [MotorOutput] {
        match self {
            Self::Wheels => &[MotorOutput::WheelLeft, MotorOutput::WheelRight],
            Self::Cleaners => &[
                MotorOutput::BrushMain,
                MotorOutput::BrushSides,
                MotorOutput::Vacuum,
            ],
            Self::All => &MotorOutput::ALL,
        }
    }
}

/// The expected reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// Nothing in particular, as long as the monitor sees no breach.
    Lawful,
    /// These motors are off in time and stay off.
    Off(MotorGroup),
    /// The same, and at the end the robot reports this.
    OffSaying(MotorGroup, Inhibit),
    /// The robot reports this in time.
    Says(Inhibit),
    /// The robot reports this in time, counted from a reset.
    SaysAfterReset(Inhibit),
    /// The machine itself is broken, so that the firmware cannot stop the motors; it reports this in time.
    SaysBroken(Inhibit),
    /// The robot drives off by itself.
    DrivesOff,
}

/// What an observer adds to a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowance {
    /// Its name in rules.toml.
    pub name: &'static str,
    /// Milliseconds.
    pub ms: u32,
}

impl Expectation {
    const fn motors(self) -> &'static [MotorOutput] {
        match self {
            Self::Off(group) | Self::OffSaying(group, _) => group.motors(),
            Self::Lawful
            | Self::Says(_)
            | Self::SaysAfterReset(_)
            | Self::SaysBroken(_)
            | Self::DrivesOff => &[],
        }
    }

    const fn said(self) -> Option<Inhibit> {
        match self {
            Self::Lawful | Self::Off(_) | Self::DrivesOff => None,
            Self::Says(inhibit)
            | Self::SaysAfterReset(inhibit)
            | Self::SaysBroken(inhibit)
            | Self::OffSaying(_, inhibit) => Some(inhibit),
        }
    }

    /// What the way of looking adds to the limit.
    #[must_use]
    pub const fn allowance(self) -> Option<Allowance> {
        match self {
            Self::Says(_) | Self::SaysBroken(_) => Some(Allowance {
                name: "report",
                ms: limits::REPORT_MS,
            }),
            Self::SaysAfterReset(_) => Some(Allowance {
                name: "reconnect",
                ms: limits::RECONNECT_MS,
            }),
            Self::Lawful | Self::Off(_) | Self::OffSaying(..) | Self::DrivesOff => None,
        }
    }
}

/// Makes the fault happen at this cycle, which lies within the next millisecond, and returns the cycle from which the
/// reaction counts. What can only happen between two milliseconds happens at once.
pub(crate) type TrialEvent = fn(&mut Testbed, u64) -> u64;

/// A fault and the expected reaction.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Its name in rules.toml.
    pub name: &'static str,
    /// What happens.
    pub what: &'static str,
    /// The operating state.
    pub(crate) scene: OperatingState,
    pub(crate) event: TrialEvent,
    /// The expected reaction.
    pub expected: Expectation,
    /// In which time.
    pub limit: Limit,
    /// Longer observation than the limit asks for, ms.
    watch_ms: u64,
}

/// Outcome of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialOutcome {
    /// From the event to the expected reaction, ms; `None` = none within the observed time.
    pub reaction_ms: Option<f64>,
    /// Breaches that the monitor saw from the event on.
    pub violations: usize,
    /// The robot did not report at the end what it had to.
    pub unsaid: bool,
    /// Its inhibits at the end.
    pub inhibits: Inhibits,
}

impl Trial {
    pub(crate) const fn new(
        name: &'static str,
        what: &'static str,
        scene: OperatingState,
        event: TrialEvent,
    ) -> Self {
        Self {
            name,
            what,
            scene,
            event,
            expected: Expectation::Lawful,
            limit: limits::S2_NONE_ACTS,
            watch_ms: 0,
        }
    }

    pub(crate) const fn expects(self, expected: Expectation, limit: Limit) -> Self {
        Self {
            expected,
            limit,
            ..self
        }
    }

    pub(crate) const fn watched_for(self, watch_ms: u64) -> Self {
        Self { watch_ms, ..self }
    }

    /// Its rule in SAFETY.md, for example `S6`.
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

    /// Runs the trial, with the event so many cycles (less than a millisecond) after the testbed's present millisecond.
    #[must_use]
    pub fn run(&self, testbed: Testbed, late_cycles: u64) -> TrialOutcome {
        self.watch(testbed, late_cycles).0
    }

    /// The same, with the robot as it is in the end.
    pub(crate) fn watch(&self, mut testbed: Testbed, late_cycles: u64) -> (TrialOutcome, Testbed) {
        let before = testbed.robot().monitor().count();
        let at = testbed.robot().cycle() + late_cycles % CYCLES_PER_MS;
        let cycle = (self.event)(&mut testbed, at);
        let mut noticed_ms = None;
        let mut left_ms = (self.bound_ms() as u64).max(self.watch_ms) + AFTER_MS;
        while left_ms > 0 {
            testbed.tick();
            left_ms -= 1;
            if noticed_ms.is_none() && self.is_noticed(&testbed) {
                noticed_ms = Some(since_ms(cycle, testbed.robot().cycle()));
                if self.expected.motors().is_empty() {
                    left_ms = AFTER_MS;
                }
            }
        }
        let reaction_ms = match self.expected {
            Expectation::Says(_)
            | Expectation::SaysAfterReset(_)
            | Expectation::SaysBroken(_)
            | Expectation::DrivesOff => noticed_ms,
            Expectation::Lawful => Some(0.0),
            Expectation::Off(_) | Expectation::OffSaying(..) => {
                off_ms(&testbed, self.expected.motors(), cycle)
            }
        };
        let outcome = TrialOutcome {
            reaction_ms,
            violations: match self.expected {
                Expectation::SaysBroken(_) => 0,
                _ => (testbed.robot().monitor().count() - before) as usize,
            },
            unsaid: self.expected.said().is_some() && noticed_ms.is_none(),
            inhibits: testbed.inhibits(),
        };
        (outcome, testbed)
    }

    /// What the robot had to say, or do by itself.
    fn is_noticed(&self, testbed: &Testbed) -> bool {
        match (self.expected, self.expected.said()) {
            (_, Some(inhibit)) => testbed.inhibits().contains(inhibit),
            (Expectation::DrivesOff, None) => testbed.robot().wheels_driven(),
            (_, None) => false,
        }
    }

    /// Whether the outcome is as it must be.
    #[must_use]
    pub fn is_kept(&self, outcome: &TrialOutcome) -> bool {
        let in_time = outcome
            .reaction_ms
            .is_some_and(|reaction_ms| reaction_ms <= self.bound_ms());
        in_time && outcome.violations == 0 && !outcome.unsaid
    }
}

fn since_ms(from: u64, to: u64) -> f64 {
    to.saturating_sub(from) as f64 / CYCLES_PER_MS as f64
}

/// Time from `cycle` until the last of the motors was off for good; `None` if one still runs.
fn off_ms(testbed: &Testbed, motors: &[MotorOutput], cycle: u64) -> Option<f64> {
    let mut last = cycle;
    for motor in motors {
        for drive in testbed.robot().drives(*motor) {
            last = last.max(drive.until?);
        }
    }
    Some(since_ms(cycle, last))
}
