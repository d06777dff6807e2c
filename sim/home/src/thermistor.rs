//! A thermistor in a pack and the circuit that reads it, by the equation of data sheets:
//! R = R25 exp(B (1/T - 1/298.15 K)).
//!
//! Nobody knows the part of the SR8730's pack. Makers of 10 k thermistors for packs name 3,380 K, 3,435 K or 3,950 K for B and
//! 1 to 5 % for R25. The board has 10 k across it and 1.5 k to the converter's reference, resistors of 1 %. The converter
//! of the PIC32MX3 has ten bits, an offset of at most 2 and a gain error of at most 4 counts by its data sheet.

use crate::Pcg;

const ROOM_K: f64 = 298.15;
const ZERO_K: f64 = 273.15;
/// Readings of the converter from 0 to its reference.
const COUNTS: f64 = 1_024.0;

/// One thermistor in its circuit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermistor {
    /// B of the data sheet, kelvin.
    pub beta_k: f64,
    /// R25 of the data sheet, kilo-ohm.
    pub room_kohm: f64,
    /// Resistor across it, kilo-ohm.
    pub across_kohm: f64,
    /// Resistor to the reference, kilo-ohm.
    pub supply_kohm: f64,
    /// What the converter adds, counts.
    pub offset_counts: f64,
    /// What the converter multiplies with.
    pub gain: f64,
}

impl Thermistor {
    /// The circuit as it is drawn, with the commonest thermistor and a perfect converter.
    pub const NOMINAL: Self = Self {
        beta_k: 3_435.0,
        room_kohm: 10.0,
        across_kohm: 10.0,
        supply_kohm: 1.5,
        offset_counts: 0.0,
        gain: 1.0,
    };

    /// One of those that can be bought.
    #[must_use]
    pub fn drawn(random: &mut Pcg) -> Self {
        let nominal = Self::NOMINAL;
        Self {
            beta_k: 3_380.0 + 570.0 * random.unit(),
            room_kohm: nominal.room_kohm * (1.0 + 0.05 * random.symmetric()),
            across_kohm: nominal.across_kohm * (1.0 + 0.01 * random.symmetric()),
            supply_kohm: nominal.supply_kohm * (1.0 + 0.01 * random.symmetric()),
            offset_counts: 2.0 * random.symmetric(),
            gain: 1.0 + 4.0 / COUNTS * random.symmetric(),
        }
    }

    /// Mean reading at this temperature, degrees Celsius.
    #[must_use]
    pub fn counts(&self, celsius: f64) -> f64 {
        let kelvin = celsius + ZERO_K;
        let kohm = self.room_kohm * libm::exp(self.beta_k * (1.0 / kelvin - 1.0 / ROOM_K));
        let lower = kohm * self.across_kohm / (kohm + self.across_kohm);
        self.gain * COUNTS * lower / (self.supply_kohm + lower) + self.offset_counts
    }
}

#[cfg(test)]
mod tests {
    use super::Thermistor;
    use crate::Pcg;

    /// Resistance at these temperatures as the table of a 10 k thermistor with B = 3,435 K has it, in kilo-ohm, and the reading
    /// by hand.
    #[test]
    fn readings_follow_a_data_sheet() {
        for (celsius, kohm) in [
            (-10.0, 46.3),
            (0.0, 28.7),
            (25.0, 10.0),
            (50.0, 4.10),
            (60.0, 2.98),
        ] {
            let lower = kohm * 10.0 / (kohm + 10.0);
            let counts = 1_024.0 * lower / (1.5 + lower);
            let shown = Thermistor::NOMINAL.counts(celsius);
            assert!((shown - counts).abs() < 0.5, "{celsius}: {shown}, not {counts}");
        }
    }

    #[test]
    fn no_pack_reads_like_a_broken_wire_and_warmer_is_always_less() {
        for seed in 0..1_000 {
            let thermistor = Thermistor::drawn(&mut Pcg::new(seed, 1));
            assert!(thermistor.counts(-10.0) < 880.0, "{thermistor:?}");
            for tenths in -200..600 {
                let celsius = f64::from(tenths) / 10.0;
                assert!(thermistor.counts(celsius) > thermistor.counts(celsius + 0.1));
            }
        }
    }
}
