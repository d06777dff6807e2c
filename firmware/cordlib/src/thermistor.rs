//! Temperature of a pack from the reading of its 10 k thermistor, for boards that measure it with a divider and a converter of
//! ten bits.
//!
//! The reciprocal of such a thermistor's absolute temperature is a straight line over the logarithm of its resistance. The line
//! goes through two points that the owner has measured, or through 10 k at 25 °C; its slope is then known to a range only. So
//! is every temperature: a [`TemperatureRange`], which at 0 °C is 4 degrees wide with measured points and 15 degrees without.

use rvac_units::Temperature;

use crate::board::TemperatureRange;

/// Readings are converted in tenths of a count.
const TENTHS: i32 = 10;
/// Full scale in tenths of a count.
const FULL_SCALE: u32 = 10_240;
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

/// The resistors around the thermistor, in ohm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divider {
    /// Across the thermistor, to ground.
    pub across_ohm: u32,
    /// To the converter's reference.
    pub supply_ohm: u32,
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

/// The curve of one pack's thermistor in its divider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThermistorCurve {
    divider: Divider,
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
    pub fn new(divider: Divider, points: Option<MeasuredPoints>) -> Self {
        let measured = points.and_then(|points| Self::through(divider, points));
        measured.unwrap_or(Self {
            divider,
            reciprocal: reciprocal(ROOM_DK),
            logarithms: ROOM_OHM.map(log2),
            slopes: [DOUBLING / BETA[1], DOUBLING / BETA[0]],
            error: ERROR,
        })
    }

    fn through(divider: Divider, points: MeasuredPoints) -> Option<Self> {
        let (cold, warm) = (divider.log2_ohm(points.ice), divider.log2_ohm(points.warm));
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
                divider,
                reciprocal: cold_reciprocal.saturating_add(warm_reciprocal) / 2,
                logarithms: [middle; 2],
                slopes: [slope.saturating_sub(error), slope.saturating_add(error)],
                error: MEASURED_ERROR,
            }
        })
    }

    /// Temperature for a reading of ten bits.
    #[must_use]
    pub fn temperature(&self, reading: u16) -> TemperatureRange {
        let tenths = i32::from(reading).saturating_mul(TENTHS);
        let [cold_log, warm_log] = self.logarithms;
        let [flat, steep] = self.slopes;
        let log2_ohm = |tenths: i32| self.divider.log2_ohm(tenths);
        let above_cold = log2_ohm(tenths.saturating_add(self.error)).saturating_sub(cold_log);
        let above_warm = log2_ohm(tenths.saturating_sub(self.error)).saturating_sub(warm_log);
        TemperatureRange {
            coldest: self.at(above_cold, if above_cold > 0 { steep } else { flat }),
            warmest: self.at(above_warm, if above_warm > 0 { flat } else { steep }),
        }
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

impl Divider {
    /// Logarithm of the thermistor's resistance in ohm for a reading `a` in tenths of a count:
    /// across x supply x a / (10,240 across - (across + supply) a).
    #[inline(never)]
    fn log2_ohm(&self, tenths: i32) -> i32 {
        let tenths = tenths.unsigned_abs();
        let both = self.across_ohm.saturating_mul(self.supply_ohm);
        let rest = self.across_ohm.saturating_mul(FULL_SCALE).saturating_sub(
            self.across_ohm
                .saturating_add(self.supply_ohm)
                .saturating_mul(tenths),
        );
        log2(both).saturating_add(log2(tenths)).saturating_sub(log2(rest))
    }
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
