//! A NiMH pack under load, on a charger, and with age.
//!
//! *Charge* is what the cells hold, 0 empty, 1 their rated full. A charging current splits: one part is *stored*, the other
//! makes oxygen that recombines to heat. The second part is small until the cells are nearly full and all of the
//! current in the end. From that follow the three termination criteria of chargers: the temperature rises fast (dT/dt),
//! the voltage passes a peak and falls with the temperature (-dV), and it stops rising (0dV).
//!
//! No figure here comes from a data sheet of the SR8730's cells, of which none is known. The shapes are those of
//! makers' curves of sub-C cells; what they leave open is spread over the packs of a campaign (see [`PackMake`]).
//!
//! A pack is lumped: all cells alike, and at most one [`OddCell`]. Heat is kept at three places: the pack, the odd
//! cell, and the sensor, which lags behind.

mod make;
mod supply;

pub use make::{OddCell, PackMake};
pub use supply::Supply;

/// Volts of one resting cell at 0, 10, ... 100 % charge: the usual curve of NiMH at room temperature.
const CELL_V: [f64; 11] = [
    1.00, 1.19, 1.22, 1.235, 1.245, 1.255, 1.265, 1.28, 1.30, 1.335, 1.42,
];
/// Volts that a charge of half the capacity an hour adds to a cell, beyond the resistance.
const POLARIZATION_V: f64 = 0.04;
/// Time constant of that, seconds.
const POLARIZATION_S: f64 = 120.0;
/// Volts that the oxygen adds when all current makes it.
const OXYGEN_V: f64 = 0.045;
/// Volts that a charged cell loses for each degree, at half the capacity an hour.
const WARMTH_V_PER_K: f64 = -0.002_5;
/// Heat of the reaction, watt for each stored ampere and cell.
const REACTION_V: f64 = 0.03;
/// Charge at which half of the current is stored, at 25 degrees and half the capacity an hour.
const HALF_STORED: f64 = 1.0;
/// How sharply that sets in.
const STORING_WIDTH: f64 = 0.016;
/// Hot cells take less: shift of the above for each degree above 30.
const STORING_PER_K: f64 = -0.002_5;
/// So do cells that are charged slowly: shift at no current.
const STORING_SLOW: f64 = -0.04;
/// Temperature at which the voltages above hold, degrees Celsius.
const REFERENCE_C: f64 = 25.0;
/// A cell below empty turns its voltage around quickly, volts for each unit of charge.
const REVERSED_V: f64 = 24.0;
/// Lowest voltage of a reversed cell.
const REVERSED_MIN_V: f64 = -0.3;
/// Volts of one cell that give a model its nominal speeds.
const NOMINAL_CELL_V: f64 = 1.2;
/// Heat from the odd cell to its neighbours, watt per degree.
const NEIGHBOUR_W_PER_K: f64 = 0.45;
const SECONDS_PER_H: f64 = 3_600.0;
const SECONDS_PER_DAY: f64 = 86_400.0;
/// Charge up to which a charge can be hastened.
const HASTE_MAX: f64 = 0.95;

/// A pack.
#[derive(Clone, Debug)]
pub struct Pack {
    make: PackMake,
    ambient_c: f64,
    charge: f64,
    odd_charge: f64,
    polarization_v: f64,
    /// Terminal voltage without the drop over the resistance.
    emf_v: f64,
    current_a: f64,
    temperature_c: f64,
    /// Above the rest of the pack.
    odd_excess_k: f64,
    sensor_c: f64,
}

impl Pack {
    /// A pack at rest with this charge, as warm as what surrounds it.
    #[must_use]
    pub fn new(make: PackMake, charge: f64, ambient_c: f64) -> Self {
        let mut pack = Self {
            odd_charge: make.odd.map_or(0.0, |odd| odd.charge(charge)),
            make,
            ambient_c,
            charge,
            polarization_v: 0.0,
            emf_v: 0.0,
            current_a: 0.0,
            temperature_c: ambient_c,
            odd_excess_k: 0.0,
            sensor_c: ambient_c,
        };
        pack.emf_v = pack.resting_v();
        pack
    }

