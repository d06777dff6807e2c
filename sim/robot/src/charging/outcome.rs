//! Outcome of a charge.

use cordlib::board::ChargeDrive;
use cordlib::charge::Stops;
use monitor::{ChargeMonitor, Charging};
use rvac_protocol::message::{ChargeEnd, ChargeFault, ChargePhase};
use rvac_units::Ratio;

use super::bench::{ChargeBench, STEP_MS};
use super::conditions::Conditions;

/// Longest simulated charge, ms.
const WATCH_MS: u32 = 5 * 3_600_000;
/// Time after the end of a charge, in which heat still spreads, ms.
const AFTER_MS: u32 = 1_800_000;
/// A charger that does not begin within this time is waiting, ms.
const WAIT_MS: u32 = 600_000;
const MINUTE_MS: u32 = 60_000;
/// Below this the pack may get a tenth of its capacity an hour only, degrees Celsius.
const COOL_C: f64 = 5.0;
/// Less is what a dock gives unasked, ampere.
const TRICKLE_A: f64 = 0.05;

/// Outcome of a charge, by the true state of the pack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargeOutcome {
    /// The seed.
    pub seed: u64,
    /// What ended the full current; `None` if it never began or a fault ended it.
    pub end: Option<ChargeEnd>,
    /// The fault that stopped it.
    pub fault: Option<ChargeFault>,
    /// Charge of the pack at the end, 1 = its rated full.
    pub charge: f64,
    /// Charge at the start.
    pub charge_before: f64,
    /// Hottest cell while the switch was driven, and afterwards.
    pub hottest_c: f64,
    /// Time in which the switch was driven, hours.
    pub driven_h: f64,
    /// Highest current while the switch was driven and the pack was below 0 degrees, ampere.
    pub frozen_a: f64,
    /// Highest mean of a minute while the switch was driven and the pack was below 5 degrees, ampere.
    pub cool_a: f64,
    /// Coldest pack when the first current of more than a trickle flowed; `None` if none did.
    pub began_c: Option<f64>,
    /// Times it was driven against the rules.
    pub violations: u32,
    /// The firmware's estimate of the charge at the end.
    pub estimate: f64,
}

/// Mean current of the minutes in which the pack is cool.
#[derive(Clone, Copy, Debug, Default)]
struct CoolMinute {
    sum_a: f64,
    steps: u32,
    last_a: f64,
}

impl CoolMinute {
    /// Takes a step; gives the mean of the last whole minute.
    fn mean_a(&mut self, is_cool: bool, current_a: f64) -> f64 {
        if !is_cool {
            *self = Self::default();
            return 0.0;
        }
        self.sum_a += current_a;
        self.steps += 1;
        if self.steps * STEP_MS >= MINUTE_MS {
            self.last_a = self.sum_a / f64::from(self.steps);
            (self.sum_a, self.steps) = (0.0, 0);
        }
        self.last_a
    }
}

/// Runs one charge with these stops.
#[must_use]
pub fn run<S: Stops>(conditions: &Conditions, stops: S) -> ChargeOutcome {
    let mut bench = ChargeBench::new(conditions, stops);
    let mut monitor = ChargeMonitor::default();
    let mut outcome = ChargeOutcome {
        seed: conditions.seed,
        end: None,
        fault: None,
        charge: conditions.charge,
        charge_before: conditions.charge,
        hottest_c: conditions.pack_c,
        driven_h: 0.0,
        frozen_a: 0.0,
        cool_a: 0.0,
        began_c: None,
        violations: 0,
        estimate: 0.0,
    };
    let (mut after_ms, mut begun) = (0, false);
    let mut now_ms = 0;
    let mut cool = CoolMinute::default();
    while now_ms < WATCH_MS && after_ms < AFTER_MS {
        bench.step();
        now_ms += STEP_MS;
        let driven = bench.output().drive != ChargeDrive::Off;
        let hottest_c = bench.pack().hottest_c();
        let charging = Charging {
            driven,
            supplied: bench.is_supplied(),
            current_ma: (bench.current_a() * 1e3) as i32,
            pack_mv: (bench.pack().terminal_v(bench.current_a()) * 1e3) as i32,
            temperature_dc: (hottest_c * 10.0) as i32,
        };
        monitor.judge(&charging, STEP_MS);
        if driven {
            let (cells_c, current_a) = (bench.pack().temperature_c(), bench.current_a());
            outcome.began_c = outcome.began_c.or((current_a > TRICKLE_A).then_some(cells_c));
            if cells_c < 0.0 {
                outcome.frozen_a = outcome.frozen_a.max(current_a);
            }
            outcome.cool_a = outcome.cool_a.max(cool.mean_a(cells_c < COOL_C, current_a));
        }
        begun |= driven;
        let phase = bench.charger().status().phase;
        let charging = matches!(
            phase,
            ChargePhase::Precharge | ChargePhase::Fast | ChargePhase::TopOff
        );
        if charging {
            outcome.charge = bench.pack().charge();
            after_ms = 0;
        } else if begun || phase == ChargePhase::Fault || now_ms > WAIT_MS {
            after_ms += STEP_MS;
        }
        // A switch that conducts for good is no charge any more: only leaving the dock ends it.
        if bench.charger().status().fault == Some(ChargeFault::Shorted) {
            break;
        }
        if bench.current_a() > 0.0 || after_ms > 0 {
            outcome.hottest_c = outcome.hottest_c.max(hottest_c);
        }
        outcome.driven_h += f64::from(u8::from(driven && charging)) * f64::from(STEP_MS) / 3_600_000.0;
    }
    let status = bench.charger().status();
    ChargeOutcome {
        end: status.end.filter(|_| status.fault.is_none()),
        fault: status.fault,
        violations: monitor.count(),
        estimate: bench.charger().charge_left().map_or(0.0, Ratio::as_f64),
        ..outcome
    }
}
