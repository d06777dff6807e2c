//! A pin whose port, number and state are its type.

use super::{AnalogPin, ErasedPin, Level, NoticePin, Port};
use crate::change_notice;
use core::convert::Infallible;
use core::marker::PhantomData;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin, PinState, StatefulOutputPin};

/// As the reset left it: an input, analog where there is an ADC channel.
#[derive(Debug)]
pub enum Reset {}
/// A digital input.
#[derive(Debug)]
pub enum Input {}
/// An output that drives both levels.
#[derive(Debug)]
pub enum Output {}
/// An output that pulls low and lets go for high.
#[derive(Debug)]
pub enum OpenDrain {}
/// An input of the ADC.
#[derive(Debug)]
pub enum Analog {}

/// Pin `NUMBER` of port `PORT` in the state `Mode`.
#[derive(Debug)]
pub struct Pin<const PORT: char, const NUMBER: u8, Mode> {
    mode: PhantomData<fn(Mode)>,
}

impl<const PORT: char, const NUMBER: u8, Mode> Pin<PORT, NUMBER, Mode> {
    const PORT_OF_PIN: Port = match Port::from_letter(PORT) {
        Some(port) => port,
        None => panic!("ports are A to G"),
    };
    const BIT: u16 = 1 << NUMBER;

    pub(super) const fn new() -> Self {
        Self { mode: PhantomData }
    }

    /// Makes it a digital input.
    #[must_use]
    pub fn into_input(self) -> Pin<PORT, NUMBER, Input> {
        Self::PORT_OF_PIN.release(Self::BIT);
        Self::PORT_OF_PIN.make_digital(Self::BIT);
        Pin::new()
    }

    /// Makes it an output: first the level, then the direction.
    #[must_use]
    pub fn into_output(self, level: Level) -> Pin<PORT, NUMBER, Output> {
        Self::PORT_OF_PIN.put(NUMBER, level);
        Self::PORT_OF_PIN.clear_open_drain(Self::BIT);
        Self::PORT_OF_PIN.make_digital(Self::BIT);
        Self::PORT_OF_PIN.drive(Self::BIT);
        Pin::new()
    }

    /// Makes it an open-drain output: first the level, then the direction. High lets go of the line.
    #[must_use]
    pub fn into_open_drain(self, level: Level) -> Pin<PORT, NUMBER, OpenDrain> {
        Self::PORT_OF_PIN.put(NUMBER, level);
        Self::PORT_OF_PIN.set_open_drain(Self::BIT);
        Self::PORT_OF_PIN.make_digital(Self::BIT);
        Self::PORT_OF_PIN.drive(Self::BIT);
        Pin::new()
    }

    /// Makes it an input of the ADC.
    #[must_use]
    pub fn into_analog(self) -> Pin<PORT, NUMBER, Analog>
    where
        Self: AnalogPin,
    {
        Self::PORT_OF_PIN.release(Self::BIT);
        Self::PORT_OF_PIN.make_analog(Self::BIT);
        Pin::new()
    }

    /// Its port.
    #[must_use]
    pub const fn port(&self) -> Port {
        Self::PORT_OF_PIN
    }

    /// Its bit in the words of its port.
    #[must_use]
    pub const fn bit(&self) -> u16 {
        Self::BIT
    }

    /// Forgets in the type which pin it is, so that several fit into one table.
    #[must_use]
    pub const fn erase(self) -> ErasedPin<Mode> {
        ErasedPin::new(Self::PORT_OF_PIN, NUMBER)
    }

    #[inline(always)]
    fn reads_high(&self) -> bool {
        Self::PORT_OF_PIN.read() & Self::BIT != 0
    }

    #[inline(always)]
    fn put(&mut self, level: Level) {
        Self::PORT_OF_PIN.put(NUMBER, level);
    }
}