    /// The pack is warmer or colder than what surrounds it, for example from driving.
    pub fn set_temperature(&mut self, celsius: f64) {
        self.temperature_c = celsius;
        self.sensor_c = celsius;
    }

    /// What surrounds it changes, degrees Celsius.
    pub fn set_ambient(&mut self, celsius: f64) {
        self.ambient_c = celsius;
    }

    /// Advances `dt_s` seconds, at most 2, with this mean current, into the pack positive.
    pub fn step(&mut self, current_a: f64, dt_s: f64) {
        self.current_a = current_a;
        let rate = self.rate(current_a);
        let oxygen = self.oxygen(self.charge, rate);
        let per_as = 1.0 / (SECONDS_PER_H * self.make.capacity_ah);
        let stored_a = if current_a > 0.0 {
            current_a * (1.0 - oxygen)
        } else {
            current_a
        };
        let lost = self.make.self_discharge_per_day * self.charge / SECONDS_PER_DAY * dt_s;
        self.charge = (self.charge + stored_a * dt_s * per_as - lost).clamp(0.0, 1.2);
        let goal_v = if current_a > 0.0 {
            POLARIZATION_V * libm::sqrt(rate / 0.5)
        } else {
            0.0
        };
        self.polarization_v += (goal_v - self.polarization_v) * (dt_s / POLARIZATION_S).min(1.0);
        self.emf_v = self.charging_v(rate, oxygen);
        let odd_w = self.step_odd(current_a, rate, dt_s);
        let heat_w = self.heat_w(current_a - stored_a, stored_a) + odd_w;
        self.temperature_c += heat_w * dt_s / self.make.heat_j_per_k;
        let lag = (dt_s / self.make.sensor_lag_s.max(dt_s)).min(1.0);
        self.sensor_c += (self.temperature_c - self.sensor_c) * lag;
    }

    /// Stores what so many ampere seconds more would store, without their time and heat: for simulations that cannot
    /// wait for a charge. Above `HASTE_MAX` nothing is hastened, so that the signs of a full pack come as they do.
    pub(crate) fn hasten(&mut self, ampere_s: f64) {
        if self.charge < HASTE_MAX {
            let per_as = 1.0 / (SECONDS_PER_H * self.make.capacity_ah);
            self.charge = (self.charge + ampere_s.max(0.0) * per_as).min(HASTE_MAX);
        }
    }

    /// Current in parts of the capacity an hour, while it charges.
    fn rate(&self, current_a: f64) -> f64 {
        (current_a / self.make.capacity_ah).max(0.0)
    }

    /// Share of the charging current that makes oxygen.
    fn oxygen(&self, charge: f64, rate: f64) -> f64 {
        if rate <= 0.0 {
            return 0.0;
        }
        let warm = (self.temperature_c - 30.0).max(0.0) * STORING_PER_K;
        let slow = STORING_SLOW * (1.0 - rate / 0.5).max(0.0);
        let half = HALF_STORED + warm + slow;
        1.0 / (1.0 + libm::exp((half - charge) / STORING_WIDTH))
    }

    /// Sum of the cells without current.
    fn resting_v(&self) -> f64 {
        let cells = f64::from(self.make.cells);
        match self.make.odd {
            None => cells * cell_v(self.charge),
            Some(odd) => (cells - 1.0) * cell_v(self.charge) + odd.volts(cell_v(self.odd_charge)),
        }
    }

    fn charging_v(&self, rate: f64, oxygen: f64) -> f64 {
        if self.polarization_v <= 0.0 && rate <= 0.0 {
            return self.resting_v();
        }
        let warmth_k = self.temperature_c - REFERENCE_C;
        // What warmth takes is part of the polarization, and comes and goes as slowly.
        let polarized = self.polarization_v / POLARIZATION_V;
        let warmth_v = WARMTH_V_PER_K * warmth_k * polarized.min(1.5) * self.make.signs;
        let each_v = self.polarization_v + OXYGEN_V * oxygen * self.make.signs + warmth_v;
        self.resting_v() + each_v * f64::from(self.make.cells)
    }

