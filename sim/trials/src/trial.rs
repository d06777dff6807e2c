//! One fault at one moment, and the expected reaction.

use pic32::board::{CYCLES_PER_MS, MotorOutput};
use rvac_protocol::message::{Inhibit, Inhibits};
use rvac_units::{AngularSpeed, Speed, Throttle};

use crate::testbed::{Fixture, Testbed, TestbedError};
use monitor::Bridges;

/// Time in an operating state before the event, in which the wheels reach their speed.
const SETTLE_MS: u64 = 1_200;
/// Observation time after the limit, so that a late reaction is measured.
const AFTER_MS: u64 = 150;

/// What the robot is doing when the event happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperatingState {
    /// It stands still, armed.
    Standing,
    /// It drives ahead at 0.15 m/s.
    Driving,
    /// It drives ahead with brushes and suction on.
    Cleaning,
    /// It turns on the spot.
    Turning,
    /// It drives ahead on bridges that ignore "brake".
    DeafBridges,
}

impl OperatingState {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Standing,
        Self::Driving,
        Self::Cleaning,
        Self::Turning,
        Self::DeafBridges,
    ];

    /// A robot in this state.
    ///
    /// # Errors
    /// When it does not reach the state.
    pub fn set(self, fixture: &Fixture, seed: u64, late_cycles: u64) -> Result<Testbed, TestbedError> {
        let bridges = match self {
            Self::DeafBridges => Bridges::DeafToBrake,
            Self::Standing | Self::Driving | Self::Cleaning | Self::Turning => Bridges::Sound,
        };
        let mut testbed = fixture.testbed(seed, bridges, late_cycles);
        testbed.connect()?;
        testbed.arm();
        testbed.run(100);
        let ahead = (Speed(150_000), AngularSpeed(0));
        match self {
            Self::Standing => {}
            Self::Driving | Self::DeafBridges => testbed.drive(Some(ahead)),
            Self::Cleaning => {
                testbed.drive(Some(ahead));
                testbed.clean(Throttle::saturating_from_millionths(800_000));
            }
            Self::Turning => testbed.drive(Some((Speed(0), AngularSpeed(900_000)))),
        }
        testbed.robot_mut().watch_motors();
        testbed.run(SETTLE_MS);
        let drives = testbed.robot().wheels_driven();
        match (self, drives) {
            (Self::Standing, true) => Err(TestbedError::OperatingState("it does not stand")),
            (Self::Standing, false) | (_, true) => Ok(testbed),
            (_, false) => Err(TestbedError::OperatingState("it does not drive")),
        }
    }
}

/// The expected reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// Nothing in particular, as long as the monitor sees no breach.
    Lawful,
    /// The wheels are off in time and stay off.
    WheelsOff,
    /// All motors are off in time and stay off.
    AllOff,
    /// The robot reports this in time.
    Says(Inhibit),
    /// The machine itself is broken, so that the firmware cannot stop the motors; it reports this in time.
    SaysBroken(Inhibit),
    /// All motors are off in time and stay off, and at the end the robot reports this.
    AllOffSaying(Inhibit),
    /// The wheels are off in time and stay off, and at the end the robot reports this.
    WheelsOffSaying(Inhibit),
}

impl Expectation {
    const fn motors(self) -> &'static [MotorOutput] {
        match self {
            Self::WheelsOff | Self::WheelsOffSaying(_) => &[MotorOutput::WheelLeft, MotorOutput::WheelRight],
            Self::AllOff | Self::AllOffSaying(_) => &MotorOutput::ALL,
            Self::Lawful | Self::Says(_) | Self::SaysBroken(_) => &[],
        }
    }

    const fn said(self) -> Option<Inhibit> {
        match self {
            Self::Lawful | Self::WheelsOff | Self::AllOff => None,
            Self::Says(inhibit)
            | Self::SaysBroken(inhibit)
            | Self::AllOffSaying(inhibit)
            | Self::WheelsOffSaying(inhibit) => Some(inhibit),
        }
    }
}

/// A fault and the expected reaction.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Rule of SAFETY.md, for example `S6`.
    pub rule: &'static str,
    /// What happens.
    pub what: &'static str,
    /// The operating state.
    pub scene: OperatingState,
    /// Makes it happen at this cycle, which lies within the next millisecond. What can only happen between two
    /// milliseconds happens at once.
    pub event: fn(&mut Testbed, u64),
    /// The expected reaction.
    pub expected: Expectation,
    /// Limit of the reaction, ms.
    pub limit_ms: u64,
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
    /// Runs the trial, with the event `phase_cycles` after the testbed's present millisecond.
    #[must_use]
    pub fn run(&self, mut testbed: Testbed, phase_cycles: u64) -> TrialOutcome {
        testbed.run(phase_cycles / CYCLES_PER_MS);
        let before = testbed.robot().monitor().count();
        let cycle = testbed.robot().cycle() + phase_cycles % CYCLES_PER_MS;
        (self.event)(&mut testbed, cycle);
        let mut said_ms = None;
        for _ in 0..self.limit_ms + AFTER_MS {
            testbed.tick();
            let says = self
                .expected
                .said()
                .is_some_and(|inhibit| testbed.inhibits().contains(inhibit));
            if says && said_ms.is_none() {
                said_ms = Some(since_ms(cycle, testbed.robot().cycle()));
            }
        }
        let reaction_ms = match self.expected {
            Expectation::Says(_) | Expectation::SaysBroken(_) => said_ms,
            Expectation::Lawful => Some(0.0),
            _ => off_ms(&testbed, self.expected.motors(), cycle),
        };
        TrialOutcome {
            reaction_ms,
            violations: match self.expected {
                Expectation::SaysBroken(_) => 0,
                _ => (testbed.robot().monitor().count() - before) as usize,
            },
            unsaid: self.expected.said().is_some() && said_ms.is_none(),
            inhibits: testbed.inhibits(),
        }
    }

    /// Whether the outcome is as it must be.
    #[must_use]
    pub fn is_kept(&self, outcome: &TrialOutcome) -> bool {
        let in_time = outcome
            .reaction_ms
            .is_some_and(|reaction_ms| reaction_ms <= self.limit_ms as f64);
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
