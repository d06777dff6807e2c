//! The real firmware on its dock with packs of many kinds, and with faults (S18). Each charge runs for its first
//! minutes only: the emulated chip is too slow for hours. Whole charges are the model's (`cargo run --release -p robot
//! --example charges`), with the same charger.

use home::{Pack, PackMake, Pcg};
use monitor::Bridges;
use serde::Serialize;

use crate::limits;
use crate::testbed::{Fixture, Testbed, TestbedError};

const PACKS: u64 = 0xC4A6;
/// A charge begins within this time on the dock.
const BEGINS_MS: u64 = 60_000;
/// Observed time of a charge without a fault.
const WATCH_MS: u64 = 60_000;
/// Time from the start of the charge to the fault.
const CALM_MS: u64 = 2_000;
/// Current that tells that a pack is being charged, ampere. The dock gives less before it was asked.
const CHARGING_A: f64 = 0.1;
/// Channel of the thermistor, with readings of a broken and of a shorted wire (pinout.toml; sr8730.md section 7).
const THERMISTOR: u8 = 4;
const OPEN: u16 = 1_000;
const SHORTED: u16 = 20;
/// CLR address of IEC1 and the converter's bit (pic32mx360.md sections 5 and 13).
const IEC1_CLEAR: u32 = 0xBF88_1074;
const CONVERTER_ENABLE: u32 = 1 << 1;

/// Disturbance of a charge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ChargeDisturbance {
    /// Nothing; a pack as they come.
    None,
    /// Nothing; a worn pack.
    WornPack,
    /// The thermistor's wire breaks.
    ThermistorOpen,
    /// The thermistor's wire is shorted.
    ThermistorShorted,
    /// Somebody takes the robot off the dock.
    Lifted,
    /// The charging switch conducts for good: the robot must drive off.
    SwitchShorted,
    /// The converter's readings stop.
    ConverterStopped,
}

impl ChargeDisturbance {
    const ALL: [Self; 7] = [
        Self::None,
        Self::ThermistorOpen,
        Self::ConverterStopped,
        Self::SwitchShorted,
        Self::WornPack,
        Self::ThermistorShorted,
        Self::Lifted,
    ];

    /// In which time the current must have ended, ms; `None` where it may flow on.
    const fn limit_ms(self) -> Option<u32> {
        match self {
            Self::None | Self::WornPack => None,
            Self::ThermistorOpen | Self::ThermistorShorted => Some(limits::S18_THERMISTOR.ms),
            Self::Lifted => Some(limits::S18_UNSUPPLIED.ms + limits::ENVELOPE_MS),
            // Found, and then it backs off, with a pause if the first try fails.
            Self::SwitchShorted => Some(limits::S18_OFF_DOCK.ms),
            // Found in time, or ended by the watchdog.
            Self::ConverterStopped => Some(limits::S5_RESET.ms + limits::ENVELOPE_MS),
        }
    }

    fn begin(self, testbed: &mut Testbed, seed: u64) {
        // Every other shorted switch meets a host that has armed the robot to leave, and does nothing.
        if self == Self::SwitchShorted && (seed / Self::ALL.len() as u64).is_multiple_of(2) {
            testbed.arm_to_leave();
            testbed.run(100);
        }
        let now = testbed.robot().cycle();
        let robot = testbed.robot_mut();
        match self {
            Self::None | Self::WornPack => {}
            Self::ThermistorOpen => robot.hold_analog(THERMISTOR, OPEN, (now, u64::MAX)),
            Self::ThermistorShorted => robot.hold_analog(THERMISTOR, SHORTED, (now, u64::MAX)),
            Self::Lifted => robot.world_mut().lift(),
            Self::SwitchShorted => robot.short_charging_switch(),
            Self::ConverterStopped => robot.machine_mut().write_register(IEC1_CLEAR, CONVERTER_ENABLE),
        }
    }
}

