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
    /// Times it was driven against the rules.
    pub violations: u32,
    /// The firmware's estimate of the charge at the end.
    pub estimate: f64,
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
        violations: 0,
        estimate: 0.0,
    };
    let (mut after_ms, mut begun) = (0, false);
    let mut now_ms = 0;
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
