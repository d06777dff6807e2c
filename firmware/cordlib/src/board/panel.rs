//! Sound, lights and buttons on the robot.

use rvac_units::{Frequency, Ratio};

/// A tone generator.
pub trait Beeper {
    /// Whether there is one.
    const PRESENT: bool;

    /// Starts a tone; it sounds until the next call.
    fn sound(&mut self, pitch: Frequency, volume: Ratio);

    /// Ends the tone.
    fn silence(&mut self);
}

/// The lights.
pub trait Lights {
    /// Number of lights, 0..=16.
    const COUNT: u8;

    /// Sets one light, `light` < `COUNT`.
    fn set(&mut self, light: u8, brightness: Ratio);
}

/// The buttons.
pub trait Buttons {
    /// Number of buttons, 0..=8.
    const COUNT: u8;

    /// Buttons that are down now, bit by number, not debounced.
    fn down(&mut self) -> u8;

    /// Whether any button is down. A board that can tell this without knowing which (S28 before the buttons are
    /// calibrated) says so here.
    fn any_down(&mut self) -> bool {
        self.down() != 0
    }
}
