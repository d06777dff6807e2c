//! What the sensors of one robot show wrongly: gain and offset of each, drawn from a seed.
//!
//! The data sheets behind the ranges: the A3950's current output within some per cent and the converter's offset, phototransistors
//! that differ by a factor of two from part to part, resistors of 1 %.

use cordlib::board::{ChargerReadings, CliffLevels, TemperatureRange};
use home::Pcg;
use rvac_protocol::message::Currents;
use rvac_units::{Current, Temperature};

const STREAM: u64 = 0x5E25;

/// Errors of one robot's sensors. Without a seed there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SensorErrors {
    wheels: [Line; 2],
    brush: Line,
    cliffs: [Line; 3],
    proximity: Line,
    pack: Line,
    charge: Line,
    /// Of the thermistor, tenths of a degree, and how well the board knows its curve.
    warmth_dc: i16,
    doubt_dc: i16,
}

/// Error of one analog line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    gain: f64,
    offset: f64,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            gain: 1.0,
            offset: 0.0,
        }
    }
}

impl Line {
    fn drawn(random: &mut Pcg, gain: f64, offset: f64) -> Self {
        Self {
            gain: 1.0 + gain * random.symmetric(),
            offset: offset * random.symmetric(),
        }
    }

    fn shown(self, value: f64) -> f64 {
        value * self.gain + self.offset
    }

    fn shown_i32(self, value: i32) -> i32 {
        self.shown(f64::from(value)) as i32
    }
}

impl SensorErrors {
    /// Those of a seed.
    pub(crate) fn drawn(seed: u64) -> Self {
        let random = &mut Pcg::new(seed, STREAM);
        Self {
            wheels: [(); 2].map(|()| Line::drawn(random, 0.2, 60.0)),
            brush: Line::drawn(random, 0.2, 60.0),
            cliffs: [(); 3].map(|()| Line::drawn(random, 0.3, 8.0)),
            proximity: Line::drawn(random, 0.4, 4.0),
            pack: Line::drawn(random, 0.01, 0.0),
            charge: Line::drawn(random, 0.05, 40.0),
            warmth_dc: (20.0 * random.symmetric()) as i16,
            doubt_dc: 20,
        }
    }

    /// The motor currents, mA.
    pub(crate) fn currents(&self, currents: Currents) -> Currents {
        let [left, right] = self.wheels;
        Currents {
            wheel_left: Current(left.shown_i32(currents.wheel_left.0)),
            wheel_right: Current(right.shown_i32(currents.wheel_right.0)),
            brush_main: Current(self.brush.shown_i32(currents.brush_main.0)),
        }
    }

    /// The levels of the cliff receivers, 0 to 1,023.
    pub(crate) fn cliffs(&self, levels: CliffLevels) -> CliffLevels {
        let [left, middle, right] = self.cliffs;
        let level = |line: Line, level: u16| line.shown(f64::from(level)).clamp(0.0, 1_023.0) as u16;
        CliffLevels {
            left: level(left, levels.left),
            middle: level(middle, levels.middle),
            right: level(right, levels.right),
        }
    }

    /// The proximity sensors, 0 to 255.
    pub(crate) fn proximity<const N: usize>(&self, closeness: [u8; N]) -> [u8; N] {
        closeness.map(|close| self.proximity.shown(f64::from(close)).clamp(0.0, 255.0) as u8)
    }

    /// The readings of the pack.
    pub(crate) fn pack(&self, readings: ChargerReadings) -> ChargerReadings {
        ChargerReadings {
            pack_mv: self.pack.shown_i32(readings.pack_mv),
            input_mv: self.pack.shown_i32(readings.input_mv),
            current_ma: self.charge.shown_i32(readings.current_ma),
            temperature: readings.temperature.map(|range| {
                let off_by = |celsius: Temperature, doubt_dc: i16| {
                    Temperature(celsius.0.saturating_add(self.warmth_dc).saturating_add(doubt_dc))
                };
                TemperatureRange {
                    coldest: off_by(range.coldest, -self.doubt_dc),
                    warmest: off_by(range.warmest, self.doubt_dc),
                }
            }),
            ..readings
        }
    }
}
