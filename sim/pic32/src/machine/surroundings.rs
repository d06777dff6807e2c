//! What the analog inputs see.

use crate::peripheral::Chip;
use crate::pins::{Pin, PinDriver};

/// The circuit around the chip, asked whenever the converter ends a sample.
pub trait Surroundings {
    /// What the converter would read on AN`channel` (0..=15) at this cycle, 0..=1023 for 0 V to AVDD (3.3 V); larger values
    /// count as 1023. What the chip does to its pins at that moment says which multiplexer channel is selected and which
    /// emitter is lit.
    fn analog(&mut self, channel: u8, cycle: u64, outputs: &Outputs<'_>) -> u16;
}

/// Analog inputs that are all at ground.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grounded;

impl Surroundings for Grounded {
    fn analog(&mut self, _: u8, _: u64, _: &Outputs<'_>) -> u16 {
        0
    }
}

/// What the chip does to its pins at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<'a> {
    chip: &'a Chip,
    cycle: u64,
}

impl<'a> Outputs<'a> {
    pub(crate) fn new(chip: &'a Chip, cycle: u64) -> Outputs<'a> {
        Outputs { chip, cycle }
    }

    /// What the chip does to this pin.
    pub fn output(&self, pin: Pin) -> PinDriver {
        self.chip.output(pin, self.cycle)
    }

    /// Whether the chip drives this pin high.
    pub fn is_high(&self, pin: Pin) -> bool {
        self.output(pin).is_high()
    }

    /// The cycle at which the chip last began or ceased to drive this pin high (PWM left out): filters and receivers take
    /// their time to follow.
    pub fn changed(&self, pin: Pin) -> u64 {
        self.chip.changed(pin)
    }

    /// For how many cycles since power-on the chip has driven this pin high; differences of it are mean duties.
    pub fn high_cycles(&self, pin: Pin) -> u64 {
        self.chip.high_cycles(pin, self.cycle)
    }
}
