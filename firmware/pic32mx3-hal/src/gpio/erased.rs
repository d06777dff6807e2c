//! A pin whose port and number are values: for tables of pins.

use super::pin::{Input, OpenDrain, Output};
use super::{Level, Port};
use core::convert::Infallible;
use core::marker::PhantomData;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin, StatefulOutputPin};

/// A pin in the state `Mode`, from [`super::Pin::erase`].
#[derive(Debug)]
pub struct ErasedPin<Mode> {
    port: Port,
    number: u8,
    mode: PhantomData<fn(Mode)>,
}

impl<Mode> ErasedPin<Mode> {
    pub(super) const fn new(port: Port, number: u8) -> Self {
        Self {
            port,
            number,
            mode: PhantomData,
        }
    }

    /// Its port.
    #[must_use]
    pub const fn port(&self) -> Port {
        self.port
    }

    /// Its bit in the words of its port.
    #[must_use]
    pub const fn bit(&self) -> u16 {
        1 << self.number
    }
}

impl<Mode> ErrorType for ErasedPin<Mode> {
    type Error = Infallible;
}

impl ErasedPin<Input> {
    /// The level of the line.
    #[must_use]
    pub fn level(&self) -> Level {
        if self.port.read() & self.bit() != 0 {
            Level::High
        } else {
            Level::Low
        }
    }
}

impl InputPin for ErasedPin<Input> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.level() == Level::High)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.level() == Level::Low)
    }
}

macro_rules! writable {
    ($($mode:ty),*) => {
        $(impl ErasedPin<$mode> {
            /// Gives it a level.
            pub fn set_level(&mut self, level: Level) {
                self.port.put(self.number, level);
            }
        }

        impl OutputPin for ErasedPin<$mode> {
            fn set_low(&mut self) -> Result<(), Infallible> {
                self.set_level(Level::Low);
                Ok(())
            }

            fn set_high(&mut self) -> Result<(), Infallible> {
                self.set_level(Level::High);
                Ok(())
            }
        }

        impl StatefulOutputPin for ErasedPin<$mode> {
            fn is_set_high(&mut self) -> Result<bool, Infallible> {
                Ok(self.port.latch() & self.bit() != 0)
            }

            fn is_set_low(&mut self) -> Result<bool, Infallible> {
                Ok(self.port.latch() & self.bit() == 0)
            }

            fn toggle(&mut self) -> Result<(), Infallible> {
                self.port.invert(self.bit());
                Ok(())
            }
        })*
    };
}

writable!(Output, OpenDrain);
