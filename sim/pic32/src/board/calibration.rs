//! Calibration values of `robot.toml`, which have not been measured on a real robot: their simulated values, and the
//! record in flash through which the firmware reads them.

use home::{Pcg, Thermistor};
use serde::Deserialize;

use super::BoardError;
use crate::image::{Image, ImageError};

/// Stream of random numbers of [`Particulars::deviating`].
const DEVIATIONS: u64 = 0xDE72;

/// Physical address of the record: the last page of program flash.
pub const RECORD_ADDRESS: u32 = 0x1D03_F000;
/// Bytes of that page.
const PAGE_BYTES: usize = 4096;
/// First word of the record: "RCAL" in ASCII, lowest byte first.
const MAGIC: u32 = 0x4C41_4352;
const VERSION: u16 = 1;
/// Magic, version and count before, the check value after the values.
const FRAME_BYTES: usize = 12;
/// Marks an unknown value.
const UNKNOWN: i32 = i32::MIN;

#[derive(Deserialize)]
struct RawRobot {
    calibration: Vec<RawValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawValue {
    name: String,
    #[serde(rename = "former-name")]
    _former_name: Option<String>,
    #[serde(rename = "unit")]
    _unit: String,
    range: [i32; 2],
    #[serde(rename = "confidence")]
    _confidence: super::pinout::RowConfidence,
    #[serde(rename = "assumed")]
    _assumed: Option<i32>,
    #[serde(rename = "needed-for")]
    _needed_for: String,
    #[serde(rename = "ability")]
    _ability: Option<String>,
    #[serde(rename = "measure")]
    _measure: String,
    simulated: i32,
}

/// The calibration values of a robot, in the order of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CalibrationValues {
    values: Vec<(String, i32)>,
}

impl CalibrationValues {
    /// Reads the calibration table out of the text of a `robot.toml`.
    ///
    /// # Errors
    /// [`BoardError::Format`], [`BoardError::Range`] or [`BoardError::TooMany`].
    pub fn parse(text: &str) -> Result<Self, BoardError> {
        let raw: RawRobot = toml::from_str(text).map_err(|error| BoardError::Format {
            origin: "robot.toml",
            message: error.to_string().trim().replace('\n', " "),
        })?;
        let count = raw.calibration.len();
        if FRAME_BYTES + 4 * count > PAGE_BYTES {
            return Err(BoardError::TooMany(count));
        }
        let mut values = Vec::with_capacity(count);
        for row in raw.calibration {
            let [low, high] = row.range;
            if !(low..=high).contains(&row.simulated) {
                return Err(BoardError::Range {
                    name: row.name,
                    value: row.simulated,
                    low,
                    high,
                });
            }
            values.push((row.name, row.simulated));
        }
        Ok(Self { values })
    }

    /// The SR8730's.
    ///
    /// # Errors
    /// As [`Self::parse`], when the project's own file is wrong.
    pub fn sr8730() -> Result<Self, BoardError> {
        Self::parse(include_str!("../../../../robots/samsung-sr8730/robot.toml"))
    }

    /// What the simulated robot has for this value.
    ///
    /// # Errors
    /// [`BoardError::NoValue`].
    pub fn value(&self, name: &'static str) -> Result<i32, BoardError> {
        self.values
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, value)| *value)
            .ok_or(BoardError::NoValue(name))
    }

    /// The record of all values, as a person who measured everything would have it.
    #[must_use]
    pub fn record(&self) -> Vec<u8> {
        record(self.values.iter().map(|(_, value)| *value))
    }

    /// The record of a person who has measured these values and nothing else.
    #[must_use]
    pub fn record_of(&self, measured: &[(String, i32)]) -> Vec<u8> {
        record(self.values.iter().map(|(name, _)| {
            let found = measured.iter().find(|(known, _)| known == name);
            found.map_or(UNKNOWN, |(_, value)| *value)
        }))
    }

    /// The record of a person who has measured everything except these.
    #[must_use]
    pub fn record_without(&self, unknown: &[&str]) -> Vec<u8> {
        record(self.values.iter().map(|(name, value)| {
            if unknown.contains(&name.as_str()) {
                UNKNOWN
            } else {
                *value
            }
        }))
    }
}

