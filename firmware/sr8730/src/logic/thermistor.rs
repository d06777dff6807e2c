//! Temperature of the battery pack.
//!
//! A 10 k NTC in the pack, 10 k across it, 1.5 k to 3.3 V (AVDD), read as AN4. The original's author fitted this curve
//! to measured points:
//! R = 1.5 / (1024/a - 1.15) kilo-ohm, T = -0.966 + 42.4294 / (0.129334 R + 0.307073) degrees Celsius.
//! With the first put into the second, T = -0.966 + 42.4294 (1024 - 1.15 a) / (314.443 - 0.159133 a): one division.
//! Between 0 and 10 degrees one count is more than a degree; the curve has not been checked on a second robot.

use rvac_units::Temperature;

/// Readings above this mean that the thermistor is not connected: the divider alone gives 890.
const OPEN_ABOVE: u16 = 880;
/// Readings below this mean a short circuit: about 150 degrees.
const SHORT_BELOW: u16 = 100;

/// An implausible thermistor reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Implausible {
    /// Not connected; carries the reading.
    Open(u16),
    /// Shorted; carries the reading.
    Short(u16),
}

/// Temperature for a 10-bit reading of AN4.
///
/// # Errors
/// [`Implausible`] for readings that no pack gives.
pub const fn temperature(reading: u16) -> Result<Temperature, Implausible> {
    if reading > OPEN_ABOVE {
        return Err(Implausible::Open(reading));
    }
    if reading < SHORT_BELOW {
        return Err(Implausible::Short(reading));
    }
    // 100..=880: the numerator stays below 3.9e8, the denominator between 17,000 and 30,000.
    let reading = reading as i32;
    let numerator = 4_243 * (102_400 - 115 * reading);
    let denominator = (3_144_430 - 1_591 * reading) / 100;
    // Thousandths of a tenth over hundredths of a unit: a tenth of a degree, rounded, less 0.97 degrees.
    let tenths = (numerator / 10 + denominator / 2) / denominator - 10;
    Ok(Temperature(tenths as i16))
}

#[cfg(test)]
mod tests {
    use super::{Implausible, temperature};

    /// Points of the table that the author's measurements gave: degrees and reading.
    const TABLE: [(f64, u16); 12] = [
        (5.0, 869),
        (10.0, 850),
        (15.0, 831),
        (20.0, 811),
        (25.0, 790),
        (30.0, 768),
        (35.0, 746),
        (40.0, 723),
        (45.0, 699),
        (50.0, 674),
        (55.0, 648),
        (60.0, 621),
    ];

    #[test]
    fn the_table_is_met_within_half_a_count() {
        for (celsius, reading) in TABLE {
            let found = temperature(reading).unwrap().as_celsius();
            assert!(
                (found - celsius).abs() <= 0.25,
                "{reading}: {found} for {celsius}"
            );
        }
    }

    #[test]
    fn integers_follow_the_formula_in_real_numbers() {
        for reading in 100..=880_u16 {
            let resistance = 1.5 / (1_024.0 / f64::from(reading) - 1.15);
            let celsius = -0.966_249_433_923_487
                + 42.429_420_966_511_1 / (0.129_333_893_760_934 * resistance + 0.307_073_187_406_113);
            let found = temperature(reading).unwrap().as_celsius();
            assert!((found - celsius).abs() <= 0.1, "{reading}: {found} for {celsius}");
        }
    }

    #[test]
    fn hotter_is_always_a_lower_reading() {
        for reading in 100..880 {
            assert!(temperature(reading).unwrap() >= temperature(reading + 1).unwrap());
        }
    }

    #[test]
    fn broken_wires_are_told_apart() {
        assert_eq!(temperature(890), Err(Implausible::Open(890)));
        assert_eq!(temperature(1023), Err(Implausible::Open(1023)));
        assert_eq!(temperature(0), Err(Implausible::Short(0)));
        assert_eq!(temperature(99), Err(Implausible::Short(99)));
    }
}
