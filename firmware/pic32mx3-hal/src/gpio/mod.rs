//! Port pins (section 8).
//!
//! A pin is a type: [`Pin`]`<'G', 9, Input>` is RG9 as an input, and only in that state can it be read. There is one value
//! of it, from [`crate::Peripherals::take`]; what holds it, owns the pin. It occupies no memory.
//!
//! Latches are changed by the registers that set, clear and invert bits only, so a handler and the main program may change
//! pins of the same port. An output gets its level before its direction, so that it never shows a wrong one.
//!
//! ```
//! use pic32mx3_hal::gpio::{Level, Pins};
//! # fn example(pins: Pins) {
//! let mut lamp = pins.rg7.into_output(Level::Low);
//! let bumper = pins.rg9.into_input();
//! if bumper.is_low() {
//!     lamp.set_high();
//! }
//! # }
//! ```
//!
//! For several pins of a port in one access, and for what must work without owning anything (an exception hook), see
//! [`Port`]. For pins in a table, see [`Pin::erase`].

mod erased;
mod pin;
mod pins;
mod port;

pub use erased::ErasedPin;
pub use pin::{Analog, Input, OpenDrain, Output, Pin, Reset};
pub use pins::Pins;
pub use port::Port;

/// The level of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// 0 V.
    Low,
    /// Supply voltage.
    High,
}

impl Level {
    /// The other one.
    #[must_use]
    pub const fn inverted(self) -> Self {
        match self {
            Self::Low => Self::High,
            Self::High => Self::Low,
        }
    }
}

/// A pin with an input of the ADC: port B.
pub trait AnalogPin {
    /// The channel: AN0 to AN15.
    const CHANNEL: u8;
}

/// A pin that takes part in change notice (section 9).
pub trait NoticePin {
    /// Its number: CN0 to CN21.
    const NOTICE: u8;
}
