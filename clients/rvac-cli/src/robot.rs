//! A robot on the serial line, while a person reads and types at the terminal.

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::channel;

use anyhow::Context as _;
use calibration::{Hold, Robot, RobotEvent};
use serial2::SerialPort;

use crate::lines;
use crate::listen::listen;

/// Opens the line and a session on it.
pub(crate) fn open(port: &Path, baud: u32) -> anyhow::Result<Robot> {
    let serial = SerialPort::open(port, baud)
        .with_context(|| format!("cannot open {} at {baud} baud", port.display()))?;
    let serial = Arc::new(serial);
    let (events, inbox) = channel();
    listen(
        Arc::clone(&serial),
        events.clone(),
        RobotEvent::Received,
        RobotEvent::Lost,
    );
    lines::read_input(events, RobotEvent::Typed, || RobotEvent::InputEnded);
    Ok(Robot::open(
        Box::new(SerialWriter(serial)),
        inbox,
        Hold::NotAsked,
    )?)
}

/// The end of the line that is written, while a thread reads the other.
struct SerialWriter(Arc<SerialPort>);

impl Write for SerialWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
