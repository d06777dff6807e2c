//! One fault at one moment, and what must follow.

use pic32::board::{CYCLES_PER_MS, Motor};
use rvac_protocol::message::{Inhibit, Inhibits};
use rvac_units::{AngularSpeed, Speed, Throttle};

use crate::stage::{Stage, StageError, Workshop};
use monitor::Bridges;

/// Time in a scene before anything happens: the wheels have come to speed.
const SETTLE_MS: u64 = 1_200;
/// How long is looked on after the limit, so that a late reaction has a figure.
const AFTER_MS: u64 = 150;

/// What the robot is doing when it happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
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

impl Scene {
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
    pub fn set(self, workshop: &Workshop, seed: u64, late_cycles: u64) -> Result<Stage, StageError> {
        let bridges = match self {
            Self::DeafBridges => Bridges::DeafToBrake,
            Self::Standing | Self::Driving | Self::Cleaning | Self::Turning => Bridges::Sound,
        };
        let mut stage = workshop.stage(seed, bridges, late_cycles);
        stage.connect()?;
        stage.arm();
        stage.run(100);
        let ahead = (Speed(150_000), AngularSpeed(0));
        match self {
            Self::Standing => {}
            Self::Driving | Self::DeafBridges => stage.drive(Some(ahead)),
            Self::Cleaning => {
                stage.drive(Some(ahead));
                stage.clean(Throttle::saturating_from_millionths(800_000));
            }
            Self::Turning => stage.drive(Some((Speed(0), AngularSpeed(900_000)))),
        }
        stage.robot_mut().watch_motors();
        stage.run(SETTLE_MS);
        let drives = stage.robot().wheels_driven();
        match (self, drives) {
            (Self::Standing, true) => Err(StageError::Scene("it does not stand")),
            (Self::Standing, false) | (_, true) => Ok(stage),
            (_, false) => Err(StageError::Scene("it does not drive")),
        }
    }
}

/// What must follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
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

impl Aim {
    const fn motors(self) -> &'static [Motor] {
        match self {
            Self::WheelsOff | Self::WheelsOffSaying(_) => &[Motor::WheelLeft, Motor::WheelRight],
            Self::AllOff | Self::AllOffSaying(_) => &Motor::ALL,
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
    pub scene: Scene,
    /// Makes it happen at this cycle, which lies within the next millisecond. What can only happen between two milliseconds
    /// happens at once.
    pub event: fn(&mut Stage, u64),
    /// What must follow.
    pub aim: Aim,
    /// In which time, ms.
    pub limit_ms: u64,
}

/// What came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
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
    pub fn run(&self, mut stage: Stage, phase_cycles: u64) -> Outcome {
        stage.run(phase_cycles / CYCLES_PER_MS);
        let before = stage.robot().monitor().count();
        let cycle = stage.robot().cycle() + phase_cycles % CYCLES_PER_MS;
        (self.event)(&mut stage, cycle);
        let mut said_ms = None;
        for _ in 0..self.limit_ms + AFTER_MS {
            stage.tick();
            let says = self
                .aim
                .said()
                .is_some_and(|inhibit| stage.inhibits().contains(inhibit));
            if says && said_ms.is_none() {
                said_ms = Some(since_ms(cycle, stage.robot().cycle()));
            }
        }
        let reaction_ms = match self.aim {
            Aim::Says(_) | Aim::SaysBroken(_) => said_ms,
            Aim::Lawful => Some(0.0),
            _ => off_ms(&stage, self.aim.motors(), cycle),
        };
        Outcome {
            reaction_ms,
            violations: match self.aim {
                Aim::SaysBroken(_) => 0,
                _ => (stage.robot().monitor().count() - before) as usize,
            },
            unsaid: self.aim.said().is_some() && said_ms.is_none(),
            inhibits: stage.inhibits(),
        }
    }

    /// Whether the outcome is as it must be.
    #[must_use]
    pub fn is_kept(&self, outcome: &Outcome) -> bool {
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
fn off_ms(stage: &Stage, motors: &[Motor], cycle: u64) -> Option<f64> {
    let mut last = cycle;
    for motor in motors {
        for drive in stage.robot().drives(*motor) {
            last = last.max(drive.until?);
        }
    }
    Some(since_ms(cycle, last))
}
