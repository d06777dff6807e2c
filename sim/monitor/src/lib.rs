//! The global safety monitor: a judge that watches every millisecond of every simulation.
//!
//! It holds the firmware to one sentence: a motor may be driven only while the host has armed motion, a fresh command
//! covers it, and nothing physical stands against it. It takes no word of the firmware for it. What was commanded it reads
//! from the bytes on the wire ([`wire`], [`said`]), what stands against it from the pins ([`Pins`]), what the motors do
//! from the bridges ([`Drives`]).
//!
//! *Standing* is how long a cause has been there without a gap. A *rule* is one line of SAFETY.md with its reaction time;
//! a *violation* is one beginning of a breach of it, however long it lasts.
//!
//! It judges the firmware on simulated pins (`sim/robot`) and the emulated microcontroller (`sim/pic32`) alike, so it knows
//! neither.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod causes;
mod charging;
mod permission;
mod said;
mod verdict;
mod wire;

pub use causes::{Drives, Pins};
pub use charging::{ChargeMonitor, Charging};
pub use verdict::{Rule, Violation};

use causes::CauseTimes;
use permission::HostPermission;
use rvac_protocol::message::ResetCause;

/// Wheel bridges of a simulated robot: sound ones, or a broken machine to see whether the monitor notices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bridges {
    /// They do what they are told.
    #[default]
    Sound,
    /// They go on with the last duty when they are told to brake.
    DeafToBrake,
}

/// How many violations are kept in full; all are counted.
const KEPT_MAX: usize = 32;

/// The judge.
#[derive(Clone, Debug)]
pub struct Monitor {
    permission: HostPermission,
    standing: CauseTimes,
    /// Rules that are broken right now, bit by rule.
    broken: u32,
    kept: Vec<Violation>,
    count: u32,
}

impl Default for Monitor {
    fn default() -> Self {
        Self::new()
    }
}

impl Monitor {
    /// A judge who sees the robot's first power-on.
    #[must_use]
    pub fn new() -> Self {
        Self {
            permission: HostPermission::default(),
            standing: CauseTimes::default(),
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
        self.permission.said(now_ms, byte);
    }

    /// The microcontroller was reset at `now_ms`.
    pub fn reset(&mut self, now_ms: u64, cause: ResetCause) {
        self.permission.reset(now_ms, cause);
        self.standing.reset();
    }

    /// The firmware's millisecond clock begins to count at `now_ms` at the latest: a firmware that checks its memories first
    /// may start it later than the reset. The age of what it is told is counted by it.
    pub fn clock_started(&mut self, now_ms: u64) {
        self.permission.clock_started(now_ms);
    }

    /// Judges one millisecond: what the pins showed before the firmware's pass and what the motors got after it.
    pub fn judge(&mut self, now_ms: u64, pins: &Pins, drives: &Drives) {
        self.standing.update(pins, drives);
        self.permission.update(now_ms, &self.standing);
        if drives.is_off() && self.broken == 0 && !pins.fallen && !pins.charging.driven {
            return;
        }
        let broken = verdict::broken(now_ms, &self.permission, &self.standing, drives);
        for rule in Rule::ALL {
            let bit = 1 << rule as u32;
            if broken & bit != 0 && self.broken & bit == 0 {
                self.count += 1;
                if self.kept.len() < KEPT_MAX {
                    self.kept.push(Violation::new(rule, now_ms, pins, drives));
                }
            }
        }
        self.broken = broken;
    }

    /// Violations so far.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Whether a rule is broken in this very millisecond.
    #[must_use]
    pub const fn is_broken(&self) -> bool {
        self.broken != 0
    }

    /// The first violations in full.
    #[must_use]
    pub fn violations(&self) -> &[Violation] {
        &self.kept
    }
}

#[cfg(test)]
mod tests;
