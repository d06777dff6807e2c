//! Temperature of the battery pack.
//!
//! A 10 k NTC in the pack, 10 k across it, 1.5 k to 3.3 V (AVDD), read as AN4. The reciprocal of such a thermistor's absolute
//! temperature is a straight line over the logarithm of its resistance. The line goes through two points that the owner has
//! measured, or through 10 k at 25 °C; its slope is then known to a range only. So is every temperature: a
//! [`TemperatureRange`], which at 0 °C is 5 degrees wide with measured points and 20 degrees without.

use cordlib::board::TemperatureRange;
use rvac_units::Temperature;

/// Readings above this mean that the thermistor is not connected: the divider alone gives 890.
const OPEN_ABOVE: u16 = 880;
/// Readings below this mean a short circuit: about 150 degrees.
const SHORT_BELOW: u16 = 100;
/// Readings are converted in tenths of a count.
const TENTHS: i32 = 10;
/// 0 °C in tenths of a kelvin.
const ZERO_DK: i32 = 2_731;
/// 25 °C in tenths of a kelvin.
const ROOM_DK: i32 = 2_981;
/// Unit of reciprocals: this much over tenths of a kelvin.
const RECIPROCAL: u32 = 4_000_000_000;
/// What a doubling of the resistance adds to the reciprocal, times beta in kelvin: ln 2 / 2.5e-9.
const DOUBLING: i32 = 277_258_872;
/// The betas of common 10 k thermistors, in kelvin.
const BETA: [i32; 2] = [3_380, 3_950];
/// Resistance at 25 °C, in ohm: 10 k within 5 %.
const ROOM_OHM: [u32; 2] = [9_500, 10_500];
/// Error of a reading without measured points, in tenths of a count: resistors of 1 %, and the converter's own offset and gain.
const ERROR: i32 = 80;
/// The same with measured points, which take most of it away.
const MEASURED_ERROR: i32 = 20;
/// Error of the slope between two measured points, in hundredths.
const SLOPE_ERROR: i32 = 4;
/// One doubling in the unit of logarithms.
const ONE: i32 = 1 << 12;

/// An implausible thermistor reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Implausible {
    /// Not connected; carries the reading.
    Open(u16),
    /// Shorted; carries the reading.
    Short(u16),
}

/// Two readings at known temperatures, in tenths of a count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeasuredPoints {
    /// In ice water.
    pub ice: i32,
    /// In warm water.
    pub warm: i32,
    /// Temperature of that water, in tenths of a degree.
    pub warm_dc: i32,
}

/// The curve of one pack's thermistor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThermistorCurve {
    /// Reciprocal where the lines cross.
    reciprocal: i32,
    /// Logarithm of the resistance there, for the coldest and the warmest line.
    logarithms: [i32; 2],
    /// Least and greatest rise of the reciprocal with a doubling of the resistance.
    slopes: [i32; 2],
    error: i32,
}

impl ThermistorCurve {
    /// The curve through these points; without them the range of all curves that a 10 k thermistor may have.
    #[must_use]
    pub fn new(points: Option<MeasuredPoints>) -> Self {
        points.and_then(Self::through).unwrap_or(Self {
            reciprocal: reciprocal(ROOM_DK),
            logarithms: ROOM_OHM.map(log2),
            slopes: [DOUBLING / BETA[1], DOUBLING / BETA[0]],
            error: ERROR,
        })
    }

    fn through(points: MeasuredPoints) -> Option<Self> {
        let (cold, warm) = (log2_ohm(points.ice), log2_ohm(points.warm));
        let (cold_reciprocal, warm_reciprocal) = (
            reciprocal(ZERO_DK),
            reciprocal(ZERO_DK.saturating_add(points.warm_dc)),
        );
        let rise = cold_reciprocal.saturating_sub(warm_reciprocal);
        let slope = rise.saturating_mul(ONE).checked_div(cold.saturating_sub(warm))?;
        let beta = DOUBLING.checked_div(slope)?;
        // A pair of points that no such thermistor has is no measurement.
        (BETA[0] - 400..=BETA[1] + 400).contains(&beta).then(|| {
            let middle = cold.saturating_add(warm) / 2;
            let error = slope.saturating_mul(SLOPE_ERROR) / 100;
            Self {
                reciprocal: cold_reciprocal.saturating_add(warm_reciprocal) / 2,
                logarithms: [middle; 2],
                slopes: [slope.saturating_sub(error), slope.saturating_add(error)],
                error: MEASURED_ERROR,
            }
        })
    }