    /// Advances the odd cell; gives its heat, watt.
    fn step_odd(&mut self, current_a: f64, rate: f64, dt_s: f64) -> f64 {
        let Some(odd) = self.make.odd else {
            return 0.0;
        };
        let capacity_ah = self.make.capacity_ah * odd.capacity_share();
        if capacity_ah <= 0.0 {
            return 0.0;
        }
        let oxygen = self.oxygen(self.odd_charge, rate);
        let stored_a = if current_a > 0.0 {
            current_a * (1.0 - oxygen)
        } else {
            current_a
        };
        self.odd_charge =
            (self.odd_charge + stored_a * dt_s / (SECONDS_PER_H * capacity_ah)).clamp(-0.1, 1.2);
        let heat_w = (current_a - stored_a).max(0.0) * cell_v(self.odd_charge).max(0.0);
        let cell_j_per_k = self.make.heat_j_per_k / f64::from(self.make.cells);
        let flow_w = self.odd_excess_k * NEIGHBOUR_W_PER_K;
        self.odd_excess_k += (heat_w - flow_w) * dt_s / cell_j_per_k;
        // The rest of the pack is heated by what flows over.
        flow_w
    }

    /// Heat of the cells that are alike, less what leaves the pack, watt.
    fn heat_w(&self, wasted_a: f64, stored_a: f64) -> f64 {
        let others = f64::from(self.make.cells) - f64::from(u8::from(self.make.odd.is_some()));
        let oxygen_w = wasted_a.max(0.0) * others * (cell_v(self.charge) + self.polarization_v);
        let reaction_w = stored_a.max(0.0) * others * REACTION_V;
        let joule_w = self.current_a * self.current_a * self.make.resistance_ohm
            + self.current_a.max(0.0) * self.polarization_v * others;
        let cooling_w = (self.temperature_c - self.ambient_c) * self.make.cooling_w_per_k;
        oxygen_w + reaction_w + joule_w - cooling_w
    }

    /// Voltage at the terminals with this current at this moment, into the pack positive.
    #[must_use]
    pub fn terminal_v(&self, current_a: f64) -> f64 {
        (self.emf_v + current_a * self.make.resistance_ohm).max(0.0)
    }

    /// Voltage at the terminals with the current of the last step.
    #[must_use]
    pub fn voltage_v(&self) -> f64 {
        self.terminal_v(self.current_a)
    }

    /// Current of the last step, into the pack positive.
    #[must_use]
    pub const fn current_a(&self) -> f64 {
        self.current_a
    }

    /// What the cells hold, 1 = their rated full; up to 1.2 for a moment.
    #[must_use]
    pub const fn charge(&self) -> f64 {
        self.charge
    }

    /// Mean temperature of the cells, degrees Celsius.
    #[must_use]
    pub const fn temperature_c(&self) -> f64 {
        self.temperature_c
    }

    /// Temperature of the hottest cell, degrees Celsius.
    #[must_use]
    pub fn hottest_c(&self) -> f64 {
        self.temperature_c + self.odd_excess_k.max(0.0)
    }

    /// Temperature of a sensor on the pack, degrees Celsius.
    #[must_use]
    pub const fn sensor_c(&self) -> f64 {
        self.sensor_c
    }

    /// What it is made of.
    #[must_use]
    pub const fn make(&self) -> &PackMake {
        &self.make
    }

    /// Terminal voltage over the nominal one.
    #[must_use]
    pub fn supply(&self) -> f64 {
        self.voltage_v() / (f64::from(self.make.cells) * NOMINAL_CELL_V)
    }
}

/// Volts of one resting cell.
fn cell_v(charge: f64) -> f64 {
    if charge < 0.0 {
        return (CELL_V[0] + charge * REVERSED_V).max(REVERSED_MIN_V);
    }
    let place = charge.min(1.0) * 10.0;
    let index = (place as usize).min(9);
    let (low, high) = (CELL_V[index], CELL_V[index + 1]);
    low + (high - low) * (place - index as f64)
}

#[cfg(test)]
mod tests {
    use super::{OddCell, Pack, PackMake};

    fn charge_for(pack: &mut Pack, current_a: f64, seconds: u32) {
        for _ in 0..seconds {
            pack.step(current_a, 1.0);
        }
    }

