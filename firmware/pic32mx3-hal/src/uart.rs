//! UART 1 and 2, 8 data bits, no parity, one stop bit (section 14).

use crate::gpio::{Input, Output, Pin};
use crate::register::map::{uart_baud, uart_mode, uart_receive, uart_status, uart_transmit};
use core::fmt;

const ON: u32 = 1 << 15;
const BRGH: u32 = 1 << 3;
const RECEIVED: u32 = 1;
const OVERRUN: u32 = 1 << 1;
const FRAMING: u32 = 1 << 2;
const PARITY: u32 = 1 << 3;
const SHIFTER_EMPTY: u32 = 1 << 8;
const TRANSMIT_FULL: u32 = 1 << 9;
const TRANSMIT_ENABLE: u32 = 1 << 10;
const RECEIVE_ENABLE: u32 = 1 << 12;

/// What a receiver can complain of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// Bytes came faster than they were taken; those in the queue are lost with it.
    Overrun,
    /// A byte had no stop bit.
    Framing,
    /// A byte had the wrong parity.
    Parity,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Overrun => "bytes were lost because they were not taken in time",
            Self::Framing => "a byte had no stop bit",
            Self::Parity => "a byte had the wrong parity",
        })
    }
}

impl core::error::Error for Error {}

/// UART `NUMBER`, 1 or 2, off.
#[derive(Debug)]
pub struct Uart<const NUMBER: u8>(());

/// The pin that a UART sends on.
pub trait TransmitPin<const UART: u8> {}
/// The pin that a UART receives on.
pub trait ReceivePin<const UART: u8> {}

impl TransmitPin<1> for Pin<'F', 3, Output> {}
impl ReceivePin<1> for Pin<'F', 2, Input> {}
impl TransmitPin<2> for Pin<'F', 5, Output> {}
impl ReceivePin<2> for Pin<'F', 4, Input> {}

/// A rate that the clock cannot make within 2.5 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateError {
    /// The requested rate, in bits a second.
    pub wanted: u32,
}

/// The register value for a rate with four clocks a bit, and the rate it makes.
fn divider(rate: u32, peripheral_hz: u32) -> Result<u32, RateError> {
    const CLOCKS_PER_BIT: u64 = 4;
    let wanted = RateError { wanted: rate };
    if rate == 0 {
        return Err(wanted);
    }
    let rate = u64::from(rate);
    let hz = u64::from(peripheral_hz);
    let steps = ((hz + rate * CLOCKS_PER_BIT / 2) / (rate * CLOCKS_PER_BIT)).clamp(1, 0x1_0000);
    let made_times_steps = hz / CLOCKS_PER_BIT;
    let off = (rate * steps).abs_diff(made_times_steps);
    if off * 40 > rate * steps {
        return Err(wanted);
    }
    Ok(steps as u32 - 1)
}

impl<const NUMBER: u8> Uart<NUMBER> {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Starts it at a rate in bits a second. `peripheral_hz` is PBCLK.
    ///
    /// The sending pin should be an output at high level, so that the line is idle before.
    ///
    /// # Errors
    /// [`RateError`] when the rate cannot be made within 2.5 %.
    pub fn start<T: TransmitPin<NUMBER>, R: ReceivePin<NUMBER>>(
        self,
        pins: (T, R),
        rate: u32,
        peripheral_hz: u32,
    ) -> Result<(Transmitter<NUMBER, T>, Receiver<NUMBER, R>), RateError> {
        let divider = divider(rate, peripheral_hz)?;
        uart_mode(NUMBER).write(0);
        uart_baud(NUMBER).write(divider);
        uart_mode(NUMBER).write(ON | BRGH);
        uart_status(NUMBER).write(TRANSMIT_ENABLE | RECEIVE_ENABLE);
        let (transmit, receive) = pins;
        Ok((Transmitter { _pin: transmit }, Receiver { _pin: receive }))
    }
}

impl<const NUMBER: u8> Uart<NUMBER> {
    /// Divides it for listening only, off as yet: its sending pin keeps its level, and a handler can own the receiver while the
    /// main program chooses the rate.
    pub fn into_listener<R: ReceivePin<NUMBER>>(self, pin: R) -> (Listener<NUMBER>, Receiver<NUMBER, R>) {
        (Listener(()), Receiver { _pin: pin })
    }
}

/// Turns a UART that only listens on and off.
#[derive(Debug)]
pub struct Listener<const NUMBER: u8>(());

impl<const NUMBER: u8> Listener<NUMBER> {
    /// Listens at a rate in bits a second; what was received before is gone. `peripheral_hz` is PBCLK.
    ///
    /// # Errors
    /// [`RateError`] when the rate cannot be made within 2.5 %; it is off then.
    pub fn start(&mut self, rate: u32, peripheral_hz: u32) -> Result<(), RateError> {
        self.stop();
        uart_baud(NUMBER).write(divider(rate, peripheral_hz)?);
        uart_mode(NUMBER).write(ON | BRGH);
        uart_status(NUMBER).write(RECEIVE_ENABLE);
        Ok(())
    }

    /// Stops listening.
    pub fn stop(&mut self) {
        uart_status(NUMBER).write(0);
        uart_mode(NUMBER).write(0);
    }
}

