//! A serial device of Linux as the line to the loader.

use std::io::ErrorKind;
use std::path::Path;
use std::time::{Duration, Instant};

use gpiocdev::Request;
use gpiocdev::line::Value;
use serial2::{SerialPort, Settings};

use crate::relax::{IspLine, Power};
use crate::settings::PowerLine;

/// A serial device, and the switch of the supply if there is one.
#[derive(Debug)]
pub struct SerialLine {
    port: SerialPort,
    switch: Option<(Request, u32)>,
    begun: Instant,
}

/// Why the line cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SerialLineError {
    /// The device.
    #[error(transparent)]
    Device(#[from] std::io::Error),
    /// The switch.
    #[error("the line of the power switch: {0}")]
    Switch(#[from] gpiocdev::Error),
}

impl SerialLine {
    /// Opens the device; with a switch, it takes its line, on.
    ///
    /// # Errors
    /// When a device cannot be opened.
    pub fn open(path: &Path, switch: Option<&PowerLine>) -> Result<Self, SerialLineError> {
        let mut port = SerialPort::open(path, |mut line: Settings| {
            line.set_raw();
            line.set_baud_rate(stc_isp::HANDSHAKE_BAUD)?;
            Ok(line)
        })?;
        port.set_write_timeout(Duration::from_secs(5))?;
        Ok(Self {
            port,
            switch: switch.map(request).transpose()?,
            begun: Instant::now(),
        })
    }
}

fn request(power: &PowerLine) -> gpiocdev::Result<(Request, u32)> {
    let mut builder = Request::builder();
    builder.on_chip(&power.chip).with_consumer("rvac flash");
    builder.with_line(power.line);
    match power.active_low {
        true => builder.as_active_low(),
        false => builder.as_active_high(),
    };
    builder.as_output(Value::Active);
    Ok((builder.request()?, power.line))
}

impl IspLine for SerialLine {
    type Error = SerialLineError;

    fn send(&mut self, bytes: &[u8]) -> Result<(), SerialLineError> {
        self.port.write_all(bytes)?;
        Ok(self.port.flush()?)
    }

    fn receive(&mut self, wait_ms: u64) -> Result<Vec<u8>, SerialLineError> {
        self.port
            .set_read_timeout(Duration::from_millis(wait_ms.max(1)))?;
        let mut buffer = [0; 256];
        match self.port.read(&mut buffer) {
            Ok(count) => Ok(buffer.get(..count).unwrap_or_default().to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                Ok(Vec::new())
            }
            Err(error) => Err(error.into()),
        }
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), SerialLineError> {
        let mut settings = self.port.get_configuration()?;
        settings.set_baud_rate(baud)?;
        Ok(self.port.set_configuration(&settings)?)
    }

    fn switch(&mut self, power: Power) -> Result<(), SerialLineError> {
        let value = match power {
            Power::Off => Value::Inactive,
            Power::On => Value::Active,
            Power::ByPerson => {
                eprintln!("Switch the robot off, wait three seconds, and switch it on.");
                return Ok(());
            }
        };
        if let Some((request, line)) = &self.switch {
            request.set_value(*line, value)?;
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        u64::try_from(self.begun.elapsed().as_millis()).unwrap_or(u64::MAX)
    }
}
