//! Robots as they are, drawn from a seed: sensors noisy, contacts bouncing. One with an even number has a record as it comes
//! from a calibration bench, each value a little off. One with an odd number is another robot than the record is of: its motors,
//! its wheels and its board differ, and nobody has measured its thermistor.

use home::{Noise, Pcg};
use pic32::board::{CalibrationValues, put_record};
use pic32::image::Image;
use toml::{Table, Value};

use crate::testbed::TestbedError;

const STREAM: u64 = 0xCA11;
/// What the robot really is: the simulated values beside its calibration table.
const ROBOT: &str = include_str!("../../../robots/samsung-sr8730/robot.toml");
/// Noise of the sensors, as a share of the usual robot's.
const NOISE: (f64, f64) = (0.5, 1.5);
/// Bounce of the contacts, microseconds.
const BOUNCE_US: u32 = 2_000;

/// How far a bench may be off.
#[derive(Clone, Copy, Debug)]
enum Error {
    /// Of the value.
    Share(f64),
    /// In the unit of the value.
    Absolute(f64),
}

/// A careful person with a ruler, a scale and a multimeter leaves about this. What is not named is a choice, a count or a
/// code, which is right or useless.
const ERRORS: [(&str, Error); 18] = [
    ("wheel-distance-per-count", Error::Share(0.01)),
    ("wheel-track", Error::Share(0.01)),
    ("wheel-dead-band", Error::Share(0.2)),
    ("wheel-free-speed", Error::Share(0.05)),
    ("wheel-left-current-zero", Error::Absolute(2.0)),
    ("wheel-right-current-zero", Error::Absolute(2.0)),
    ("wheel-current-scale", Error::Share(0.05)),
    ("brush-main-pulse-rate", Error::Share(0.05)),
    ("brush-main-dead-band", Error::Share(0.2)),
    ("button-ladder-1", Error::Absolute(6.0)),
    ("button-ladder-2", Error::Absolute(6.0)),
    ("button-ladder-3", Error::Absolute(6.0)),
    ("cliff-floor-level", Error::Share(0.1)),
    ("battery-scale", Error::Share(0.005)),
    ("battery-capacity", Error::Share(0.05)),
    ("thermistor-ice", Error::Absolute(3.0)),
    ("thermistor-warm", Error::Absolute(3.0)),
    ("wheel-stall-current", Error::Share(0.1)),
];

/// What nobody has measured on a robot that is not the one of the record.
const THERMISTOR: [&str; 4] = [
    "thermistor-ice",
    "thermistor-warm",
    "thermistor-warm-temperature",
    "thermistor-checked",
];

/// What distinguishes this robot from a perfect one.
#[derive(Clone, Debug)]
pub(crate) struct RobotDraw {
    /// The program with its record.
    pub(crate) image: Image,
    /// Of its sensors.
    pub(crate) noise: Noise,
    /// Of its contacts.
    pub(crate) bounce_us: u32,
    /// Which other robot it is.
    pub(crate) deviation: Option<u64>,
}

impl RobotDraw {
    /// The robot of a seed with this program.
    ///
    /// # Errors
    /// When the project's own description of the robot is wrong.
    pub(crate) fn new(mut image: Image, seed: u64) -> Result<Self, TestbedError> {
        let mut random = Pcg::new(seed, STREAM);
        let values = CalibrationValues::parse(&measured(&mut random)?)?;
        let deviation = (!seed.is_multiple_of(2)).then_some(seed);
        let record = match deviation {
            Some(_) => values.record_without(&THERMISTOR),
            None => values.record(),
        };
        put_record(&mut image, &record).map_err(TestbedError::Record)?;
        let (least, most) = NOISE;
        Ok(Self {
            image,
            noise: Noise::NOMINAL.scaled(least + (most - least) * random.unit()),
            bounce_us: random.below(BOUNCE_US),
            deviation,
        })
    }
}

/// The robot's file with what was measured in place of what it is.
fn measured(random: &mut Pcg) -> Result<String, TestbedError> {
    let broken = |error: String| TestbedError::Robot(error);
    let mut file: Table = ROBOT
        .parse()
        .map_err(|error: toml::de::Error| broken(error.to_string()))?;
    let rows = file.get_mut("calibration").and_then(Value::as_array_mut);
    for row in rows.into_iter().flatten().filter_map(Value::as_table_mut) {
        let name = row.get("name").and_then(Value::as_str).unwrap_or_default();
        let error = ERRORS.iter().find(|(known, _)| *known == name);
        let (Some((_, error)), Some(exact)) = (error, row.get("simulated").and_then(Value::as_integer))
        else {
            continue;
        };
        let off = random.symmetric();
        let value = match error {
            Error::Share(share) => exact as f64 * (1.0 + off * share),
            Error::Absolute(most) => exact as f64 + off * most,
        };
        row.insert("simulated".to_owned(), Value::Integer(value.round() as i64));
    }
    toml::to_string(&file).map_err(|error| broken(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::{ERRORS, ROBOT, measured};
    use home::Pcg;
    use pic32::board::CalibrationValues;

    #[test]
    fn every_value_that_a_bench_measures_is_off_and_different_for_each_robot() {
        let of = |seed| CalibrationValues::parse(&measured(&mut Pcg::new(seed, 1)).unwrap()).unwrap();
        let exact = CalibrationValues::parse(ROBOT).unwrap();
        for (name, _) in ERRORS {
            let differs = (1..20).any(|seed| of(seed).value(name) != exact.value(name));
            assert!(differs, "{name}");
        }
        assert_eq!(of(3), of(3));
        assert_ne!(of(3), of(4));
        assert_eq!(of(3).value("wheel-right-order"), exact.value("wheel-right-order"));
    }
}
