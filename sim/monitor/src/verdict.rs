//! The rules, as far as they can be checked from outside.

use super::causes::{CauseTimes, Drives, Pins};
use super::charging::ChargeTimes;
use super::limits::{
    BUMPER_BACKING_MS, BUMPER_MS, BUMPER_STUCK_MS, BUTTON_MS, CHARGE_CURRENT_MS, CHARGE_MS, CHARGE_TIME_MS,
    CLIFF_HASTE_MS, CLIFF_MS, CLIFF_REVERSE_UM, CLOCK_MS, DOCKED_MS, ENCODER_MS, ESCAPE_WARNING_MS,
    GROUNDED_MS, MEMORY_MS, NEARLY_HELD_MS, PACK_EMPTY_MS, PACK_HOT_MS, PACK_WEAK_MS, PULSES_MS, STALL_MS,
    TOO_FAST_MS, TOO_MUCH_MS, WHEEL_DROP_MS,
};
use super::permission::HostPermission;
use crate::hardware::HardwareTimes;

/// A line of SAFETY.md that the monitor checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Rule {
    /// S1: a wheel driven 50 ms after the lease of the last command that covers it has ended.
    WheelsWithoutLease = 0,
    /// S1: a brush or the suction driven 50 ms after the lease of its last command has ended.
    CleanersWithoutLease = 1,
    /// S4, and `stop`: a motor driven although nobody armed since the reset, the `stop` or the button.
    NotArmed = 2,
    /// S4: a motor driven after three resets within a minute that nobody cleared.
    ResetLoop = 3,
    /// S6: driven forward 20 ms after the bumper was pressed.
    Bumper = 4,
    /// S7: any motor driven 10 s after the bumper was pressed and stayed so, or backing off it for more than 3 s.
    BumperStuck = 5,
    /// S8: a wheel driven forward 20 ms after a cliff came into sight.
    Cliff = 6,
    /// S8: the body fell down.
    Fallen = 7,
    /// S10: any motor driven 50 ms after a wheel hung.
    WheelDrop = 8,
    /// S10: wheels driven before both wheels were on the floor for a second.
    LiftedJustNow = 9,
    /// S11: a wheel driven hard for 300 ms without turning.
    Stall = 10,
    /// S19: wheels driven on the dock without an undock command.
    Docked = 11,
    /// S28: a motor driven 50 ms after a button was pressed.
    Button = 12,
    /// S29: brushes or suction started with a pressed bumper or a hanging wheel.
    CleanersStart = 13,
    /// S18: the charging switch driven 100 ms after the supply was gone.
    ChargeUnsupplied = 14,
    /// S18: the charging switch driven while a motor was, for 100 ms.
    ChargeDriving = 15,
    /// S18: charging for 2 s although the pack was really above 55 or below -5 degrees.
    ChargeTemperature = 16,
    /// S18: charging for 2 s above 21 V.
    ChargeVoltage = 17,
    /// S18: more than 1.4 A for 200 ms.
    ChargeCurrent = 18,
    /// S18: the charging switch driven for more than 3.6 hours in one charge.
    ChargeTime = 19,
    /// S8: for 100 ms a wheel driven backward beside an edge while its rim turned faster than 0.1 m/s.
    CliffSpeed = 20,
    /// S8: driven backward although the body is 0.15 m back with the edge still in sight.
    CliffDistance = 21,
    /// S13: for half a second a wheel driven while its encoder counts against its rim, or stands while the rim turns.
    Encoder = 22,
    /// S16: for 500 ms any motor driven although the pack is really below 0.9 V a cell.
    PackEmpty = 23,
    /// S16: for 2 s brushes or suction driven although the pack is really below 1.0 V a cell.
    PackWeak = 24,
    /// S17: for a second any motor driven although the pack is really above 55 degrees.
    PackHot = 25,
    /// S11: for 100 ms a wheel driven while it really draws more than any limit allows, or for 2 s while it draws what a held
    /// wheel draws.
    Current = 26,
    /// S12: for 250 ms a wheel driven while its rim is faster than one and a half times what was asked.
    TooFast = 27,
    /// S20: a motor or the charger on 10 ms after the crystal stopped.
    Clock = 28,
    /// S21: a motor or the charger on a minute after a bit of the program flipped.
    Memory = 29,
    /// S21: a motor or the charger on 20 ms after a register behind the pulses changed.
    Pulses = 30,
    /// A report names a switch or receiver that is not so, or does not name one that is.
    ReportsSide = 31,
    /// Reported totals of the encoders are not those of their wheels.
    ReportsCount = 32,
    /// Reported currents are not those of their wheels.
    ReportsCurrent = 33,
    /// A reported voltage or temperature is not that of the pack.
    ReportsPack = 34,
    /// A report tells a value of a part that the robot says it does not have.
    ReportsAbsent = 35,
    /// A report tells something near a proximity sensor where nothing is, or nothing where something is.
    ReportsNear = 36,
}

