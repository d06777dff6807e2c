//! Checks the charger against the true state of the pack (S18).

use super::limits::{LEAK_MA, OFF_DOCK_MS, REST_MS};
use crate::verdict;

/// True state of charger and pack, without sensor faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Charging {
    /// The firmware drives the charging switch: closed at any time in the last 20 ms, which is an envelope of its
    /// pulses.
    pub driven: bool,
    /// A supply is on the contacts.
    pub supplied: bool,
    /// Current into the pack, mA, mean of the last 20 ms.
    pub current_ma: i32,
    /// At the pack's terminals, mV; 0 = the robot cannot measure it.
    pub pack_mv: i32,
    /// In the pack, tenths of a degree Celsius.
    pub temperature_dc: i32,
}

/// Milliseconds for which each cause has lasted while the switch was driven.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ChargeTimes {
    pub(crate) unsupplied_ms: u32,
    pub(crate) driving_ms: u32,
    pub(crate) temperature_ms: u32,
    pub(crate) voltage_ms: u32,
    pub(crate) current_ms: u32,
    /// Driven in this charge, and not driven since.
    pub(crate) charged_ms: u32,
    rest_ms: u32,
    /// Current flows though the switch is not driven.
    leak_ms: u32,
    /// Remaining time in which a robot may back off such a dock by itself.
    leaving_ms: u32,
}

/// No pack may be charged hotter or colder than this by its true temperature, tenths of a degree: its makers' limits.
const HOT_DC: i32 = 550;
const COLD_DC: i32 = 0;
/// Below this it may get a tenth of the capacity of 2 Ah an hour only; a quarter more is ripple.
const COOL_DC: i32 = 50;
const COOL_MAX_MA: i32 = 250;
/// 1.75 V a cell of twelve: the firmware stops at 1.70, by a divider of 1 %.
const VOLTAGE_MAX_MV: i32 = 21_000;
/// The firmware regulates to 1 A and stops at 1.25 A; its converter sees steps of 0.1 A.
const CURRENT_MAX_MA: i32 = 1_400;

/// S18: after a second of it a robot may back off the dock by itself, three times with their pauses.
const LEAK_MS: u32 = 1_000;

impl ChargeTimes {
    /// Whether a robot may leave the dock without a command: nothing else ends the current.
    pub(crate) const fn may_leave(&self) -> bool {
        self.leaving_ms > 0
    }

    /// Takes the state for the next `elapsed_ms`.
    pub(crate) fn update(&mut self, charging: &Charging, motors_run: bool, elapsed_ms: u32) {
        let driven = charging.driven;
        let stand = |standing_ms: &mut u32, cause: bool| {
            *standing_ms = if driven && cause {
                standing_ms.saturating_add(elapsed_ms)
            } else {
                0
            };
        };
        stand(&mut self.unsupplied_ms, !charging.supplied);
        stand(&mut self.driving_ms, motors_run);
        let temperate = (COLD_DC..HOT_DC).contains(&charging.temperature_dc);
        let too_much = charging.temperature_dc < COOL_DC && charging.current_ma > COOL_MAX_MA;
        stand(&mut self.temperature_ms, !temperate || too_much);
        stand(&mut self.voltage_ms, charging.pack_mv > VOLTAGE_MAX_MV);
        stand(&mut self.current_ms, charging.current_ma > CURRENT_MAX_MA);
        if driven {
            self.charged_ms = self.charged_ms.saturating_add(elapsed_ms);
            self.rest_ms = 0;
        } else {
            self.rest_ms = self.rest_ms.saturating_add(elapsed_ms);
            if self.rest_ms > REST_MS {
                self.charged_ms = 0;
            }
        }
        let leaks = !driven && charging.supplied && charging.current_ma > LEAK_MA;
        self.leak_ms = if leaks {
            self.leak_ms.saturating_add(elapsed_ms)
        } else {
            0
        };
        self.leaving_ms = if self.leak_ms >= LEAK_MS {
            OFF_DOCK_MS
        } else {
            self.leaving_ms.saturating_sub(elapsed_ms)
        };
    }
}

/// Checks a charger alone, in steps of any length: for campaigns of thousands of charges.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChargeMonitor {
    standing: ChargeTimes,
    broken: u64,
    count: u32,
    longest_ms: u32,
}

impl ChargeMonitor {
    /// Checks the state of the last `elapsed_ms`, in which no motor ran.
    pub fn judge(&mut self, charging: &Charging, elapsed_ms: u32) {
        self.standing.update(charging, false, elapsed_ms);
        self.longest_ms = self.longest_ms.max(self.standing.charged_ms);
        let broken = verdict::broken_by_charger(&self.standing);
        self.count += (broken & !self.broken).count_ones();
        self.broken = broken;
    }

    /// Violations so far.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Longest time for which the switch was driven without a rest, ms.
    #[must_use]
    pub const fn longest_ms(&self) -> u32 {
        self.longest_ms
    }
}