    /// Temperature for a 10-bit reading of AN4.
    ///
    /// # Errors
    /// [`Implausible`] for readings that no pack gives.
    pub fn temperature(&self, reading: u16) -> Result<TemperatureRange, Implausible> {
        if reading > OPEN_ABOVE {
            return Err(Implausible::Open(reading));
        }
        if reading < SHORT_BELOW {
            return Err(Implausible::Short(reading));
        }
        let tenths = i32::from(reading).saturating_mul(TENTHS);
        let [cold_log, warm_log] = self.logarithms;
        let [flat, steep] = self.slopes;
        let above_cold = log2_ohm(tenths.saturating_add(self.error)).saturating_sub(cold_log);
        let above_warm = log2_ohm(tenths.saturating_sub(self.error)).saturating_sub(warm_log);
        Ok(TemperatureRange {
            coldest: self.at(above_cold, if above_cold > 0 { steep } else { flat }),
            warmest: self.at(above_warm, if above_warm > 0 { flat } else { steep }),
        })
    }

    #[inline(never)]
    fn at(&self, above: i32, slope: i32) -> Temperature {
        let reciprocal = self
            .reciprocal
            .saturating_add(slope.saturating_mul(above) / ONE)
            .max(1);
        let tenths = (RECIPROCAL / reciprocal.unsigned_abs()).cast_signed();
        Temperature(i16::try_from(tenths.saturating_sub(ZERO_DK)).unwrap_or(i16::MAX))
    }
}

fn reciprocal(deci_kelvin: i32) -> i32 {
    (RECIPROCAL / deci_kelvin.unsigned_abs().max(1)).cast_signed()
}

/// Logarithm of the resistance in ohm for a reading in tenths of a count: 10 k times 1.5 a / (10 x 1024 - 11.5 a).
#[inline(never)]
fn log2_ohm(tenths: i32) -> i32 {
    // 920..=8,880: both products stay below 2^29 and above 0.
    let tenths = tenths.unsigned_abs().min(8_890);
    log2(tenths.saturating_mul(30_000)).saturating_sub(log2(204_800_u32.saturating_sub(tenths.saturating_mul(23))))
}

/// Binary logarithm in 4,096ths, by chords over eighths of each doubling.
#[inline(never)]
fn log2(number: u32) -> i32 {
    const CHORDS: [i32; 9] = [0, 696, 1_319, 1_882, 2_396, 2_869, 3_307, 3_715, 4_096];
    let number = number.max(1);
    let whole = number.ilog2();
    // The bits below the highest one: three say which chord, twelve say where on it.
    let mantissa = (number << (31 - whole)) << 1;
    let place = (mantissa >> 29) as usize;
    let along = (mantissa >> 17 & 0xFFF).cast_signed();
    let (Some(from), Some(to)) = (CHORDS.get(place), CHORDS.get(place + 1)) else {
        return 0;
    };
    whole.cast_signed() * ONE + from + (to - from) * along / ONE
}

#[cfg(test)]
mod tests {
    use super::{Implausible, MeasuredPoints, ThermistorCurve};
    use std::vec::Vec;

    /// A thermistor with its resistors by the data sheets' equation: beta in kelvin, resistance at 25 °C, the one across it and
    /// the one to the supply in kilo-ohm, and the converter's offset.
    #[derive(Clone, Copy, Debug)]
    struct Sensor {
        beta: f64,
        room: f64,
        across: f64,
        supply: f64,
        offset: f64,
    }

    const NOMINAL: Sensor = Sensor {
        beta: 3_435.0,
        room: 10.0,
        across: 10.0,
        supply: 1.5,
        offset: 0.0,
    };

    impl Sensor {
        fn counts(&self, celsius: f64) -> f64 {
            let kelvin = celsius + 273.15;
            let resistance = self.room * (self.beta * (1.0 / kelvin - 1.0 / 298.15)).exp();
            let lower = resistance * self.across / (resistance + self.across);
            1_024.0 * lower / (lower + self.supply) + self.offset
        }

        fn points(&self) -> MeasuredPoints {
            MeasuredPoints {
                ice: (self.counts(0.0) * 10.0).round() as i32,
                warm: (self.counts(40.0) * 10.0).round() as i32,
                warm_dc: 400,
            }
        }
    }

