//! The safety monitor: an independent check of every millisecond of every simulation.
//!
//! It checks one requirement: a motor may be driven only while the host has armed motion, a fresh command covers it,
//! and no physical cause forbids it. It judges what the robot tells about its sensors, too. It does not rely on the firmware. It reads commands from the bytes on the wire
//! ([`wire`], [`said`]), causes from the pins ([`Pins`]), and the motors from the bridges ([`Drives`]).
//!
//! *Cause times* are how long each cause has lasted without a gap. A *rule* is one line of SAFETY.md with its reaction time;
//! a *violation* is the beginning of a breach, however long it lasts.
//!
//! It checks both the firmware on simulated pins (`sim/robot`) and the emulated microcontroller (`sim/pic32`), and
//! depends on neither.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod causes;
mod charging;
mod encoders;
mod hardware;
mod limits;
mod loads;
mod pack;
mod permission;
mod reports;
mod said;
mod told;
mod verdict;
mod wire;

pub use causes::{Drives, Pins, Sensed, Sides};
pub use charging::{ChargeMonitor, Charging};
pub use hardware::HardwareTruth;
pub use loads::WheelLoad;
pub use verdict::{Rule, Violation};

use causes::CauseTimes;
use permission::HostPermission;
use reports::ReportWatch;
use rvac_protocol::message::ResetCause;

/// Wheel bridges of a simulated robot: good ones, or faulty ones to test the monitor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bridges {
    /// They follow the command.
    #[default]
    Sound,
    /// They keep the last duty when commanded to brake.
    DeafToBrake,
}

/// How many violations are kept in full; all are counted.
const KEPT_MAX: usize = 32;

/// The monitor.
#[derive(Clone, Debug)]
pub struct Monitor {
    permission: HostPermission,
    standing: CauseTimes,
    reports: ReportWatch,
    /// Rules that are broken right now, bit by rule.
    broken: u64,
    kept: Vec<Violation>,
    count: u32,
}

impl Default for Monitor {
    fn default() -> Self {
        Self::new()
    }
}

impl Monitor {
    /// A monitor at the robot's first power-on.
    #[must_use]
    pub fn new() -> Self {
        Self {
            permission: HostPermission::default(),
            standing: CauseTimes::default(),
            reports: ReportWatch::default(),
            broken: 0,
            kept: Vec::new(),
            count: 0,
        }
    }

    /// A frame reached the robot's receiver at `now_ms`; `None` is one with a wrong stop bit.
    pub fn heard(&mut self, now_ms: u64, byte: Option<u8>) {
        self.permission.heard(now_ms, byte);
    }

    /// The firmware put this byte into its transmitter.
    pub fn said(&mut self, now_ms: u64, byte: u8) {
        if let Some(told) = self.permission.said(now_ms, byte) {
            self.reports.take(told);
        }
    }

    /// The microcontroller was reset at `now_ms`.
    pub fn reset(&mut self, now_ms: u64, cause: ResetCause) {
        self.permission.reset(now_ms, cause);
        self.standing.reset();
        self.reports.reset(now_ms);
    }

    /// The firmware's millisecond clock begins to count at `now_ms` at the latest: a firmware that checks its memories
    /// first may start it later than the reset. The age of commands is measured with it.
    pub fn clock_started(&mut self, now_ms: u64) {
        self.permission.clock_started(now_ms);
        self.reports.clock_started(now_ms);
    }

    /// Checks one millisecond: the pins before the firmware's pass and the motors after it.
    pub fn judge(&mut self, now_ms: u64, pins: &Pins, drives: &Drives) {
        self.standing.update(pins, drives);
        self.permission.update(now_ms, &self.standing);
        if self.permission.rests(now_ms) {
            self.standing.rest();
        }
        self.update_loads(now_ms, pins, drives);
        self.reports.look(now_ms, pins);
        let told = self.reports.broken();
        let rests = drives.is_off() && !pins.fallen && !pins.charging.driven;
        if rests && self.broken == 0 && told == 0 {
            return;
        }
        let broken = told | verdict::broken(now_ms, &self.permission, &self.standing, drives);
        let begun = broken & !self.broken;
        self.broken = broken;
        if begun == 0 {
            return;
        }
        for rule in Rule::ALL
            .into_iter()
            .filter(|rule| begun & 1 << *rule as u32 != 0)
        {
            self.count += 1;
            if self.kept.len() < KEPT_MAX {
                self.kept.push(Violation::new(rule, now_ms, pins, drives));
            }
        }
    }

    fn update_loads(&mut self, now_ms: u64, pins: &Pins, drives: &Drives) {
        // A robot that backs off its dock by itself was asked by nobody.
        let asked = if self.standing.charge.may_leave() {
            None
        } else {
            self.permission.asked_mm_per_s(now_ms)
        };
        self.standing.loads.update(pins, drives, asked);
    }

    /// Violations so far.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Whether a motor or the charger breaks a rule in this millisecond.
    #[must_use]
    pub const fn is_broken(&self) -> bool {
        self.broken & !Rule::REPORTS != 0
    }

    /// The first violations in full.
    #[must_use]
    pub fn violations(&self) -> &[Violation] {
        &self.kept
    }
}

#[cfg(test)]
mod tests;