impl Rule {
    /// All of them.
    pub const ALL: [Self; 37] = [
        Self::WheelsWithoutLease,
        Self::CleanersWithoutLease,
        Self::NotArmed,
        Self::ResetLoop,
        Self::Bumper,
        Self::BumperStuck,
        Self::Cliff,
        Self::Fallen,
        Self::WheelDrop,
        Self::LiftedJustNow,
        Self::Stall,
        Self::Docked,
        Self::Button,
        Self::CleanersStart,
        Self::ChargeUnsupplied,
        Self::ChargeDriving,
        Self::ChargeTemperature,
        Self::ChargeVoltage,
        Self::ChargeCurrent,
        Self::ChargeTime,
        Self::CliffSpeed,
        Self::CliffDistance,
        Self::Encoder,
        Self::PackEmpty,
        Self::PackWeak,
        Self::PackHot,
        Self::Current,
        Self::TooFast,
        Self::Clock,
        Self::Memory,
        Self::Pulses,
        Self::ReportsSide,
        Self::ReportsCount,
        Self::ReportsCurrent,
        Self::ReportsPack,
        Self::ReportsAbsent,
        Self::ReportsNear,
    ];

    /// Those that a report breaks and no motor, bit by rule.
    pub(crate) const REPORTS: u64 = 1 << Self::ReportsSide as u32
        | 1 << Self::ReportsCount as u32
        | 1 << Self::ReportsCurrent as u32
        | 1 << Self::ReportsPack as u32
        | 1 << Self::ReportsAbsent as u32
        | 1 << Self::ReportsNear as u32;

    /// Rule number and a name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::WheelsWithoutLease => "S1-wheels-without-lease",
            Self::CleanersWithoutLease => "S1-cleaners-without-lease",
            Self::NotArmed => "S4-not-armed",
            Self::ResetLoop => "S4-reset-loop",
            Self::Bumper => "S6-bumper",
            Self::BumperStuck => "S7-bumper-stuck",
            Self::Cliff => "S8-cliff",
            Self::Fallen => "S8-fallen",
            Self::WheelDrop => "S10-wheel-drop",
            Self::LiftedJustNow => "S10-lifted-just-now",
            Self::Stall => "S11-stall",
            Self::Docked => "S19-docked",
            Self::Button => "S28-button",
            Self::CleanersStart => "S29-cleaners-start",
            Self::ChargeUnsupplied => "S18-charge-unsupplied",
            Self::ChargeDriving => "S18-charge-driving",
            Self::ChargeTemperature => "S18-charge-temperature",
            Self::ChargeVoltage => "S18-charge-voltage",
            Self::ChargeCurrent => "S18-charge-current",
            Self::ChargeTime => "S18-charge-time",
            Self::CliffSpeed => "S8-cliff-speed",
            Self::CliffDistance => "S8-cliff-distance",
            Self::Encoder => "S13-encoder",
            Self::PackEmpty => "S16-pack-empty",
            Self::PackWeak => "S16-pack-weak",
            Self::PackHot => "S17-pack-hot",
            Self::Current => "S11-current",
            Self::TooFast => "S12-too-fast",
            Self::Clock => "S20-clock",
            Self::Memory => "S21-memory",
            Self::Pulses => "S21-pulses",
            Self::ReportsSide => "reports-side",
            Self::ReportsCount => "reports-count",
            Self::ReportsCurrent => "reports-current",
            Self::ReportsPack => "reports-pack",
            Self::ReportsAbsent => "reports-absent",
            Self::ReportsNear => "reports-near",
        }
    }
}

