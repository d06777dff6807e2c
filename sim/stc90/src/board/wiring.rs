//! Connections of the pins to the robot's parts.

use super::BoardError;
use super::pinout::Pinout;
use crate::pins::{Level, Levels, Pin};

/// A digital line: its pin, and the level that means "on".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DigitalLine {
    /// Where.
    pub pin: Pin,
    /// Which level is "on".
    pub active: Level,
}

impl DigitalLine {
    /// The level for this state.
    #[must_use]
    pub const fn level(self, on: bool) -> Level {
        Level::of(on == self.active.is_high())
    }

    /// Whether the line is on at these levels.
    #[must_use]
    pub fn is_on(self, levels: &Levels) -> bool {
        levels.level(self.pin) == self.active
    }
}

/// A wheel's two direction lines and its encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelPins {
    /// On = forward.
    pub forward: DigitalLine,
    /// On = backward.
    pub backward: DigitalLine,
    /// One line.
    pub encoder: Pin,
}

/// All pins that end in something of the simulated robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// Left and right.
    pub wheels: [WheelPins; 2],
    /// Main brush.
    pub brush: DigitalLine,
    /// Suction with side brush.
    pub suction: DigitalLine,
    /// Lights all light barriers and floor sensors.
    pub sensor_light: DigitalLine,
    /// Left and right half, on = pressed.
    pub bumpers: [DigitalLine; 2],
    /// Left outer, left inner, right inner, right outer, on = floor.
    pub floors: [DigitalLine; 4],
    /// On = near a wall.
    pub wall: DigitalLine,
    /// All wheels, on = one hangs.
    pub wheel_drop: DigitalLine,
    /// On = good.
    pub battery_ok: DigitalLine,
    /// Left wheel, right wheel, main brush, suction with side brush.
    pub over_currents: [DigitalLine; 4],
}

impl Wiring {
    /// That of the Relax.
    ///
    /// # Errors
    /// When the project's own description of the board is wrong.
    pub fn relax() -> Result<Self, BoardError> {
        Self::of(&Pinout::relax()?)
    }

    fn of(pinout: &Pinout) -> Result<Self, BoardError> {
        let wheel = |forward, backward, encoder| {
            Ok(WheelPins {
                forward: pinout.line(forward)?,
                backward: pinout.line(backward)?,
                encoder: pinout.pin(encoder)?,
            })
        };
        Ok(Self {
            wheels: [
                wheel("wheel-left-forward", "wheel-left-backward", "encoder-left")?,
                wheel("wheel-right-forward", "wheel-right-backward", "encoder-right")?,
            ],
            brush: pinout.line("brush-main")?,
            suction: pinout.line("suction")?,
            sensor_light: pinout.line("sensor-light")?,
            bumpers: [pinout.line("bumper-left")?, pinout.line("bumper-right")?],
            floors: [
                pinout.line("floor-left-outer")?,
                pinout.line("floor-left-inner")?,
                pinout.line("floor-right-inner")?,
                pinout.line("floor-right-outer")?,
            ],
            wall: pinout.line("wall")?,
            wheel_drop: pinout.line("wheel-drop")?,
            battery_ok: pinout.line("battery-ok")?,
            over_currents: [
                pinout.line("wheel-left-over-current")?,
                pinout.line("wheel-right-over-current")?,
                pinout.line("brush-main-over-current")?,
                pinout.line("suction-over-current")?,
            ],
        })
    }
}
