//! A NiMH pack under load and on the dock.

use crate::model;

/// Volts of one resting cell at 0, 10, ... 100 % charge: the usual curve of NiMH at room temperature.
const CELL_V: [f64; 11] = [
    1.00, 1.19, 1.22, 1.235, 1.245, 1.255, 1.265, 1.28, 1.30, 1.335, 1.42,
];
/// Volts that a charge adds to a cell, beyond the resistance.
const CHARGE_CELL_V: f64 = 0.06;
/// Volts of one cell that give a model its nominal speeds.
const NOMINAL_CELL_V: f64 = 1.2;
/// Heat capacity of the pack, joule per degree: 12 cells of 55 g at 0.9 J per gram and degree.
const HEAT_J_PER_K: f64 = 600.0;
/// Heat that leaves the pack, watt per degree above the room.
const COOLING_W_PER_K: f64 = 0.25;
/// Temperature of the room, degrees Celsius.
const ROOM_C: f64 = 22.0;
/// Charging beyond this charge turns into heat.
const FULL: f64 = 0.995;

/// The pack.
#[derive(Clone, Debug)]
pub(crate) struct Battery {
    part: model::Battery,
    /// 0..1.
    pub(crate) charge: f64,
    /// At the terminals.
    pub(crate) voltage_v: f64,
    /// Into the pack positive.
    pub(crate) current_a: f64,
    /// Degrees Celsius.
    pub(crate) temperature_c: f64,
}

impl Battery {
    pub(crate) fn new(part: model::Battery, charge: f64) -> Self {
        let mut battery = Self {
            part,
            charge,
            voltage_v: 0.0,
            current_a: 0.0,
            temperature_c: ROOM_C,
        };
        battery.step(0.0, 0.0, 0.0);
        battery
    }

    /// Advances `dt_s` seconds with this load and this current from the dock, both in ampere.
    pub(crate) fn step(&mut self, load_a: f64, dock_a: f64, dt_s: f64) {
        self.current_a = dock_a - load_a;
        let stored_a = if self.current_a > 0.0 && self.charge >= FULL {
            0.0
        } else {
            self.current_a
        };
        let change = stored_a * dt_s / (3600.0 * self.part.capacity_ah);
        self.charge = (self.charge + change).clamp(0.0, 1.0);
        let cells = f64::from(self.part.cells);
        let lift_v = if self.current_a > 0.0 {
            CHARGE_CELL_V * cells
        } else {
            0.0
        };
        self.voltage_v =
            (cells * self.cell_v() + lift_v + self.current_a * self.part.resistance_ohm).max(0.0);
        self.heat(stored_a, dt_s);
    }

    fn heat(&mut self, stored_a: f64, dt_s: f64) {
        let wasted_w = (self.current_a - stored_a) * self.voltage_v;
        let joule_w = self.current_a * self.current_a * self.part.resistance_ohm;
        let cooling_w = (self.temperature_c - ROOM_C) * COOLING_W_PER_K;
        self.temperature_c += (wasted_w + joule_w - cooling_w) * dt_s / HEAT_J_PER_K;
    }

    fn cell_v(&self) -> f64 {
        let place = self.charge * 10.0;
        let index = (place as usize).min(9);
        let (low, high) = (CELL_V[index], CELL_V[index + 1]);
        low + (high - low) * (place - index as f64)
    }

    /// Terminal voltage over the nominal one.
    pub(crate) fn supply(&self) -> f64 {
        self.voltage_v / (f64::from(self.part.cells) * NOMINAL_CELL_V)
    }
}
