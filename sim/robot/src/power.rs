//! The charging switch between dock and pack.

use cordlib::board::{ChargeDrive, ChargerReadings, DockRequest, TemperatureRange};
use home::{Supply, World};

use crate::board::PackPins;

/// The home updates the battery at this period, and in this millisecond of it.
const BATTERY_MS: u64 = 10;
const BATTERY_PHASE_MS: u64 = 3;
/// Drop over the shunt, volts for each ampere.
const SHUNT_OHM: f64 = 0.3;

/// The switch of the charger, sound or broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChargeSwitch {
    /// It follows the command.
    #[default]
    Sound,
    /// Its transistor conducts for good.
    Shorted,
}

/// Current that the switch lets into the pack while the robot is docked, ampere.
pub(crate) fn charge_a<O>(switch: ChargeSwitch, pins: &PackPins<O>, world: &World) -> f64 {
    let duty = match (switch, pins.drive) {
        (ChargeSwitch::Shorted, _) => 1.0,
        (ChargeSwitch::Sound, ChargeDrive::Off) => 0.0,
        (ChargeSwitch::Sound, ChargeDrive::Duty(duty)) => duty.as_f64(),
    };
    // If the switch is shorted, the dock gives all the current it can, requested or not.
    let asked = switch == ChargeSwitch::Shorted || pins.request == DockRequest::Current;
    Supply::USUAL.current_a(duty, world.truth().battery_v, asked)
}

/// Readings of the converter. The shunt lies in the charge path only, so the robot's load is not measured.
pub(crate) fn readings(charge_a: f64, world: &World) -> ChargerReadings {
    let sensors = world.sensors();
    let flows = sensors.dock_contacts && world.dock_gives_current();
    let through_a = if flows { charge_a } else { 0.0 };
    let pack_mv = sensors.battery_voltage.0;
    let since_ms = (world.truth().time_ms + BATTERY_MS - BATTERY_PHASE_MS) % BATTERY_MS;
    ChargerReadings {
        pack_mv,
        input_mv: pack_mv.saturating_add((through_a * SHUNT_OHM * 1e3) as i32),
        current_ma: (through_a * 1e3) as i32,
        temperature: Ok(TemperatureRange::exact(sensors.battery_temperature)),
        age_ms: since_ms as u32,
        adapter: sensors.dock_contacts,
    }
}
