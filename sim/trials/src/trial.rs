//! One fault at one moment, and what must follow.

use pic32::board::{CYCLES_PER_MS, MotorOutput};
use rvac_protocol::message::{Inhibit, Inhibits};
use rvac_units::{AngularSpeed, Speed, Throttle};

use crate::testbed::{Fixture, Testbed, TestbedError};
use monitor::Bridges;

/// Time in a scene before anything happens: the wheels have come to speed.
const SETTLE_MS: u64 = 1_200;
/// How long is looked on after the limit, so that a late reaction has a figure.
const AFTER_MS: u64 = 150;

/// What the robot is doing when it happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperatingState {
    /// It stands, armed.
    Standing,
    /// It drives ahead at 0.15 m/s.
    Driving,
    /// It drives ahead with brushes and suction on.
    Cleaning,
    /// It turns on the spot.
    Turning,
    /// It drives ahead on bridges that do not hear "brake".
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

    /// A robot in this scene.
    ///
    /// # Errors
    /// When it does not get there.
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

/// What must follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// Nothing in particular, as long as the monitor sees no breach.
    Lawful,
    /// The wheels are off in time and stay off.
    WheelsOff,
    /// All motors are off in time and stay off.
    AllOff,
    /// The robot says this in time.
    Says(Inhibit),
    /// The machine itself is broken, so that motors run on whatever the firmware does; it says this in time.
    SaysBroken(Inhibit),
    /// All motors are off in time and stay off, and at the end the robot says this.
    AllOffSaying(Inhibit),
    /// The wheels are off in time and stay off, and at the end the robot says this.
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

/// A fault and what must follow.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Rule of SAFETY.md, for example `S6`.
    pub rule: &'static str,
    /// What happens.
    pub what: &'static str,
    /// In which scene.
    pub scene: OperatingState,
    /// Makes it happen at this cycle, which lies within the next millisecond. What can only happen between two milliseconds
    /// happens at once.
    pub event: fn(&mut Testbed, u64),
    /// What must follow.
    pub expected: Expectation,
    /// In which time, ms.
    pub limit_ms: u64,
}

/// What came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialOutcome {
    /// From the event to what had to follow, ms; `None` = it did not follow while anybody looked.
    pub reaction_ms: Option<f64>,
    /// Breaches that the monitor saw from the event on.
    pub violations: usize,
    /// The robot did not say at the end what it had to say.
    pub unsaid: bool,
    /// What it said at the end.
    pub inhibits: Inhibits,
}

impl Trial {
    /// Lets it happen `phase_cycles` after the stage's present millisecond.
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
