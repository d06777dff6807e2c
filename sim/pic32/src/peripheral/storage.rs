//! Blocks that this emulator does not model: their registers keep what is written, and switching one on is recorded.

/// A block that is not modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unmodelled {
    /// The parallel master port.
    ParallelPort,
    /// The DMA controller.
    Dma,
    /// A reference voltage of the comparators that comes from pins.
    VoltageReference,
    /// The fault input of output compare.
    CompareFault,
    /// Infrared coding, automatic baud detection, addresses or wake-up of a UART.
    SerialOption,
    /// Other references than the supply, or a negative input, of the analog converter.
    AnalogReference,
    /// The proximity timer of the interrupt controller.
    ProximityTimer,
}

/// Values by their offset in the register window.
#[derive(Clone, Debug, Default)]
pub(crate) struct Storage {
    values: Vec<(u32, u32)>,
}

impl Storage {
    pub(crate) fn read(&self, offset: u32) -> u32 {
        self.values
            .iter()
            .find(|(place, _)| *place == offset)
            .map_or(0, |(_, value)| *value)
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32) {
        match self.values.iter_mut().find(|(place, _)| *place == offset) {
            Some((_, kept)) => *kept = value,
            None => self.values.push((offset, value)),
        }
    }
}