    /// The corners of what can be bought.
    fn sensors() -> Vec<Sensor> {
        let corners = 0..32_u32;
        corners
            .map(|corner| {
                let pick = |bit: u32, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
                Sensor {
                    beta: pick(0, 3_380.0, 3_950.0),
                    room: pick(1, 9.5, 10.5),
                    across: pick(2, 9.9, 10.1),
                    supply: pick(3, 1.485, 1.515),
                    offset: pick(4, -3.0, 3.0),
                }
            })
            .collect()
    }

    const TEMPERATURES: [f64; 13] = [
        -10.0, -5.0, 0.0, 5.0, 10.0, 20.0, 25.0, 30.0, 40.0, 45.0, 50.0, 55.0, 60.0,
    ];

    /// The range that a curve gives for a reading between two counts, as an average of many readings has it.
    fn range(curve: &ThermistorCurve, counts: f64) -> (f64, f64) {
        let below = curve.temperature(counts.floor() as u16).unwrap();
        let above = curve.temperature(counts.ceil() as u16).unwrap();
        let share = counts - counts.floor();
        let mix = |low: f64, high: f64| low + (high - low) * share;
        (
            mix(below.coldest.as_celsius(), above.coldest.as_celsius()),
            mix(below.warmest.as_celsius(), above.warmest.as_celsius()),
        )
    }

    #[test]
    fn without_measured_points_no_thermistor_is_outside_of_its_range() {
        let curve = ThermistorCurve::new(None);
        for sensor in sensors() {
            for celsius in TEMPERATURES {
                let (coldest, warmest) = range(&curve, sensor.counts(celsius));
                assert!(coldest <= celsius + 0.05, "{sensor:?} at {celsius}: {coldest}");
                assert!(warmest >= celsius - 0.05, "{sensor:?} at {celsius}: {warmest}");
            }
        }
    }

    #[test]
    fn with_measured_points_the_range_is_narrow_and_holds_the_truth() {
        for sensor in sensors() {
            let curve = ThermistorCurve::new(Some(sensor.points()));
            for celsius in TEMPERATURES {
                let (coldest, warmest) = range(&curve, sensor.counts(celsius));
                assert!(coldest <= celsius && celsius <= warmest, "{sensor:?} at {celsius}: {coldest} to {warmest}");
                let wide = if celsius < 0.0 { 9.0 } else { 6.0 };
                assert!(warmest - coldest < wide, "{sensor:?} at {celsius}: {coldest} to {warmest}");
            }
        }
    }

    #[test]
    fn the_middle_of_a_measured_range_follows_the_equation() {
        let curve = ThermistorCurve::new(Some(NOMINAL.points()));
        for celsius in TEMPERATURES {
            let (coldest, warmest) = range(&curve, NOMINAL.counts(celsius));
            let middle = f64::midpoint(coldest, warmest);
            assert!((middle - celsius).abs() < 0.6, "{celsius}: {middle}");
        }
    }

    #[test]
    fn points_that_no_thermistor_has_are_not_used() {
        let bad = [
            (8_517, 8_517, 400),
            (8_517, 8_600, 400),
            (8_517, 7_260, 150),
            (8_517, 6_000, 400),
        ];
        for (ice, warm, warm_dc) in bad {
            let points = MeasuredPoints { ice, warm, warm_dc };
            assert_eq!(ThermistorCurve::new(Some(points)), ThermistorCurve::new(None), "{points:?}");
        }
    }

    #[test]
    fn hotter_is_always_a_lower_reading() {
        for curve in [None, Some(NOMINAL.points())].map(ThermistorCurve::new) {
            for reading in 100..880 {
                let [here, next] = [reading, reading + 1].map(|reading| curve.temperature(reading).unwrap());
                assert!(here.coldest >= next.coldest && here.warmest >= next.warmest);
                assert!(here.coldest <= here.warmest);
            }
        }
    }

    #[test]
    fn broken_wires_are_told_apart() {
        let curve = ThermistorCurve::new(None);
        assert_eq!(curve.temperature(890), Err(Implausible::Open(890)));
        assert_eq!(curve.temperature(1023), Err(Implausible::Open(1023)));
        assert_eq!(curve.temperature(0), Err(Implausible::Short(0)));
        assert_eq!(curve.temperature(99), Err(Implausible::Short(99)));
    }
}
