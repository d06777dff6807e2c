//! Temperature of the battery pack: a 10 k NTC in the pack, 10 k across it, 1.5 k to 3.3 V (AVDD), read as AN4.

use cordlib::board::{TemperatureRange, ThermistorFault};
use cordlib::thermistor::{Divider, ThermistorCurve};

/// The board's resistors.
pub const DIVIDER: Divider = Divider {
    across_ohm: 10_000,
    supply_ohm: 1_500,
};
/// Readings above this mean that the thermistor is not connected: the divider alone gives 890.
const OPEN_ABOVE: u16 = 880;
/// Readings below this mean a short circuit: about 150 degrees.
const SHORT_BELOW: u16 = 100;

/// Temperature for a 10-bit reading of AN4.
///
/// # Errors
/// For readings that no pack gives.
pub fn temperature(curve: &ThermistorCurve, reading: u16) -> Result<TemperatureRange, ThermistorFault> {
    if reading > OPEN_ABOVE {
        Err(ThermistorFault::Open)
    } else if reading < SHORT_BELOW {
        Err(ThermistorFault::Shorted)
    } else {
        Ok(curve.temperature(reading))
    }
}

#[cfg(test)]
mod tests {
    use super::{DIVIDER, temperature};
    use cordlib::board::ThermistorFault;
    use cordlib::thermistor::ThermistorCurve;

    #[test]
    fn broken_wires_are_told_apart() {
        let curve = ThermistorCurve::new(DIVIDER, None);
        for (reading, fault) in [
            (890, ThermistorFault::Open),
            (1_023, ThermistorFault::Open),
            (0, ThermistorFault::Shorted),
            (99, ThermistorFault::Shorted),
        ] {
            assert_eq!(temperature(&curve, reading), Err(fault), "{reading}");
        }
        assert!(temperature(&curve, 880).is_ok() && temperature(&curve, 100).is_ok());
    }
}