/// Puts a record where the firmware looks for it.
///
/// # Errors
/// When the record is longer than the flash behind its address.
pub fn put_record(image: &mut Image, record: &[u8]) -> Result<(), ImageError> {
    image.write(RECORD_ADDRESS, record)
}

/// Whether the image brings something along where the record belongs.
pub(super) fn has_record(image: &Image) -> bool {
    record_page(image).iter().any(|byte| *byte != 0xFF)
}

fn record_page(image: &Image) -> &[u8] {
    let from = image.flash().len().saturating_sub(PAGE_BYTES);
    image.flash().get(from..).unwrap_or_default()
}

/// Erases the page of the record.
///
/// # Errors
/// Never on this part, whose flash holds the page.
pub(super) fn erase_record(image: &mut Image) -> Result<(), ImageError> {
    image.write(RECORD_ADDRESS, &[0xFF; PAGE_BYTES])
}

fn record(values: impl ExactSizeIterator<Item = i32>) -> Vec<u8> {
    // Checked when the file was read: the values fit into a page.
    let count = u16::try_from(values.len()).unwrap_or(u16::MAX);
    let mut bytes = MAGIC.to_le_bytes().to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(count.to_le_bytes());
    values.for_each(|value| bytes.extend(value.to_le_bytes()));
    let check = crc32c(&bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

/// Reflected CRC with the Castagnoli polynomial, a bit at a time: the firmware has its own, and the two check each
/// other.
fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0x82F6_3B78 & (crc & 1).wrapping_neg())
        })
    })
}

/// What this one robot is like where nobody knows what all robots are like: the simulated values that the board's
/// circuits follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particulars {
    /// Left and right wheel: line 2 of the encoder leads line 1 when the wheel rolls forward.
    pub encoder_swapped: [bool; 2],
    /// Reading of the left and right current line without current, counts.
    pub current_zero: [i32; 2],
    /// Microamperes a count.
    pub current_scale: i32,
    /// Pulses a second of the main brush at full duty.
    pub brush_pulses_per_s: f64,
    /// Reading of the ladder for each button, counts.
    pub ladder: [u16; 3],
    /// The emitters of the cliff sensors hang on the light supply of unknown purpose; otherwise they are always lit.
    pub cliff_emitters_switched: bool,
    /// Difference between lit and dark with nothing there and with white paper at the sensor, counts.
    pub proximity: [i32; 2],
    /// Microvolts a count of both voltage dividers.
    pub battery_scale: i32,
    /// Reading of charger-voltage less that of battery-voltage without current, hundredths of a count.
    pub charge_zero: i32,
    /// Leading ones of the code that the dock expects.
    pub dock_code_ones: u8,
    /// Codes of the dock's left, right and near beam.
    pub beams: [u8; 3],
    /// Shortest carrier burst of the beams, microseconds.
    pub beam_unit_us: u32,
    /// Which of the chip's UARTs the gyro module is on, 1 or 2.
    pub gyro_uart: u8,
    /// Bits per second of the gyro module.
    pub gyro_baud: u32,
    /// The pack's thermistor and its resistors.
    pub thermistor: Thermistor,
    /// What the converter multiplies with.
    pub converter_gain: f64,
    /// What it adds, counts.
    pub converter_offset: f64,
    /// Light that each cliff receiver shows, in parts of what it should.
    pub cliff_gain: [f64; 3],
    /// Time constant of an infrared receiver and the multiplexer behind it, seconds: usual phototransistors with their load
    /// need 10 to 50 µs; not measured.
    pub receiver_s: f64,
}