/// The sending half.
#[derive(Debug)]
pub struct Transmitter<const NUMBER: u8, P> {
    _pin: P,
}

impl<const NUMBER: u8, P> Transmitter<NUMBER, P> {
    /// Gives a byte to the queue; `false` when it is full.
    pub fn try_write(&mut self, byte: u8) -> bool {
        if uart_status(NUMBER).has(TRANSMIT_FULL) {
            return false;
        }
        uart_transmit(NUMBER).write(u32::from(byte));
        true
    }

    /// Whether everything has left, the last stop bit included.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        uart_status(NUMBER).has(SHIFTER_EMPTY)
    }
}

/// The receiving half.
#[derive(Debug)]
pub struct Receiver<const NUMBER: u8, P> {
    _pin: P,
}

impl<const NUMBER: u8, P> Receiver<NUMBER, P> {
    /// The oldest byte in the queue, or what was wrong with it; `None` when nothing came.
    ///
    /// # Errors
    /// The byte is lost with a framing or parity error, the whole queue with an overrun.
    pub fn try_read(&mut self) -> Option<Result<u8, Error>> {
        let status = uart_status(NUMBER).read();
        if status & OVERRUN != 0 {
            // Clearing it empties the queue, and without that the receiver stops.
            uart_status(NUMBER).clear(OVERRUN);
            return Some(Err(Error::Overrun));
        }
        if status & RECEIVED == 0 {
            return None;
        }
        let byte = uart_receive(NUMBER).read() as u8;
        Some(match status & (FRAMING | PARITY) {
            0 => Ok(byte),
            wrong if wrong & FRAMING != 0 => Err(Error::Framing),
            _ => Err(Error::Parity),
        })
    }

    /// Whether there is a byte or an error to take.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        uart_status(NUMBER).read() & (RECEIVED | OVERRUN) != 0
    }
}

#[cfg(feature = "embedded-io")]
mod io {
    use super::{Error, Receiver, TRANSMIT_FULL, Transmitter};
    use crate::register::map::uart_status;
    use core::convert::Infallible;
    use embedded_io::{ErrorKind, ErrorType, Read, ReadReady, Write, WriteReady};

    impl embedded_io::Error for Error {
        fn kind(&self) -> ErrorKind {
            match self {
                Self::Overrun => ErrorKind::OutOfMemory,
                Self::Framing | Self::Parity => ErrorKind::InvalidData,
            }
        }
    }

    impl<const NUMBER: u8, P> ErrorType for Transmitter<NUMBER, P> {
        type Error = Infallible;
    }

    impl<const NUMBER: u8, P> Write for Transmitter<NUMBER, P> {
        /// Waits for room for one byte, then takes as many as fit.
        fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
            let mut taken = 0;
            for byte in bytes {
                while !self.try_write(*byte) {
                    if taken > 0 {
                        return Ok(taken);
                    }
                }
                taken += 1;
            }
            Ok(taken)
        }

        fn flush(&mut self) -> Result<(), Infallible> {
            while !self.is_idle() {}
            Ok(())
        }
    }

    impl<const NUMBER: u8, P> WriteReady for Transmitter<NUMBER, P> {
        fn write_ready(&mut self) -> Result<bool, Infallible> {
            Ok(!uart_status(NUMBER).has(TRANSMIT_FULL))
        }
    }

    impl<const NUMBER: u8, P> ErrorType for Receiver<NUMBER, P> {
        type Error = Error;
    }

    impl<const NUMBER: u8, P> Read for Receiver<NUMBER, P> {
        /// Waits for one byte, then takes what is there. An error that follows good bytes is returned by the next call.
        fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Error> {
            let mut taken = 0;
            for place in buffer.iter_mut() {
                if taken > 0 && !self.has_good_byte() {
                    break;
                }
                *place = loop {
                    if let Some(received) = self.try_read() {
                        break received?;
                    }
                };
                taken += 1;
            }
            Ok(taken)
        }
    }

    impl<const NUMBER: u8, P> ReadReady for Receiver<NUMBER, P> {
        fn read_ready(&mut self) -> Result<bool, Error> {
            Ok(self.is_ready())
        }
    }

    impl<const NUMBER: u8, P> Receiver<NUMBER, P> {
        fn has_good_byte(&self) -> bool {
            let status = uart_status(NUMBER).read();
            status & super::RECEIVED != 0 && status & (super::OVERRUN | super::FRAMING | super::PARITY) == 0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{RateError, divider};

    /// Values of section 14 for 80 MHz and four clocks a bit, and rates that cannot be made.
    #[test]
    fn dividers_are_those_of_the_table() {
        assert_eq!(divider(115_200, 80_000_000), Ok(173));
        assert_eq!(divider(230_400, 80_000_000), Ok(86));
        assert_eq!(divider(9_600, 80_000_000), Ok(2_082));
        assert_eq!(divider(230_400, 4_000_000), Err(RateError { wanted: 230_400 }));
        assert_eq!(divider(0, 80_000_000), Err(RateError { wanted: 0 }));
        assert_eq!(divider(100, 80_000_000), Err(RateError { wanted: 100 }));
    }
}
