//! The converter: counts of the pack with noise, and their conversion back to units.

use cordlib::board::ThermistorFault;
use home::Pcg;
use rvac_units::Temperature;

/// Millivolts of the pack for one count: 3.3 V, ten bits, a divider of 10.1.
const MV_PER_COUNT: f64 = 3_300.0 / 1_024.0 * 10.1;
/// Milliamperes for one count of the difference of the two voltages, at 0.3 ohm.
const MA_PER_COUNT: f64 = MV_PER_COUNT / 0.3;
/// Readings beyond these are a broken wire or a short.
const OPEN_COUNTS: i32 = 880;
const SHORTED_COUNTS: i32 = 100;
const COUNTS: usize = 1_024;
/// Conversions of an envelope that are not disturbed by the switch: a board that converts once a millisecond has up to
/// twenty.
const CONVERSIONS: u32 = 4;
/// Noise that hides the steps.
const DITHERING_COUNTS: f64 = 0.5;

/// One converter with its dividers.
#[derive(Clone, Debug)]
pub(crate) struct Converter {
    /// Noise of a reading, counts, one standard deviation.
    noise_counts: f64,
    /// Error of the pack's divider, relative.
    gain: f64,
    /// Mismatch of the charger's divider to the pack's, relative: it shows a current where none flows.
    mismatch: f64,
    random: Pcg,
    /// Tenths of a degree for each count, as the board's formula has it.
    tenths: Box<[i16; COUNTS]>,
}

impl Converter {
    pub(crate) fn new(noise_counts: f64, gain: f64, mismatch: f64, random: Pcg) -> Self {
        let mut tenths = Box::new([0; COUNTS]);
        for (counts, place) in tenths.iter_mut().enumerate() {
            *place = (celsius_of(counts as f64) * 10.0).round().clamp(-500.0, 1_500.0) as i16;
        }
        Self {
            noise_counts,
            gain,
            mismatch,
            random,
            tenths,
        }
    }

    fn counts(&mut self, exact: f64) -> f64 {
        (exact + self.noise_counts * self.random.normal())
            .round()
            .clamp(0.0, 1_023.0)
    }

    /// Mean of the conversions of an envelope.
    fn mean_counts(&mut self, exact: f64) -> f64 {
        if self.noise_counts >= DITHERING_COUNTS {
            // With enough noise the converter's steps act as noise too, and one draw is enough for all conversions.
            let variance = self.noise_counts * self.noise_counts + 1.0 / 12.0;
            let deviation = (variance / f64::from(CONVERSIONS)).sqrt();
            return (exact + deviation * self.random.normal()).clamp(0.0, 1_023.0);
        }
        let sum: f64 = (0..CONVERSIONS).map(|_| self.counts(exact)).sum();
        sum / f64::from(CONVERSIONS)
    }

    /// Voltage of the pack, mV.
    pub(crate) fn pack_mv(&mut self, volts: f64) -> i32 {
        let exact = volts * 1_000.0 * (1.0 + self.gain) / MV_PER_COUNT;
        (self.mean_counts(exact) * MV_PER_COUNT) as i32
    }

    /// Current through the shunt, mA: two readings, each with its noise and its steps.
    pub(crate) fn current_ma(&mut self, amperes: f64, pack_v: f64) -> i32 {
        let pack = pack_v * 1_000.0 / MV_PER_COUNT;
        let exact = (pack + amperes * 1_000.0 / MA_PER_COUNT) * (1.0 + self.mismatch);
        let difference = self.mean_counts(exact) - self.mean_counts(pack);
        (difference * MA_PER_COUNT) as i32
    }

    /// Temperature by the thermistor's reading.
    pub(crate) fn temperature(&mut self, exact_counts: f64) -> Result<Temperature, ThermistorFault> {
        let counts = self.counts(exact_counts) as i32;
        if counts > OPEN_COUNTS {
            Err(ThermistorFault::Open)
        } else if counts < SHORTED_COUNTS {
            Err(ThermistorFault::Shorted)
        } else {
            let tenths = self.tenths.get(counts as usize).copied().unwrap_or_default();
            Ok(Temperature(tenths))
        }
    }
}

/// Resistance of the thermistor, kilo-ohm, by the inverse of the board's formula; below 5 degrees, where that has its
/// pole, it goes on rising by 6 % a degree as such thermistors do.
fn thermistor_kohm(celsius: f64) -> f64 {
    let formula = |celsius: f64| {
        (42.429_470_166_511_1 / (celsius + 0.966_249_433_923_487) - 0.307_073_187_406_113)
            / 0.129_333_893_760_934
    };
    if celsius >= 5.0 {
        formula(celsius).max(0.05)
    } else {
        formula(5.0) * (0.06 * (5.0 - celsius)).exp()
    }
}

/// Reading of the thermistor, parallel to 10 kilo-ohm, with 1.5 kilo-ohm to the supply.
pub(crate) fn thermistor_counts(celsius: f64) -> f64 {
    let sensor = thermistor_kohm(celsius);
    let lower = sensor * 10.0 / (sensor + 10.0);
    1_024.0 * lower / (1.5 + lower)
}

/// The inverse, by bisection.
fn celsius_of(counts: f64) -> f64 {
    let (mut low, mut high) = (-50.0, 150.0);
    for _ in 0..40 {
        let middle = f64::midpoint(low, high);
        if thermistor_counts(middle) > counts {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::{Converter, thermistor_counts};
    use home::Pcg;

    #[test]
    fn readings_come_back_as_what_they_were_within_a_count() {
        let mut converter = Converter::new(0.0, 0.0, 0.0, Pcg::new(1, 1));
        for celsius in [5, 20, 35, 50, 60] {
            let read = converter
                .temperature(thermistor_counts(f64::from(celsius)))
                .unwrap();
            assert!(
                (read.as_celsius() - f64::from(celsius)).abs() < 0.6,
                "{celsius}: {read:?}"
            );
        }
        assert!((converter.pack_mv(16.0) - 16_000).abs() <= 33);
        assert!((converter.current_ma(1.0, 16.0) - 1_000).abs() <= 110);
    }
}