macro_rules! readable {
    ($($mode:ty),*) => {
        $(impl<const PORT: char, const NUMBER: u8> Pin<PORT, NUMBER, $mode> {
            /// The level of the line.
            #[inline(always)]
            #[must_use]
            pub fn level(&self) -> Level {
                if self.reads_high() { Level::High } else { Level::Low }
            }

            /// Whether the line is high.
            #[inline(always)]
            #[must_use]
            pub fn is_high(&self) -> bool {
                self.reads_high()
            }

            /// Whether the line is low.
            #[inline(always)]
            #[must_use]
            pub fn is_low(&self) -> bool {
                !self.reads_high()
            }
        }

        impl<const PORT: char, const NUMBER: u8> InputPin for Pin<PORT, NUMBER, $mode> {
            fn is_high(&mut self) -> Result<bool, Infallible> {
                Ok(self.reads_high())
            }

            fn is_low(&mut self) -> Result<bool, Infallible> {
                Ok(!self.reads_high())
            }
        })*
    };
}

macro_rules! writable {
    ($($mode:ty),*) => {
        $(impl<const PORT: char, const NUMBER: u8> Pin<PORT, NUMBER, $mode> {
            /// Makes it high; an open-drain output lets go.
            #[inline(always)]
            pub fn set_high(&mut self) {
                self.put(Level::High);
            }

            /// Makes it low.
            #[inline(always)]
            pub fn set_low(&mut self) {
                self.put(Level::Low);
            }

            /// Gives it a level.
            #[inline(always)]
            pub fn set_level(&mut self, level: Level) {
                self.put(level);
            }

            /// Changes its level.
            #[inline(always)]
            pub fn toggle(&mut self) {
                Self::PORT_OF_PIN.invert(Self::BIT);
            }

            /// The level it was given last.
            #[must_use]
            pub fn wanted(&self) -> Level {
                if Self::PORT_OF_PIN.latch() & Self::BIT != 0 { Level::High } else { Level::Low }
            }
        }

        impl<const PORT: char, const NUMBER: u8> OutputPin for Pin<PORT, NUMBER, $mode> {
            fn set_low(&mut self) -> Result<(), Infallible> {
                self.put(Level::Low);
                Ok(())
            }

            fn set_high(&mut self) -> Result<(), Infallible> {
                self.put(Level::High);
                Ok(())
            }

            fn set_state(&mut self, state: PinState) -> Result<(), Infallible> {
                self.put(match state {
                    PinState::Low => Level::Low,
                    PinState::High => Level::High,
                });
                Ok(())
            }
        }

        impl<const PORT: char, const NUMBER: u8> StatefulOutputPin for Pin<PORT, NUMBER, $mode> {
            fn is_set_high(&mut self) -> Result<bool, Infallible> {
                Ok(self.wanted() == Level::High)
            }

            fn is_set_low(&mut self) -> Result<bool, Infallible> {
                Ok(self.wanted() == Level::Low)
            }

            fn toggle(&mut self) -> Result<(), Infallible> {
                Self::PORT_OF_PIN.invert(Self::BIT);
                Ok(())
            }
        })*
    };
}

impl<const PORT: char, const NUMBER: u8, Mode> ErrorType for Pin<PORT, NUMBER, Mode> {
    type Error = Infallible;
}

// An open-drain output may be held low by another device, so reading it is useful.
readable!(Input, OpenDrain);
writable!(Output, OpenDrain);

impl<const PORT: char, const NUMBER: u8> Pin<PORT, NUMBER, Input>
where
    Self: NoticePin,
{
    /// Connects the weak pull-up, some ten to a hundred kiloohms.
    pub fn enable_pull_up(&mut self) {
        change_notice::enable_pull_up(Self::NOTICE);
    }

    /// Disconnects it.
    pub fn disable_pull_up(&mut self) {
        change_notice::disable_pull_up(Self::NOTICE);
    }

    /// Lets its changes ask for the change-notice interrupt.
    pub fn enable_notice(&mut self) {
        change_notice::enable(Self::NOTICE);
    }

    /// Keeps its changes silent.
    pub fn disable_notice(&mut self) {
        change_notice::disable(Self::NOTICE);
    }
}
