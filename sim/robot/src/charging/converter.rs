//! The converter: counts of the pack with noise, and what the board's firmware makes of them.

use cordlib::board::{TemperatureRange, ThermistorFault};
use cordlib::thermistor::{Divider, MeasuredPoints, ThermistorCurve};
use home::{Pcg, Thermistor};

use super::conditions::Conditions;

/// Millivolts of the pack for one count: 3.3 V, ten bits, a divider of 10.1.
const MV_PER_COUNT: f64 = 3_300.0 / 1_024.0 * 10.1;
/// Milliamperes for one count of the difference of the two voltages, at 0.3 ohm.
const MA_PER_COUNT: f64 = MV_PER_COUNT / 0.3;
/// Readings beyond these are a broken wire or a short.
const OPEN_COUNTS: i32 = 880;
const SHORTED_COUNTS: i32 = 100;
/// The resistors that the board's firmware assumes.
const DIVIDER: Divider = Divider {
    across_ohm: 10_000,
    supply_ohm: 1_500,
};
/// Stream of random numbers of the owner's measurement.
const OWNER: u64 = 0x0E7;
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
    /// What the board's firmware knows of the thermistor.
    curve: ThermistorCurve,
}

impl Converter {
    pub(crate) fn new(conditions: &Conditions, random: Pcg) -> Self {
        let points = conditions
            .calibrated
            .then(|| measured_points(&conditions.thermistor, conditions.seed));
        Self {
            noise_counts: conditions.noise_counts,
            gain: conditions.gain,
            mismatch: conditions.mismatch,
            random,
            curve: ThermistorCurve::new(DIVIDER, points),
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
    pub(crate) fn temperature(&mut self, exact_counts: f64) -> Result<TemperatureRange, ThermistorFault> {
        let counts = self.counts(exact_counts) as i32;
        if counts > OPEN_COUNTS {
            Err(ThermistorFault::Open)
        } else if counts < SHORTED_COUNTS {
            Err(ThermistorFault::Shorted)
        } else {
            Ok(self.curve.temperature(counts as u16))
        }
    }
}

/// What an owner finds with ice, warm water and thermometers: water that is not quite as warm as its thermometer says, and the
/// mean of many readings.
fn measured_points(thermistor: &Thermistor, seed: u64) -> MeasuredPoints {
    let random = &mut Pcg::new(seed, OWNER);
    let mut read = |celsius: f64, error_k: f64| {
        let counts = thermistor.counts(celsius + error_k * random.symmetric());
        ((counts + 0.1 * random.symmetric()) * 10.0).round() as i32
    };
    let (ice, warm_c) = (read(0.0, 0.4), 40.0);
    MeasuredPoints {
        ice,
        warm: read(warm_c, 0.5),
        warm_dc: (warm_c * 10.0) as i32,
    }
}

#[cfg(test)]
mod tests {
    use super::Converter;
    use crate::charging::Conditions;
    use home::{Pcg, Thermistor};

    #[test]
    fn readings_come_back_as_what_they_were_within_a_count() {
        let conditions = Conditions {
            noise_counts: 0.0,
            gain: 0.0,
            mismatch: 0.0,
            thermistor: Thermistor::NOMINAL,
            calibrated: true,
            ..Conditions::healthy(1)
        };
        let mut converter = Converter::new(&conditions, Pcg::new(1, 1));
        for celsius in [5, 20, 35, 50, 60] {
            let celsius = f64::from(celsius);
            let range = converter
                .temperature(Thermistor::NOMINAL.counts(celsius))
                .unwrap();
            let (coldest, warmest) = (range.coldest.as_celsius(), range.warmest.as_celsius());
            assert!(
                coldest < celsius && celsius < warmest && warmest - coldest < 6.0,
                "{celsius}: {range:?}"
            );
        }
        assert!((converter.pack_mv(16.0) - 16_000).abs() <= 33);
        assert!((converter.current_ma(1.0, 16.0) - 1_000).abs() <= 110);
    }
}
