//! How each kind of link is opened.

use std::fmt::Debug;
use std::io;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use robot_link::{Abilities, Direction, LinkAddress, OneWire, UartAddress, Wires};
use serial2_tokio::SerialPort;
use serial2_tokio::rs4xx::{Rs485Config, TransceiverMode};
use tokio::io::{AsyncRead, AsyncWrite};
use vthal_core::device::Opening;

use super::line_marks::{LineMarks, mark_errors};
use super::pair_driver::GpioDriver;
use super::{clocked, network, shared_wire};
use crate::serial::{self, DeviceLock, Line, OpenError, SerialSettings};

/// Bytes in and out.
pub(crate) trait ByteStream: AsyncRead + AsyncWrite + Unpin + Debug {}

impl<S: AsyncRead + AsyncWrite + Unpin + Debug> ByteStream for S {}

/// An open link: bytes in and out, and what it can.
#[derive(Debug)]
pub(crate) struct Link {
    /// Bytes.
    pub stream: Box<dyn ByteStream>,
    /// What it can.
    pub abilities: Abilities,
    /// The kernel marks bytes that came with an error.
    pub marks: Option<LineMarks>,
    /// Whether another rate may be tried.
    pub has_rates: bool,
    /// Why what serves the other end of the stream has ended.
    pub complaint: Option<Arc<OnceLock<String>>>,
    _lock: Option<DeviceLock>,
}

/// Why a link is not open.
#[derive(Debug, thiserror::Error)]
pub(crate) enum LinkOpenError {
    /// A device of this machine.
    #[error(transparent)]
    Device(#[from] OpenError),
    /// The other end of a network.
    #[error("cannot reach {host} port {port}: {error}; trying again every 2 s")]
    Network {
        /// Host.
        host: String,
        /// Port.
        port: u16,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// A file of certificates.
    #[error("cannot use {file}: {reason}; trying again every 2 s")]
    Certificate {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// A robot of this make has to be woken by a pulse, which only a serial device has.
    #[error("this robot has to be woken by a pulse on RTS, which this link does not have: use uart:")]
    NoPulse,
}

/// Opens the link and wakes the robot at its other end, if it needs that.
pub(super) async fn open_to_robot(
    (address, opening): (&LinkAddress, Opening),
    baud: u32,
) -> Result<Link, LinkOpenError> {
    let abilities = address.abilities();
    let link = |stream: Box<dyn ByteStream>, lock, complaint| Link {
        stream,
        abilities,
        marks: None,
        has_rates: matches!(address, LinkAddress::Uart(_)),
        complaint,
        _lock: lock,
    };
    match address {
        LinkAddress::Uart(uart) => {
            let line = open_serial(&uart.path, baud)?;
            let refused = |error| OpenError::refused(&uart.path, error);
            wake(&line.port, opening).await.map_err(refused)?;
            let driver = match &uart.wires {
                Wires::Two => {
                    let marks = marks_of(&line);
                    let link = link(Box::new(line.port), Some(line.lock), None);
                    return Ok(Link { marks, ..link });
                }
                Wires::One => None,
                Wires::Pair(direction) => drive_pair(&line.port, direction, uart)?,
            };
            let wire = OneWire::new(uart.wires == Wires::One, baud);
            let (stream, complaint) = match driver {
                None => shared_wire::start(line.port, wire, None::<(GpioDriver, u32)>),
                Some(driver) => shared_wire::start(line.port, wire, Some((driver, baud))),
            };
            Ok(link(Box::new(stream), Some(line.lock), Some(complaint)))
        }
        LinkAddress::Usb(path) => {
            let line = open_serial(path, baud)?;
            wake(&line.port, opening)
                .await
                .map_err(|error| OpenError::refused(path, error))?;
            let marks = marks_of(&line);
            let link = link(Box::new(line.port), Some(line.lock), None);
            Ok(Link { marks, ..link })
        }
        _ if opening.wake_pulse_ms > 0 => Err(LinkOpenError::NoPulse),
        LinkAddress::Tcp(peer) => Ok(link(Box::new(network::connect(peer).await?), None, None)),
        LinkAddress::Tls(peer) => Ok(link(Box::new(network::connect_secured(peer).await?), None, None)),
        LinkAddress::Spi(spi) => {
            let lock = serial::lock(&spi.path)?;
            let (stream, complaint) = clocked::start_spi(spi)?;
            Ok(link(Box::new(stream), Some(lock), Some(complaint)))
        }
        LinkAddress::I2c(i2c) => {
            let lock = serial::lock(&i2c.path)?;
            let (stream, complaint) = clocked::start_i2c(i2c)?;
            Ok(link(Box::new(stream), Some(lock), Some(complaint)))
        }
    }
}

fn open_serial(path: &Path, baud: u32) -> Result<Line, OpenError> {
    serial::open(&SerialSettings {
        path: path.to_owned(),
        baud,
    })
}

/// Asks the kernel to mark bytes that come with an error. A port that refuses works without; who shares a wire hears itself, and
/// what it hears then proves nothing.
fn marks_of(line: &Line) -> Option<LineMarks> {
    mark_errors(&line.lock).ok().map(|()| LineMarks::default())
}

/// The kernel switches the driver of the pair itself, to the bit, where that of the port can; else a GPIO line that a program
/// switches has to do, a little late.
fn drive_pair(
    port: &SerialPort,
    direction: &Direction,
    uart: &UartAddress,
) -> Result<Option<GpioDriver>, OpenError> {
    let (line, is_high) = match direction {
        Direction::RtsHigh | Direction::RtsLow => {
            let mut mode = Rs485Config::new();
            mode.set_full_duplex(false);
            mode.set_invert_rts(*direction == Direction::RtsLow);
            let done = port.set_rs4xx_mode(TransceiverMode::Rs485(mode));
            return done.map(|()| None).map_err(|error| {
                let text = format!(
                    "its driver cannot switch the direction of an RS-485 pair ({error}): join the pair's driver to a GPIO line \
                     and write direction=gpiochip0:17"
                );
                OpenError::refused(&uart.path, io::Error::new(error.kind(), text))
            });
        }
        Direction::LineHigh(line) => (line, true),
        Direction::LineLow(line) => (line, false),
    };
    GpioDriver::request(line, is_high).map(Some)
}

async fn wake(port: &SerialPort, opening: Opening) -> io::Result<()> {
    if opening.wake_pulse_ms > 0 {
        // An asserted line is low at the plug.
        port.set_rts(true)?;
        tokio::time::sleep(Duration::from_millis(opening.wake_pulse_ms.into())).await;
        port.set_rts(false)?;
    }
    if opening.settle_ms > 0 {
        tokio::time::sleep(Duration::from_millis(opening.settle_ms.into())).await;
    }
    Ok(())
}