    #[test]
    fn the_signs_of_a_full_pack_appear_when_it_is_full() {
        let mut pack = Pack::new(PackMake::NIMH_12, 0.2, 25.0);
        let (mut peak_v, mut at_peak, mut slope_at) = (0.0, 0.0, None);
        let mut drop_at = None;
        for minute in 0..180 {
            let before_c = pack.temperature_c();
            charge_for(&mut pack, 0.95, 60);
            let volts = pack.voltage_v();
            if volts > peak_v {
                (peak_v, at_peak) = (volts, pack.charge());
            }
            if pack.temperature_c() - before_c > 0.9 {
                slope_at.get_or_insert((minute, pack.charge()));
            }
            if peak_v - volts > 0.08 {
                drop_at.get_or_insert((minute, pack.charge()));
                break;
            }
        }
        let (slope_min, slope_charge) = slope_at.unwrap();
        let (drop_min, _) = drop_at.unwrap();
        assert!((0.94..1.03).contains(&slope_charge), "{slope_charge}");
        assert!((0.96..1.06).contains(&at_peak), "{at_peak}");
        assert!(
            slope_min < drop_min && drop_min < slope_min + 20,
            "{slope_min} {drop_min}"
        );
        assert!((17.2..18.2).contains(&peak_v), "{peak_v}");
        assert!(pack.temperature_c() < 48.0);
    }

    #[test]
    fn a_full_pack_that_goes_on_overheats() {
        let mut pack = Pack::new(PackMake::NIMH_12, 1.0, 25.0);
        charge_for(&mut pack, 0.95, 3_600);
        assert!(pack.temperature_c() > 60.0, "{}", pack.temperature_c());
    }

    #[test]
    fn slow_current_into_a_full_pack_stays_bearable() {
        let mut pack = Pack::new(PackMake::NIMH_12, 1.0, 25.0);
        charge_for(&mut pack, 0.2, 5 * 3_600);
        let celsius = pack.temperature_c();
        assert!((34.0..42.0).contains(&celsius), "{celsius}");
    }

    #[test]
    fn a_step_of_a_second_and_steps_of_a_millisecond_agree() {
        let mut coarse = Pack::new(PackMake::NIMH_12, 0.93, 25.0);
        let mut fine = coarse.clone();
        charge_for(&mut coarse, 0.95, 900);
        for _ in 0..900_000 {
            fine.step(0.95, 0.001);
        }
        assert!((coarse.voltage_v() - fine.voltage_v()).abs() < 0.01);
        assert!((coarse.temperature_c() - fine.temperature_c()).abs() < 0.05);
        assert!((coarse.charge() - fine.charge()).abs() < 0.001);
    }

    #[test]
    fn odd_cells_show_in_the_voltage_and_get_hotter() {
        let sound = Pack::new(PackMake::NIMH_12, 0.5, 25.0).voltage_v();
        let dead = PackMake {
            odd: Some(OddCell::Dead),
            ..PackMake::NIMH_12
        };
        let reversed = PackMake {
            odd: Some(OddCell::Weak {
                capacity_share: 0.8,
                behind: 0.6,
            }),
            ..PackMake::NIMH_12
        };
        assert!(sound - Pack::new(dead, 0.5, 25.0).voltage_v() > 1.2);
        assert!(sound - Pack::new(reversed, 0.5, 25.0).voltage_v() > 1.4);
        let weak = PackMake {
            odd: Some(OddCell::Weak {
                capacity_share: 0.7,
                behind: 0.0,
            }),
            ..PackMake::NIMH_12
        };
        let mut pack = Pack::new(weak, 0.2, 25.0);
        charge_for(&mut pack, 0.95, 5_400);
        assert!(
            pack.hottest_c() > pack.temperature_c() + 1.0,
            "{}",
            pack.hottest_c()
        );
    }

    #[test]
    fn a_pack_that_is_left_alone_empties() {
        let make = PackMake {
            self_discharge_per_day: 0.02,
            ..PackMake::NIMH_12
        };
        let mut pack = Pack::new(make, 1.0, 25.0);
        charge_for(&mut pack, 0.0, 86_400);
        assert!((0.979..0.982).contains(&pack.charge()), "{}", pack.charge());
    }
}
