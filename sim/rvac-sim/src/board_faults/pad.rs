//! Gamepads as they fail in homes: whether the wheels stand when they must, and whether people read of it in the lines of `rvac drive`.

use std::f64::consts::PI;

use brain::command::StrategyName;
use home::Pcg;
use mixer::{
    Calibration, Line, Mixer, Name, OutputName, PAD_SILENT_US, Pilot, Profile, Readings, Remarks,
    STEP_EVERY_US, Source, TopSpeeds, standard_profile,
};
use rvac_api::RequestBody;

use super::trial::{BoardPassage, TOLD_MS};
use crate::run::{RunSettings, household};
use crate::{Household, Scene};

/// What fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PadFault {
    /// A stick is pushed, and the pad says nothing more.
    HeldSilent,
    /// Somebody else stops with a second pad, while the first goes on.
    SecondStops,
    /// A pad froze while it was pushed and comes back under its number.
    CameBack,
    /// A trigger that nobody touches reads the middle of its range until its first word.
    TriggerHalfPulled,
    /// A cross that nobody touches reads 1.28, beyond its range.
    CrossBeyondItsEnd,
}

/// The robot has so long to connect, milliseconds.
const CONNECT_MS: u64 = 8_000;
/// A hand pushes for so long, milliseconds.
const PUSH_MS: u64 = 2_000;
/// From the moment that ends a drive until the robot stands, milliseconds: a step of the mixer, the line, and the brakes.
const BRAKE_MS: u64 = 600;
/// It is watched for so long after that.
const WATCH_MS: u64 = 3_000;
/// A robot that stands turns by less than this in that time, radians.
const STANDS_RAD: f64 = 0.03;
/// One that is driven turns by more.
const DRIVES_RAD: f64 = 0.3;
const STEP_MS: u64 = STEP_EVERY_US / 1_000;

/// Numbers of the "standard" mapping of the W3C.
const STICK_ACROSS: u8 = 0;
const EAST: u8 = 1;
const RIGHT_TRIGGER: u8 = 7;
/// Browsers give the cross of some pads as this axis.
const CROSS: u8 = 9;

struct PadTrial {
    household: Household,
    pilot: Pilot,
    readings: Readings,
    random: Pcg,
    top: TopSpeeds,
    remarks: Remarks,
    /// The lines that the person has read.
    lines: Vec<String>,
}

/// A person with a pad and a robot.
pub(super) fn passage(scene: &Scene, fault: PadFault, seed: u64) -> BoardPassage {
    let mut passed = BoardPassage::default();
    let Some(mut trial) = PadTrial::new(scene, fault, seed) else {
        passed.untold.push(fault.kind());
        return passed;
    };
    let (told_ms, moved_wrongly) = match fault {
        PadFault::HeldSilent => trial.held_silent(),
        PadFault::SecondStops => (None, trial.second_stops()),
        PadFault::CameBack => (None, trial.came_back()),
        PadFault::TriggerHalfPulled => trial.not_at_rest((trigger(), 0.5)),
        PadFault::CrossBeyondItsEnd => trial.not_at_rest((axis(CROSS), 9.0 / 7.0)),
    };
    if let Some(told_ms) = told_ms {
        passed.told_s.insert(fault.kind(), told_ms as f64 / 1e3);
    }
    let is_late = told_ms.is_none_or(|told_ms| told_ms > TOLD_MS);
    if fault.is_told() && is_late {
        passed.untold.push(fault.kind());
    }
    if fault != PadFault::HeldSilent && trial.has_read("(pad-silent)") {
        passed.wrong_causes.push("pad-silent");
    }
    passed.violations = trial.household.robot().monitor().count() + u32::from(moved_wrongly);
    passed
}

impl PadFault {
    pub(super) const ALL: [Self; 5] = [
        Self::HeldSilent,
        Self::SecondStops,
        Self::CameBack,
        Self::TriggerHalfPulled,
        Self::CrossBeyondItsEnd,
    ];

    /// Its kind, for tables.
    pub(super) const fn kind(self) -> &'static str {
        match self {
            Self::HeldSilent => "pad-held-silent",
            Self::SecondStops => "pad-second-stops",
            Self::CameBack => "pad-came-back",
            Self::TriggerHalfPulled => "pad-trigger-half-pulled",
            Self::CrossBeyondItsEnd => "pad-cross-beyond-its-end",
        }
    }

    /// Whether it is one that people must be told of.
    const fn is_told(self) -> bool {
        !matches!(self, Self::SecondStops | Self::CameBack)
    }
}

const fn axis(axis: u8) -> Source {
    Source::PadAxis { pad: 0, axis }
}

const fn trigger() -> Source {
    Source::PadButton {
        pad: 0,
        button: RIGHT_TRIGGER,
    }
}

/// The standard mix, and one in which the cross turns, too.
fn profile(fault: PadFault) -> Option<Profile> {
    let mut profile = standard_profile();
    if fault == PadFault::CrossBeyondItsEnd {
        let line = Line::new(Name::new("Cross").ok()?, axis(CROSS));
        let turn = profile
            .outputs
            .iter_mut()
            .find(|output| output.output == OutputName::Turn)?;
        turn.lines.push(line);
        profile.inputs.push(Calibration::new(axis(CROSS), 0.1));
    }
    Some(profile)
}

