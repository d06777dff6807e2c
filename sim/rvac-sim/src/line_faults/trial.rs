//! One fault of the line in the middle of a cleaning job.

use std::collections::BTreeSet;

use brain::BehaviorState;
use brain::command::StrategyName;
use rayon::prelude::*;
use rvac_api::LogLevel;
use serde::Serialize;

use super::fault::{LineFault, SUSPENDED_MS};
use super::tamper::Tamper;
use crate::run::{RunSettings, household, start_cleaning};
use crate::{Household, Scene};

/// The way is measured for so long from the beginning of the fault.
const MEASURED_MS: u64 = 60_000;
/// It is waited for so long that the robot goes on.
const HEALING_MAX_MS: u64 = 40_000;
/// The robot has driven so far when the fault begins.
const DRIVEN_BEFORE_M: f64 = 0.5;
const BEFORE_MAX_MS: u64 = 60_000;
/// A robot that goes on has cleaned so far.
const GOES_ON_M: f64 = 0.1;

/// A fault and where it happens.
#[derive(Clone, Debug)]
pub struct LineTrial<'a> {
    /// The home and the robot.
    pub scene: &'a Scene,
    /// What is wrong with the line.
    pub fault: LineFault,
    /// Seed of everything.
    pub seed: u64,
}

/// How a robot came through a fault of its line.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FaultPassage {
    /// The fault in words.
    pub fault: String,
    /// The robot shall clean on through it.
    pub is_mild: bool,
    /// True way in the minute that began with the fault.
    pub way_m: f64,
    /// Seconds of that minute in which no wheel was driven.
    pub standing_s: f64,
    /// What kept it from cleaning meanwhile, by name.
    pub named: BTreeSet<String>,
    /// What the host was doing at the end of the minute.
    pub state: String,
    /// Seconds from the end of the fault until it had cleaned on for 10 cm; `None` if it did not.
    pub healed_s: Option<f64>,
    /// Lines in the log from the beginning of the fault until the robot went on, without those for developers.
    pub log_lines: usize,
    /// Rules of safety that were broken.
    pub violations: u32,
}

/// The passages of all faults, in their order.
#[must_use]
pub fn passages(scene: &Scene, seed: u64, faults: &[LineFault]) -> Vec<FaultPassage> {
    let trial = |fault: &LineFault| {
        let fault = *fault;
        LineTrial { scene, fault, seed }.run()
    };
    faults.par_iter().map(trial).collect()
}

impl LineTrial<'_> {
    /// Runs it.
    ///
    /// # Panics
    /// When the robot does not begin to clean over a sound line.
    #[must_use]
    pub fn run(&self) -> FaultPassage {
        let mut household = self.cleaning();
        let before_m = way_m(&household);
        let mut passage = FaultPassage {
            fault: self.fault.to_string(),
            is_mild: self.fault.is_mild(),
            ..FaultPassage::default()
        };
        self.begin(&mut household);
        let ends_ms = self.fault.lasts_ms().unwrap_or(MEASURED_MS);
        let mut end_m = before_m;
        for ms in 0..MEASURED_MS {
            household.tick();
            passage.watch(&household);
            if ms <= ends_ms {
                end_m = way_m(&household);
            }
            passage.note_healed(ms.saturating_sub(ends_ms), way_m(&household) - end_m, &household);
        }
        passage.way_m = way_m(&household) - before_m;
        passage.state = household
            .host()
            .map(|host| host.status().state)
            .unwrap_or_default();
        if let Some(tamper) = household.tamper_mut() {
            tamper.begin(LineFault::None);
        }
        for ms in MEASURED_MS.. {
            if passage.healed_s.is_some() || ms > ends_ms + HEALING_MAX_MS {
                break;
            }
            household.tick();
            passage.note_healed(ms.saturating_sub(ends_ms), way_m(&household) - end_m, &household);
        }
        passage.finish(&household);
        passage
    }

    fn cleaning(&self) -> Household {
        let settings = RunSettings {
            strategy: StrategyName::Bounce,
            pattern: None,
            seed: self.seed,
            duration_ms: 0,
        };
        let mut household = household(self.scene, &settings).with_tamper(Tamper::new(self.seed));
        let is_answered = start_cleaning(&mut household, settings.strategy);
        assert!(is_answered, "the host finds the robot");
        let drives = |household: &Household| way_m(household) >= DRIVEN_BEFORE_M;
        let mut waited_ms = 0;
        while !drives(&household) && waited_ms < BEFORE_MAX_MS {
            household.tick();
            waited_ms += 1;
        }
        assert!(drives(&household), "the robot cleans over a sound line");
        household
    }

    fn begin(&self, household: &mut Household) {
        if let Some(host) = household.host_mut() {
            host.keep_log();
        }
        match self.fault {
            LineFault::HostSuspended(clock) => household.suspend_host(SUSPENDED_MS, clock),
            LineFault::CutOut { for_ms } => household.robot_mut().cut_line(for_ms),
            fault => {
                if let Some(tamper) = household.tamper_mut() {
                    tamper.begin(fault);
                }
            }
        }
    }
}

impl FaultPassage {
    fn watch(&mut self, household: &Household) {
        if !household.robot().wheels_driven() {
            self.standing_s += 1e-3;
        }
        let Some(host) = household.host() else { return };
        if host.state() == Some(BehaviorState::Cleaning) || !household.robot().now_ms().is_multiple_of(10) {
            return;
        }
        let status = host.status();
        // What belongs to the start is no news.
        if status.state != "starting" {
            self.named.insert(status.reason);
        }
    }

    /// Notes when the robot has gone on, with the milliseconds and the way since the end of the fault.
    fn note_healed(&mut self, ms: u64, way_m: f64, household: &Household) {
        let state = household.host().and_then(crate::Host::state);
        let cleans = state == Some(BehaviorState::Cleaning) && way_m >= GOES_ON_M;
        if cleans && self.healed_s.is_none() {
            self.healed_s = Some(ms as f64 / 1e3);
        }
    }

    fn finish(&mut self, household: &Household) {
        let log = household.host().map_or(&[][..], crate::Host::log);
        self.log_lines = log.iter().filter(|entry| entry.level != LogLevel::Debug).count();
        self.violations = household.robot().monitor().count();
    }
}

fn way_m(household: &Household) -> f64 {
    household.robot().world().truth().path_m
}
