//! How each value is measured: what the person does, what is read, what comes out.

use std::time::Duration;

use rvac_protocol::message::{ButtonProbe, PROBE_CHANNELS, ProbeTarget, ProbedContent};

use calibration_values::Item;

use crate::arithmetic::{
    distance_per_count_nm, line_order, mean, mean_milli, scale_uv, steady_mean, track_um,
};
use crate::bench::Bench;
use crate::error::CalibrationError;
use crate::screen::{Question, Shown, Task};
use crate::thermistor::{TwoPoints, agrees};

/// Readings whose mean is a value.
pub(super) const READINGS: usize = 100;
/// Readings whose mean is needed to a hundredth of a count.
const READINGS_EXACT: usize = 1_000;
/// Readings follow each other after 1 to so many ms, so that they do not fall into step with the sensors' own round.
const PAUSE_MAX_MS: usize = 13;

/// Every so many readings one is shown.
const SHOWN_EVERY: usize = 20;

/// A side of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Left,
    Right,
}

/// The closed set of methods to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Procedure {
    /// Pushed by hand over a distance that the person reads off a measure.
    Push,
    /// Turned ten times by hand.
    Spin,
    /// One wheel turned forward by hand.
    Order(Side),
    /// The duty of both wheels is raised until they turn.
    LeastDuty,
    /// Both wheels at full duty for a moment.
    FreeSpeed,
    /// Mean of the buttons' line while one of them is held.
    Button,
    /// Mean of a line of the converter.
    Mean(&'static str),
    /// Mean difference of two lines, in hundredths.
    Difference(&'static str, &'static str),
    /// Mean of a line of the converter in tenths of a count.
    Tenths(&'static str),
    /// A third temperature against the curve through two.
    ThirdTemperature,
    /// What a held wheel draws at three tenths of its duty, as at full duty.
    StallCurrent,
    /// A voltage at the multimeter against the mean of a line.
    Voltage(&'static str),
    /// Whether the light supply of unknown purpose lights the cliff sensors.
    CliffLine,
    /// Half of the rise from a drop to a floor.
    CliffFloor,
    /// The brightest cliff sensor over a drop.
    CliffDrop,
    /// The brightest proximity sensor with nothing there.
    ProximityNone,
    /// The dimmest proximity sensor with paper at it.
    ProximityTouching,
    /// A wheel's current at an ammeter against its line.
    CurrentScale,
    /// The duty of the main brush is raised until it turns.
    BrushLeastDuty,
    /// Pulses of the main brush at full duty.
    BrushRate,
    /// The person reads it off and types it.
    Typed,
}

impl Procedure {
    /// How the value of this name is measured.
    pub(crate) fn of(name: &str) -> Self {
        match name {
            "wheel-distance-per-count" => Self::Push,
            "wheel-track" => Self::Spin,
            "wheel-left-order" => Self::Order(Side::Left),
            "wheel-right-order" => Self::Order(Side::Right),
            "wheel-dead-band" => Self::LeastDuty,
            "wheel-free-speed" => Self::FreeSpeed,
            "wheel-left-current-zero" => Self::Mean("wheel-left-current"),
            "wheel-right-current-zero" => Self::Mean("wheel-right-current"),
            "button-ladder-1" | "button-ladder-2" | "button-ladder-3" => Self::Button,
            "charge-current-zero" => Self::Difference("charger-voltage", "battery-voltage"),
            "battery-scale" => Self::Voltage("battery-voltage"),
            "cliff-emitter-line" => Self::CliffLine,
            "cliff-floor-level" => Self::CliffFloor,
            "cliff-drop-level" => Self::CliffDrop,
            "proximity-none" => Self::ProximityNone,
            "proximity-touching" => Self::ProximityTouching,
            "wheel-current-scale" => Self::CurrentScale,
            "thermistor-ice" | "thermistor-warm" => Self::Tenths("battery-thermistor"),
            "thermistor-checked" => Self::ThirdTemperature,
            "wheel-stall-current" => Self::StallCurrent,
            "brush-main-dead-band" => Self::BrushLeastDuty,
            "brush-main-pulse-rate" => Self::BrushRate,
            _ => Self::Typed,
        }
    }

    /// What a person must know beforehand, if the robot moves something by itself.
    pub(crate) const fn danger(self) -> Option<Danger> {
        match self {
            Self::LeastDuty | Self::FreeSpeed => Some(Danger::Moves),
            Self::CurrentScale | Self::StallCurrent => Some(Danger::Pulls),
            Self::BrushLeastDuty | Self::BrushRate => Some(Danger::Brush),
            _ => None,
        }
    }
}

/// What moves by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Danger {
    /// The robot drives.
    Moves,
    /// A wheel pulls against a hand.
    Pulls,
    /// The main brush turns.
    Brush,
}

impl Bench<'_> {
    /// Measures a value once the person is ready.
    pub(crate) fn measure(&mut self, item: &Item) -> Result<i64, CalibrationError> {
        match Procedure::of(&item.name) {
            Procedure::Push => {
                let moved = self.moved_by_hand(Task::Push)?;
                let distance_mm = self.number(Question::DistanceMm)?;
                Ok(distance_per_count_nm(moved, distance_mm)?)
            }
            Procedure::Spin => {
                let way_nm = self.needed("wheel-distance-per-count")?;
                let moved = self.moved_by_hand(Task::Spin)?;
                Ok(track_um(moved, 10, way_nm)?)
            }
            Procedure::Order(side) => {
                let moved = self.moved_by_hand(Task::Roll(side))?;
                Ok(line_order(match side {
                    Side::Left => moved.left,
                    Side::Right => moved.right,
                })?)
            }
            Procedure::LeastDuty => self.least_duty(),
            Procedure::FreeSpeed => self.free_speed(),
            Procedure::CurrentScale => self.current_scale(),
            Procedure::StallCurrent => self.stall_current(),
            Procedure::ThirdTemperature => self.third_temperature(),
            Procedure::BrushLeastDuty => self.brush_least_duty(),
            Procedure::BrushRate => self.brush_rate(),
            Procedure::CliffLine => self.cliff_line(),
            Procedure::CliffFloor => self.cliff_floor(),
            Procedure::CliffDrop => self.cliff_drop(),
            Procedure::ProximityNone => self.proximity_none(),
            Procedure::ProximityTouching => self.proximity_touching(),
            Procedure::Button => self.button(),
            Procedure::Mean(signal) => Ok(steady_mean(&self.line(signal, READINGS)?)?),
            Procedure::Tenths(signal) => Ok(mean_milli(&self.line(signal, READINGS_EXACT)?)? / 100),
            Procedure::Difference(more, less) => {
                let (more, less) = (self.catalog.channel(more)?, self.catalog.channel(less)?);
                let readings = self.readings(READINGS_EXACT, |raw| level(raw, more) - level(raw, less))?;
                Ok(mean_milli(&readings)? / 10)
            }
            Procedure::Voltage(signal) => {
                let volts = self.number(Question::PackMv)?;
                Ok(scale_uv(volts, mean_milli(&self.line(signal, READINGS)?)?)?)
            }
            Procedure::Typed => self.number(Question::Value(item)),
        }
    }

    /// Compares the room's temperature with that of the curve through ice and warm water.
    fn third_temperature(&mut self) -> Result<i64, CalibrationError> {
        let points = TwoPoints {
            ice: self.needed("thermistor-ice")?,
            warm: self.needed("thermistor-warm")?,
            warm_dc: self.needed("thermistor-warm-temperature")?,
        };
        let reading = mean_milli(&self.line("battery-thermistor", READINGS_EXACT)?)?;
        let room_dc = self.number(Question::RoomDc)?;
        let found_dc = agrees(points, reading, room_dc)?;
        let note = format!("{:.1} degrees by the two points", found_dc as f64 / 10.0);
        self.screen.show(Shown::Note(&note))?;
        Ok(1)
    }

    /// A value that another one is reckoned from.
    pub(super) fn needed(&self, name: &str) -> Result<i64, CalibrationError> {
        self.measured
            .get(name)
            .ok_or_else(|| CalibrationError::Needed(name.to_owned()))
    }

    /// So many readings of a line of the converter.
    pub(super) fn line(&mut self, signal: &str, count: usize) -> Result<Vec<i64>, CalibrationError> {
        let channel = self.catalog.channel(signal)?;
        self.readings(count, |raw| level(raw, channel))
    }

    fn readings<Reading: Newest>(
        &mut self,
        count: usize,
        of: impl Fn(&[u16; PROBE_CHANNELS]) -> Reading,
    ) -> Result<Vec<Reading>, CalibrationError> {
        let mut readings = Vec::with_capacity(count);
        while readings.len() < count {
            let pause_ms = 1 + (readings.len() * 5) % PAUSE_MAX_MS;
            self.robot.pass(Duration::from_millis(pause_ms as u64))?;
            match self.robot.probe(ProbeTarget::Analog)? {
                ProbedContent::Analog(raw) => {
                    let reading = of(&raw);
                    if readings.len().is_multiple_of(SHOWN_EVERY) {
                        self.screen.show(Shown::Progress {
                            done: readings.len(),
                            of: count,
                            reading: reading.newest(),
                        })?;
                    }
                    readings.push(reading);
                }
                _ => return Err(CalibrationError::OtherReading),
            }
        }
        Ok(readings)
    }

    /// The line of the buttons, while one is held.
    fn button(&mut self) -> Result<i64, CalibrationError> {
        let level = steady_mean(&self.line("button-ladder", READINGS)?)?;
        match self.robot.probe(ProbeTarget::Buttons)? {
            ProbedContent::Buttons(ButtonProbe { pressed: true, .. }) => Ok(level),
            _ => Err(CalibrationError::NotPressed),
        }
    }

    /// Means of three lines of the converter.
    pub(super) fn three(&mut self, signals: [&str; 3]) -> Result<[i64; 3], CalibrationError> {
        let mut channels = [0; 3];
        for (channel, signal) in channels.iter_mut().zip(signals) {
            *channel = self.catalog.channel(signal)?;
        }
        let readings = self.readings(READINGS, |raw| channels.map(|channel| level(raw, channel)))?;
        let mut means = [0; 3];
        for (place, found) in means.iter_mut().enumerate() {
            let of_one: Vec<i64> = readings.iter().map(|three| three[place]).collect();
            *found = mean(&of_one)?;
        }
        Ok(means)
    }
}

/// A reading, of one line or of several.
trait Newest {
    /// What is shown of it.
    fn newest(&self) -> i64;
}

impl Newest for i64 {
    fn newest(&self) -> i64 {
        *self
    }
}

impl Newest for [i64; 3] {
    fn newest(&self) -> i64 {
        self[0].max(self[1]).max(self[2])
    }
}

/// The reading of a channel.
pub(super) fn level(raw: &[u16; PROBE_CHANNELS], channel: usize) -> i64 {
    raw.get(channel).copied().map_or(0, i64::from)
}
