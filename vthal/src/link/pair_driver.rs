//! The driver of an RS-485 pair that the daemon itself switches, by a line of a GPIO chip.

use std::io;

use gpiocdev::Request;
use gpiocdev::line::Value;
use robot_link::GpioLine;

use super::clocked::CONSUMER;
use crate::serial::OpenError;

/// Switches the driver of a pair on and off.
pub(super) trait PairDriver: Send + 'static {
    /// On to send, off to hear.
    fn switch(&mut self, is_on: bool) -> io::Result<()>;
}

/// A GPIO line. It is off while nobody sends; whoever holds the pair low otherwise is the hardware's to choose.
#[derive(Debug)]
pub(super) struct GpioDriver {
    line: Request,
    number: u32,
}

impl GpioDriver {
    /// Takes the line, off.
    pub(super) fn request(line: &GpioLine, is_high: bool) -> Result<Self, OpenError> {
        let mut builder = Request::builder();
        builder
            .on_chip(&line.chip)
            .with_consumer(CONSUMER)
            .with_line(line.line)
            .as_output(Value::Inactive);
        if !is_high {
            builder.as_active_low();
        }
        let line_request = builder
            .request()
            .map_err(|error| OpenError::refused(&line.chip, io::Error::other(error.to_string())))?;
        Ok(Self {
            line: line_request,
            number: line.line,
        })
    }
}

impl PairDriver for GpioDriver {
    fn switch(&mut self, is_on: bool) -> io::Result<()> {
        let value = if is_on { Value::Active } else { Value::Inactive };
        self.line
            .set_value(self.number, value)
            .map(drop)
            .map_err(|error| io::Error::other(error.to_string()))
    }
}
