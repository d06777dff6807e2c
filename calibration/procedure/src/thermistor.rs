//! The pack's thermistor: whether a third temperature lies on the curve through two.
//!
//! A 10 k thermistor with 10 k across it and 1.5 k to the converter's reference. The reciprocal of its absolute temperature is a
//! straight line over the logarithm of its resistance.

const ACROSS_KOHM: f64 = 10.0;
const SUPPLY_KOHM: f64 = 1.5;
const FULL_SCALE: f64 = 1_024.0;
const ZERO_K: f64 = 273.15;
/// The two points and the third may differ by this much, in tenths of a degree: thermometers and readings are not better.
const TOLERANCE_DC: i64 = 20;
/// Temperatures that tell something of the curve between ice and warm water, in tenths of a degree.
const ROOM_DC: std::ops::RangeInclusive<i64> = 150..=300;

/// Two readings in tenths of a count: in ice water, and in warm water of this temperature in tenths of a degree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoPoints {
    /// In ice water.
    pub(crate) ice: i64,
    /// In warm water.
    pub(crate) warm: i64,
    /// Temperature of that water.
    pub(crate) warm_dc: i64,
}

/// Why a third point proves nothing.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum NoAgreement {
    /// Too near to one of the others.
    #[error("a room of {0} tenths of a degree tells nothing: 15 to 30 degrees do")]
    Room(i64),
    /// No thermistor reads like that.
    #[error(
        "no thermistor has these readings: is the pack plugged in, and was the water as warm as you typed?"
    )]
    Readings,
    /// It lies off the curve.
    #[error(
        "by the two points it is {found_dc} tenths of a degree, not {room_dc}: measure ice and warm water once more, and leave the \
             pack in the room for half a day"
    )]
    Off {
        /// By the curve.
        found_dc: i64,
        /// By the thermometer.
        room_dc: i64,
    },
}

/// The temperature by the curve, in tenths of a degree, if it agrees with the room's; `reading` is in thousandths of a count.
pub(crate) fn agrees(points: TwoPoints, reading: i64, room_dc: i64) -> Result<i64, NoAgreement> {
    if !ROOM_DC.contains(&room_dc) {
        return Err(NoAgreement::Room(room_dc));
    }
    let tenths = |value: i64| log_kohm(value as f64 / 10.0);
    let (cold, warm) = (tenths(points.ice), tenths(points.warm));
    let (cold_per_k, warm_per_k) = (per_kelvin(0), per_kelvin(points.warm_dc));
    let share = (log_kohm(reading as f64 / 1_000.0) - warm) / (cold - warm);
    let celsius = 1.0 / (warm_per_k + share * (cold_per_k - warm_per_k)) - ZERO_K;
    if !(-50.0..100.0).contains(&celsius) || cold - warm < 0.1 {
        return Err(NoAgreement::Readings);
    }
    let found_dc = (celsius * 10.0).round() as i64;
    if (found_dc - room_dc).abs() > TOLERANCE_DC {
        return Err(NoAgreement::Off { found_dc, room_dc });
    }
    Ok(found_dc)
}

fn per_kelvin(deci_celsius: i64) -> f64 {
    1.0 / (deci_celsius as f64 / 10.0 + ZERO_K)
}

/// Logarithm of the thermistor's resistance for a reading.
fn log_kohm(counts: f64) -> f64 {
    let lower = SUPPLY_KOHM * counts / (FULL_SCALE - counts);
    (lower * ACROSS_KOHM / (ACROSS_KOHM - lower)).ln()
}

#[cfg(test)]
mod tests {
    use super::{NoAgreement, TwoPoints, agrees};

    /// B = 3,435 K: 851.7 counts at 0, 804.2 at 20 and 726.0 at 40 degrees.
    const POINTS: TwoPoints = TwoPoints {
        ice: 8_517,
        warm: 7_260,
        warm_dc: 400,
    };

    #[test]
    fn a_third_point_on_the_curve_agrees_and_another_does_not() {
        let found = agrees(POINTS, 804_200, 205).expect("it is 20 degrees");
        assert!((found - 200).abs() <= 1, "{found}");
        let off = agrees(POINTS, 804_200, 240);
        assert!(
            matches!(off, Err(NoAgreement::Off { room_dc: 240, .. })),
            "{off:?}"
        );
        // The bath was ten degrees colder than typed.
        let cold_bath = TwoPoints {
            warm_dc: 450,
            ..POINTS
        };
        assert!(agrees(cold_bath, 804_200, 200).is_err());
    }

    #[test]
    fn readings_that_prove_nothing_are_refused() {
        assert_eq!(agrees(POINTS, 851_700, 0), Err(NoAgreement::Room(0)));
        let same = TwoPoints {
            warm: 8_517,
            ..POINTS
        };
        assert_eq!(agrees(same, 804_200, 200), Err(NoAgreement::Readings));
        assert_eq!(agrees(POINTS, 0, 200), Err(NoAgreement::Readings));
    }
}