impl PadTrial {
    /// A robot that is connected, and a pad at rest; none when that cannot be had.
    fn new(scene: &Scene, fault: PadFault, seed: u64) -> Option<Self> {
        let settings = RunSettings {
            strategy: StrategyName::Bounce,
            pattern: None,
            seed,
            duration_ms: 0,
        };
        let mut household = household(scene, &settings);
        let is_connected = (0..CONNECT_MS).any(|_| {
            household.tick();
            household
                .host()
                .is_some_and(|host| host.status().state != "disconnected")
        });
        if !is_connected {
            return None;
        }
        household.pass_ms(1_000);
        let mut trial = Self {
            household,
            pilot: Pilot::new(Mixer::new(profile(fault)?).ok()?),
            readings: Readings::default(),
            random: Pcg::new(seed, 0x0A_D5),
            top: TopSpeeds {
                forward_m_per_s: 0.3,
                turn_rad_per_s: 1.0,
            },
            remarks: Remarks::default(),
            lines: Vec::new(),
        };
        trial.plug();
        Some(trial)
    }

    /// A pad comes, at rest as far as it says.
    fn plug(&mut self) {
        for source in [axis(STICK_ACROSS), axis(CROSS), trigger()] {
            self.readings.set(&source, 0.0);
        }
    }

    fn heading_rad(&self) -> f64 {
        self.household.robot().world().truth().pose.heading_rad
    }

    /// Passes so many milliseconds in steps of the mixer; before each `hand` does what it does. Gives by how much the robot turned.
    fn pass(&mut self, ms: u64, mut hand: impl FnMut(&mut Readings, u64)) -> f64 {
        let mut turned_rad = 0.0;
        for step in 0..ms / STEP_MS {
            hand(&mut self.readings, step);
            self.step();
            let before_rad = self.heading_rad();
            self.household.pass_ms(STEP_MS);
            turned_rad += home::wrap_angle(self.heading_rad() - before_rad).abs();
        }
        turned_rad
    }

    /// Whether the person has read this.
    fn has_read(&self, what: &str) -> bool {
        self.lines.iter().any(|line| line.contains(what))
    }

    /// As `rvac drive` does it.
    fn step(&mut self) {
        let now_us = self.household.now_us();
        let steered = self.pilot.step(now_us, &self.readings, self.top);
        let remarks = self.remarks.on(now_us, &steered);
        self.lines.extend(remarks.iter().map(ToString::to_string));
        for body in steered.presses.clone() {
            self.household.ask(body);
        }
        if let Some(body) = steered.seat.clone() {
            let is_drive = matches!(body, RequestBody::Drive { .. });
            if self.household.ask_and_hear(body).is_some() && is_drive {
                self.pilot.refuse();
            }
        }
    }

    /// A thumb that pushes, and trembles as thumbs do.
    fn push(&mut self, ms: u64) -> f64 {
        let share = (0.6 + 0.35 * self.random.unit()) * if self.random.unit() < 0.5 { -1.0 } else { 1.0 };
        self.pass(ms, |readings, step| {
            readings.set(&axis(STICK_ACROSS), share + 0.02 * (step as f64 * PI / 3.0).sin());
        })
    }

    /// Pushes so that the robot is seen to turn; the rest proves nothing otherwise.
    fn drives(&mut self) -> bool {
        self.pass(200, |_, _| {});
        self.push(PUSH_MS) > DRIVES_RAD
    }

    /// Whether the robot stands after the time that it needs for that.
    fn stands(&mut self) -> bool {
        self.pass(BRAKE_MS, |_, _| {});
        self.pass(WATCH_MS, |_, _| {}) < STANDS_RAD
    }

    /// When people were told, and whether the robot moved against a rule.
    fn held_silent(&mut self) -> (Option<u64>, bool) {
        let drove = self.drives();
        let mut told_ms = None;
        let silent_ms = PAD_SILENT_US / 1_000;
        for ms in (0..=silent_ms).step_by(STEP_MS as usize) {
            self.pass(STEP_MS, |_, _| {});
            if told_ms.is_none() && self.has_read("(pad-silent)") {
                told_ms = Some(ms);
            }
        }
        (told_ms, !(drove && self.stands()))
    }

    fn second_stops(&mut self) -> bool {
        let stop = Source::PadButton { pad: 1, button: EAST };
        self.readings.set(&stop, 0.0);
        let drove = self.drives();
        self.readings.set(&stop, 1.0);
        self.push(BRAKE_MS);
        self.readings.set(&stop, 0.0);
        // The first pad goes on.
        let stands = self.push(WATCH_MS) < STANDS_RAD;
        !(drove && stands)
    }

    fn came_back(&mut self) -> bool {
        let drove = self.drives();
        // It froze, and the kernel shows it as it was for half a second.
        self.pass(500, |_, _| {});
        self.readings = Readings::default();
        self.step();
        self.plug();
        let stands = self.stands();
        // And it drives again.
        !(drove && stands && self.drives())
    }

    /// An input that nobody touches reads this until its first word.
    fn not_at_rest(&mut self, (input, reading): (Source, f64)) -> (Option<u64>, bool) {
        self.readings = Readings::default();
        self.plug();
        self.readings.set(&input, reading);
        let not_at_rest = format!("not at rest: {input} reads {reading:.2} ");
        let mut told_ms = None;
        let mut turned_rad = 0.0;
        for ms in (0..2_000).step_by(STEP_MS as usize) {
            turned_rad += self.pass(STEP_MS, |_, _| {});
            if told_ms.is_none() && self.has_read(&not_at_rest) {
                told_ms = Some(ms);
            }
        }
        // Its first word brings it to rest, which moves nothing either.
        self.readings.set(&input, 0.0);
        turned_rad += self.pass(WATCH_MS, |_, _| {});
        let drives = self.drives();
        (told_ms, turned_rad >= STANDS_RAD || !drives)
    }
}
