//! The charging circuit and the pack's thermistor, as the converter sees them.
//!
//! Drawn in the original's source: adapter, a P-channel MOSFET that CHARGING_ENABLE closes through an NPN, a shunt of
//! 0.3 ohm, the pack. No inductor and no limiter. What was measured on the maker's firmware fits this picture: pulses
//! of 94 µs (1.5 % at 160 Hz) gave about 250 mA on average, so some 16 to 20 A flow while the switch is closed; pulses
//! of 1.7 µs (3.33 % at 20 kHz) would give half an ampere then, but 1 A was reached, so the switch opens about 1.7 µs
//! late: its gate is pulled up by a resistor only.

use home::Supply;

use super::CYCLES_PER_S;
use super::calibration::Particulars;

/// Shunt, ohm.
const SHUNT_OHM: f64 = 0.3;
/// What is behind the contacts: the same as the home's own charger has.
const SUPPLY: Supply = Supply::USUAL;
/// What its capacitors give at once, coulomb: 1000 µF that may sag by 5 V.
const RESERVOIR_C: f64 = 0.005;
/// How late the switch opens, cycles.
const OPENS_LATE: f64 = 136.0;
/// Cycles of a pulse of 3.33 % at 20 kHz.
const PULSE: f64 = 133.0;
/// Period of the charger's PWM, cycles: at most one pulse a slice.
pub(super) const SLICE: u64 = 4_000;
/// Time constant of the filters at the two converter inputs, seconds. Not recorded; the original measured in the quiet
/// part of the envelope, so it is well below a millisecond, and the mean of pulses of 20 kHz can be seen, so it is
/// above 50 µs.
const FILTER_S: f64 = 0.000_2;

/// Current of the charging circuit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ChargeCurrent {
    /// As the filters show it, ampere.
    filtered_a: f64,
    /// Left in the supply's capacitors, coulomb.
    reservoir_c: f64,
    /// Sum over the slices of the present millisecond, ampere times cycles.
    sum: f64,
    cycles: u64,
}

/// Commands of the charging switch in an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SwitchUse {
    /// Length of the stretch, cycles.
    pub(super) cycles: u64,
    /// For so many of them it was to be closed.
    pub(super) closed: u64,
    /// Number of commands to open.
    pub(super) openings: u32,
}

/// What is on the contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Feed {
    /// Nothing.
    Absent,
    /// A dock that was not asked for current, or an adapter: gives at most this, ampere.
    Limited(f64),
    /// A dock that was.
    Full,
}

impl Feed {
    fn limit_a(self) -> f64 {
        match self {
            Self::Absent => 0.0,
            Self::Limited(limit_a) => limit_a,
            Self::Full => SUPPLY.limit_a,
        }
    }
}

impl ChargeCurrent {
    /// The switch did this, and the pack had this voltage.
    pub(super) fn pass(&mut self, switch: SwitchUse, supply: Feed, pack_v: f64) {
        let cycles = switch.cycles;
        let closed = switch.closed as f64 + f64::from(switch.openings) * OPENS_LATE;
        let share = (closed / cycles as f64).min(1.0);
        // The home's supply gives the resistance for the mean of all pulses; this is that of a closed switch.
        let closed_ohm = SUPPLY.series_ohm * (PULSE + OPENS_LATE) / SLICE as f64;
        let driven_a = ((SUPPLY.open_v - pack_v) / closed_ohm).max(0.0);
        let passed_s = cycles as f64 / CYCLES_PER_S as f64;
        let current_a = self.supplied_a(share * driven_a, supply, passed_s);
        let follows = 1.0 - (-passed_s / FILTER_S).exp();
        self.filtered_a += (current_a - self.filtered_a) * follows;
        self.sum += current_a * cycles as f64;
        self.cycles += cycles;
    }