impl Particulars {
    /// What the calibration table says of the simulated robot.
    ///
    /// # Errors
    /// [`BoardError::NoValue`].
    pub fn of(calibration: &CalibrationValues) -> Result<Self, BoardError> {
        let value = |name| calibration.value(name);
        // The ranges of the file keep these within their types; what does not fit saturates.
        let small = |name| Ok::<u8, BoardError>(value(name)?.clamp(0, 255) as u8);
        let count = |name| Ok::<u16, BoardError>(value(name)?.clamp(0, 1023) as u16);
        Ok(Self {
            encoder_swapped: [value("wheel-left-order")? != 0, value("wheel-right-order")? != 0],
            current_zero: [
                value("wheel-left-current-zero")?,
                value("wheel-right-current-zero")?,
            ],
            current_scale: value("wheel-current-scale")?,
            brush_pulses_per_s: f64::from(value("brush-main-pulse-rate")?),
            ladder: [
                count("button-ladder-1")?,
                count("button-ladder-2")?,
                count("button-ladder-3")?,
            ],
            cliff_emitters_switched: value("cliff-emitter-line")? != 0,
            proximity: [value("proximity-none")?, value("proximity-touching")?],
            battery_scale: value("battery-scale")?,
            charge_zero: value("charge-current-zero")?,
            dock_code_ones: small("dock-code-ones")?,
            beams: [
                small("dock-beam-left")?,
                small("dock-beam-right")?,
                small("dock-beam-near")?,
            ],
            beam_unit_us: value("dock-beam-short")?.unsigned_abs(),
            gyro_uart: small("gyro-uart")?,
            gyro_baud: value("gyro-rate")?.unsigned_abs(),
            thermistor: Thermistor::NOMINAL,
            converter_gain: 1.0,
            converter_offset: 0.0,
            cliff_gain: [1.0; 3],
            receiver_s: 0.000_03,
        })
    }

    /// The board of this seed: as its owner's calibration was when it was measured, and not quite as it is now.
    #[must_use]
    pub fn deviating(&self, seed: u64) -> Self {
        let random = &mut Pcg::new(seed, DEVIATIONS);
        let mut about = |value: f64, share: f64| value * (1.0 + share * random.symmetric());
        let count = |value: f64| value.round() as i32;
        Self {
            current_zero: self.current_zero.map(|zero| count(about(f64::from(zero), 0.3))),
            current_scale: count(about(f64::from(self.current_scale), 0.2)),
            brush_pulses_per_s: about(self.brush_pulses_per_s, 0.3),
            ladder: self.ladder.map(|level| about(f64::from(level), 0.03) as u16),
            proximity: self.proximity.map(|level| count(about(f64::from(level), 0.3))),
            battery_scale: count(about(f64::from(self.battery_scale), 0.01)),
            charge_zero: self.charge_zero + count(about(100.0, 1.0)) - 100,
            thermistor: Thermistor {
                beta_k: about(self.thermistor.beta_k, 0.01),
                room_kohm: about(self.thermistor.room_kohm, 0.01),
                ..self.thermistor
            },
            // The data sheet's gain error of 4 counts, and its offset of 2.
            converter_gain: about(1.0, 0.004),
            converter_offset: about(2.0, 1.0) - 2.0,
            cliff_gain: self.cliff_gain.map(|gain| about(gain, 0.3)),
            receiver_s: about(0.000_03, 0.6),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CalibrationValues, Particulars, crc32c};
    use crate::board::BoardError;

    const ROW: &str = "[[calibration]]\nname = 'way'\nunit = 'nm'\nrange = [1, 9]\nconfidence = 'unknown'\nneeded-for = 'n'\nmeasure = 'm'\nsimulated = 5\n";

    #[test]
    fn the_check_value_of_castagnoli() {
        assert_eq!(crc32c(b"123456789"), 0xE306_9283);
    }

    #[test]
    fn a_record_is_laid_out_as_the_firmware_reads_it() {
        let text = format!("{ROW}{}", ROW.replace("way", "track").replace('5', "2"));
        let calibration = CalibrationValues::parse(&text).unwrap();
        let record = calibration.record();
        assert_eq!(record[..16], *b"RCAL\x01\0\x02\0\x05\0\0\0\x02\0\0\0");
        assert_eq!(record[16..], crc32c(&record[..16]).to_le_bytes());
        let unknown = calibration.record_without(&["way"]);
        assert_eq!(unknown[8..16], *b"\0\0\0\x80\x02\0\0\0");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, named) in [
            (ROW.replace("= 5", "= 10"), "`way` is 10"),
            (ROW.replace("measure", "how"), "how"),
            (String::new(), "calibration"),
            (ROW.repeat(1025), "1025"),
        ] {
            let message = CalibrationValues::parse(&text).unwrap_err().to_string();
            assert!(message.contains(named), "{message} does not name {named}");
        }
    }

    #[test]
    fn the_project_s_own_robot_has_all_that_the_circuits_need() {
        let calibration = CalibrationValues::sr8730().unwrap();
        let particulars = Particulars::of(&calibration).unwrap();
        assert_eq!(particulars.ladder.len(), 3);
        assert_eq!(calibration.value("no-such"), Err(BoardError::NoValue("no-such")));
    }
}