/// The beginning of a breach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Which rule.
    pub rule: Rule,
    /// Simulated millisecond.
    pub time_ms: u64,
    /// The pins.
    pub pins: Pins,
    /// The drives of the motors.
    pub drives: Drives,
}

impl Violation {
    pub(crate) const fn new(rule: Rule, time_ms: u64, pins: &Pins, drives: &Drives) -> Self {
        Self {
            rule,
            time_ms,
            pins: *pins,
            drives: *drives,
        }
    }
}

impl core::fmt::Display for Violation {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Pins {
            bumper,
            cliff,
            wheel_drop,
            docked,
            button,
            charging,
            ..
        } = self.pins;
        let standing: Vec<&str> = [
            (bumper, "bumper"),
            (cliff, "cliff"),
            (wheel_drop, "wheel-drop"),
            (docked, "docked"),
            (button, "button"),
            (charging.driven, "charging"),
        ]
        .into_iter()
        .filter_map(|(stands, name)| stands.then_some(name))
        .collect();
        write!(
            formatter,
            "{} at {}.{:03} s: wheels {:?}, cleaners {:?} millionths, pins [{}]",
            self.rule.name(),
            self.time_ms / 1000,
            self.time_ms % 1000,
            self.drives.wheels,
            self.drives.cleaners,
            standing.join(" "),
        )
    }
}

/// A cause in the same millisecond as a start cannot prevent it; one that has lasted for the reaction time can.
const START_MS: u32 = 20;
/// A pass of the firmware's loop and the debouncing of the judge's own clock.
const MARGIN_MS: u32 = 2;

const CHARGE_SLOW_MS: u32 = 2_000;

fn charger_verdicts(standing: &ChargeTimes) -> [(Rule, bool); 6] {
    [
        (Rule::ChargeUnsupplied, standing.unsupplied_ms > CHARGE_MS),
        (Rule::ChargeDriving, standing.driving_ms > CHARGE_MS),
        (Rule::ChargeTemperature, standing.temperature_ms > CHARGE_SLOW_MS),
        (Rule::ChargeVoltage, standing.voltage_ms > CHARGE_SLOW_MS),
        (Rule::ChargeCurrent, standing.current_ms > CHARGE_CURRENT_MS),
        (Rule::ChargeTime, standing.charged_ms > CHARGE_TIME_MS),
    ]
}

/// What the state of encoders and pack forbids; `any` = a motor is driven.
fn state_verdicts(standing: &CauseTimes, any: bool) -> [(Rule, bool); 4] {
    let encoders = &standing.encoders.wrong_ms;
    let standing = &standing.pack;
    [
        (
            Rule::Encoder,
            any && encoders.iter().any(|wrong_ms| *wrong_ms > ENCODER_MS),
        ),
        (Rule::PackEmpty, standing.empty_ms > PACK_EMPTY_MS + MARGIN_MS),
        (Rule::PackWeak, standing.weak_ms > PACK_WEAK_MS + MARGIN_MS),
        (Rule::PackHot, standing.hot_ms > PACK_HOT_MS + MARGIN_MS),
    ]
}

/// What the wheels' motors themselves show.
fn motor_verdicts(standing: &CauseTimes) -> [(Rule, bool); 2] {
    let loads = &standing.loads;
    let lasts = |times: &[u32; 2], limit_ms: u32| times.iter().any(|ms| *ms > limit_ms + MARGIN_MS);
    [
        (
            Rule::Current,
            lasts(&loads.too_much_ms, TOO_MUCH_MS) || lasts(&loads.nearly_held_ms, NEARLY_HELD_MS),
        ),
        (Rule::TooFast, lasts(&loads.too_fast_ms, TOO_FAST_MS)),
    ]
}