    /// What the supply can give of this current for so long.
    fn supplied_a(&mut self, wanted_a: f64, supply: Feed, passed_s: f64) -> f64 {
        let there_c = self.reservoir_c + supply.limit_a() * passed_s;
        let given_c = there_c.min(wanted_a * passed_s);
        self.reservoir_c = (there_c - given_c).min(match supply {
            Feed::Full => RESERVOIR_C,
            Feed::Absent | Feed::Limited(_) => 0.0,
        });
        given_c / passed_s
    }

    /// Mean current since the last call, ampere.
    pub(super) fn take_mean_a(&mut self) -> f64 {
        let mean_a = if self.cycles == 0 {
            0.0
        } else {
            self.sum / self.cycles as f64
        };
        (self.sum, self.cycles) = (0.0, 0);
        mean_a
    }

    /// Drop over the shunt as the converter sees it, volts.
    pub(super) fn shunt_v(&self) -> f64 {
        self.filtered_a * SHUNT_OHM
    }

    /// Whether the filters still have to follow.
    pub(super) fn is_flowing(&self) -> bool {
        self.filtered_a > 1e-4
    }
}

/// Reading of a divider at this voltage.
pub(super) fn divider_counts(volts: f64, particulars: &Particulars) -> f64 {
    volts * 1e6 / f64::from(particulars.battery_scale.max(1))
}

#[cfg(test)]
mod tests {
    use super::{ChargeCurrent, Feed, SLICE, SwitchUse};

    fn pulse(closed: u64) -> SwitchUse {
        SwitchUse {
            cycles: SLICE,
            closed,
            openings: u32::from(closed != 0 && closed != SLICE),
        }
    }

    /// Mean current of an envelope of 20 ms with so many periods of 133 counts.
    fn envelope_a(pulses: u64, supply: Feed) -> f64 {
        let mut current = ChargeCurrent::default();
        for period in 0..400 {
            let closed = if period < pulses { 133 } else { 0 };
            current.pass(pulse(closed), supply, 16.0);
        }
        current.take_mean_a()
    }

    #[test]
    fn the_maker_s_duties_give_the_maker_s_currents() {
        let mut current = ChargeCurrent::default();
        // 160 Hz at 1.5 %: the first two of 125 slices hold a pulse of 7,500 cycles.
        for slice in 0..1_250 {
            let closed = [SLICE, 3_500].get(slice % 125).copied().unwrap_or(0);
            current.pass(pulse(closed), Feed::Full, 16.0);
        }
        let slow_a = current.take_mean_a();
        assert!((0.25..0.36).contains(&slow_a), "{slow_a}");
        let full_a = envelope_a(380, Feed::Full);
        assert!((1.3..1.45).contains(&full_a), "{full_a}");
        let half_a = envelope_a(190, Feed::Full);
        assert!((half_a * 2.0 - full_a).abs() < 0.01);
    }

    #[test]
    fn a_dock_that_was_not_asked_gives_little_and_no_dock_nothing() {
        assert!(envelope_a(380, Feed::Limited(0.02)) <= 0.02);
        assert_eq!(envelope_a(380, Feed::Absent), 0.0);
    }

    #[test]
    fn the_quiet_part_of_an_envelope_shows_the_pack_alone() {
        let mut current = ChargeCurrent::default();
        for _ in 0..380 {
            current.pass(pulse(133), Feed::Full, 16.0);
        }
        assert!((0.35..0.5).contains(&current.shunt_v()), "{}", current.shunt_v());
        for _ in 0..20 {
            current.pass(pulse(0), Feed::Full, 16.0);
        }
        assert!(current.shunt_v() < 0.005);
    }

    #[test]
    fn a_switch_that_is_stuck_gives_what_the_supply_can() {
        let mut current = ChargeCurrent::default();
        for _ in 0..2_000 {
            current.pass(pulse(SLICE), Feed::Full, 16.0);
        }
        let mean_a = current.take_mean_a();
        assert!((1.49..1.55).contains(&mean_a), "{mean_a}");
    }
}