/// Result of a charge.
#[derive(Clone, Debug, Serialize)]
pub struct ChargeResult {
    /// Of the pack and of the moment.
    pub seed: u64,
    /// The disturbance.
    #[serde(rename = "trouble")]
    pub disturbance: ChargeDisturbance,
    /// Capacity of the pack, Ah.
    pub capacity_ah: f64,
    /// Whether the charge began at all: a pack with a failed cell may be refused.
    pub began: bool,
    /// Highest current before the disturbance, ampere.
    pub highest_a: f64,
    /// Time from the disturbance to the last current, ms; `None` = it still flows, or there was no disturbance.
    pub ended_ms: Option<u64>,
    /// Hottest cell, degrees Celsius.
    pub hottest_c: f64,
    /// Breaches that the monitor saw.
    pub violations: u32,
}

impl ChargeResult {
    /// Whether the result is as required.
    #[must_use]
    pub fn is_good(&self) -> bool {
        let ended = match (self.disturbance.limit_ms(), self.ended_ms) {
            (None, _) => true,
            (Some(_), None) => !self.began,
            (Some(limit_ms), Some(ended_ms)) => ended_ms <= u64::from(limit_ms),
        };
        let began = self.began || self.disturbance == ChargeDisturbance::WornPack;
        ended && began && self.violations == 0 && self.hottest_c < 55.0
    }
}

/// Charges the pack of a seed.
///
/// # Errors
/// When the robot does not answer.
pub fn charge(fixture: &Fixture, seed: u64) -> Result<ChargeResult, TestbedError> {
    let mut random = Pcg::new(seed, PACKS);
    let kinds = ChargeDisturbance::ALL.len() as u64;
    let disturbance = ChargeDisturbance::ALL
        .get((seed % kinds) as usize)
        .copied()
        .unwrap_or(ChargeDisturbance::None);
    let make = match disturbance {
        ChargeDisturbance::WornPack => PackMake::worn(&mut random),
        _ => PackMake::sound(&mut random),
    };
    let (left, ambient_c) = (0.1 + 0.6 * random.unit(), 9.0 + 25.0 * random.unit());
    let mut testbed = on_the_dock(fixture, seed, Pack::new(make, left, ambient_c))?;
    let mut charge = ChargeResult {
        seed,
        disturbance,
        capacity_ah: make.capacity_ah,
        began: false,
        highest_a: 0.0,
        ended_ms: None,
        hottest_c: 0.0,
        violations: 0,
    };
    charge.began = (0..BEGINS_MS).any(|_| {
        testbed.tick();
        current_a(&testbed) > CHARGING_A
    });
    let calm_ms = match disturbance.limit_ms() {
        Some(_) => CALM_MS + u64::from(random.below(1_000)),
        None => WATCH_MS,
    };
    for _ in 0..calm_ms {
        testbed.tick();
        charge.highest_a = charge.highest_a.max(current_a(&testbed));
    }
    if let Some(limit_ms) = disturbance.limit_ms().filter(|_| charge.began) {
        disturbance.begin(&mut testbed, seed);
        charge.ended_ms = time_of_end(&mut testbed, 2 * u64::from(limit_ms));
    }
    charge.hottest_c = testbed.robot().world().truth().battery_hottest_c;
    charge.violations = testbed.robot().monitor().count();
    Ok(charge)
}

fn on_the_dock(fixture: &Fixture, seed: u64, pack: Pack) -> Result<Testbed, TestbedError> {
    let mut testbed = fixture.testbed(seed, Bridges::Sound, seed * 9_973)?;
    let world = testbed.robot_mut().world_mut();
    let dock = world.home().start();
    world.put_down_at(dock);
    world.set_pack(pack);
    testbed.connect()?;
    Ok(testbed)
}

/// When the last current flowed within `watched_ms`, if it does not still flow.
fn time_of_end(testbed: &mut Testbed, watched_ms: u64) -> Option<u64> {
    let mut last_ms = 0;
    for ms in 1..=watched_ms {
        testbed.tick();
        if current_a(testbed) > CHARGING_A {
            last_ms = ms;
        }
    }
    (last_ms < watched_ms).then_some(last_ms)
}

fn current_a(testbed: &Testbed) -> f64 {
    testbed.robot().world().truth().battery_a
}