/// What a broken machine may no longer do.
const fn hardware_verdicts(hardware: &HardwareTimes) -> [(Rule, bool); 3] {
    [
        (Rule::Clock, hardware.clock_ms > CLOCK_MS + MARGIN_MS),
        (
            Rule::Memory,
            hardware.is_on && hardware.image_ms > MEMORY_MS + MARGIN_MS,
        ),
        (Rule::Pulses, hardware.pulses_ms > PULSES_MS + MARGIN_MS),
    ]
}

/// The rules that are broken now, bit by rule.
pub(crate) fn broken(
    now_ms: u64,
    permission: &HostPermission,
    standing: &CauseTimes,
    drives: &Drives,
) -> u64 {
    let wheels = drives.wheels_on();
    let cleaners = drives.cleaners_on();
    let any = wheels || cleaners;
    let forward = drives.forward();
    // S18: off a dock whose current nothing else can stop, backwards only.
    let leaving = standing.charge.may_leave() && !forward && !cleaners;
    // The press of another occasion does not keep a robot on such a dock.
    let stopped_by_button = permission
        .button_age_ms(now_ms)
        .is_some_and(|age_ms| age_ms > BUTTON_MS && (!leaving || age_ms <= ESCAPE_WARNING_MS));
    let blocked = standing.bumper_ms > START_MS || standing.wheel_drop_ms > START_MS;
    let verdicts = [
        (
            Rule::WheelsWithoutLease,
            !permission.covers_wheels(now_ms, drives) && !leaving,
        ),
        (
            Rule::CleanersWithoutLease,
            !permission.covers_cleaners(now_ms, drives),
        ),
        (Rule::NotArmed, any && !permission.armed(now_ms) && !leaving),
        (Rule::ResetLoop, any && permission.reset_loop()),
        (Rule::Bumper, forward && standing.bumper_ms > BUMPER_MS),
        (
            Rule::BumperStuck,
            any && (standing.bumper_stuck_ms > BUMPER_STUCK_MS + BUMPER_MS
                || standing.bumper_backing_ms > BUMPER_BACKING_MS + BUMPER_MS),
        ),
        (Rule::Cliff, drives.any_forward() && standing.cliff_ms > CLIFF_MS),
        (
            Rule::CliffSpeed,
            standing
                .cliff_haste_ms
                .into_iter()
                .any(|haste_ms| haste_ms > CLIFF_HASTE_MS),
        ),
        (
            Rule::CliffDistance,
            drives.any_backward() && standing.cliff_ms > 0 && standing.cliff_reversed_um > CLIFF_REVERSE_UM,
        ),
        (Rule::Fallen, standing.fallen),
        (Rule::WheelDrop, any && standing.wheel_drop_ms > WHEEL_DROP_MS),
        (
            Rule::LiftedJustNow,
            wheels && standing.grounded_ms + MARGIN_MS < GROUNDED_MS,
        ),
        (
            Rule::Stall,
            standing
                .stalled_ms
                .into_iter()
                .any(|stalled| stalled > STALL_MS + MARGIN_MS),
        ),
        (
            Rule::Docked,
            wheels && standing.docked_ms > DOCKED_MS && !permission.may_undock(now_ms) && !leaving,
        ),
        (Rule::Button, any && stopped_by_button),
        (Rule::CleanersStart, standing.cleaners_start && blocked),
    ];
    bits(verdicts)
        | bits(state_verdicts(standing, any))
        | bits(motor_verdicts(standing))
        | bits(hardware_verdicts(&standing.hardware))
        | broken_by_charger(&standing.charge)
}

/// The rules that the charger breaks now, bit by rule.
pub(crate) fn broken_by_charger(standing: &ChargeTimes) -> u64 {
    bits(charger_verdicts(standing))
}

fn bits(verdicts: impl IntoIterator<Item = (Rule, bool)>) -> u64 {
    verdicts
        .into_iter()
        .filter(|(_, broken)| *broken)
        .fold(0, |bits, (rule, _)| bits | 1 << rule as u32)
}
