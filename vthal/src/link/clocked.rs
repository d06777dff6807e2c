//! Links that the host clocks: a thread between the bus, which makes its caller wait, and the stream that the daemon sees.

use std::fmt::Display;
use std::io::{self, Read, Write};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream as BlockingStream;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use gpiocdev::Request;
use gpiocdev::line::{EdgeDetection, Value};
use i2cdev::core::{I2CMessage as _, I2CTransfer as _};
use i2cdev::linux::{LinuxI2CBus, LinuxI2CError, LinuxI2CMessage};
use robot_link::{
    ClockedEnd, ClockedHost, GpioLine, I2cAddress, I2cBus, I2cHost, SpiAddress, SpiBus, SpiHost,
    TransfersOver,
};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use spidev::{SpiModeFlags, Spidev, SpidevOptions, SpidevTransfer};
use tokio::net::UnixStream;

use crate::serial::OpenError;

/// Bytes of the daemon that may wait for the bus; the rest stays in the stream.
const WAITING_MAX: usize = 4096;
/// What the kernel shows as the user of a line.
pub(super) const CONSUMER: &str = "vthal";

/// The stream, and where the thread says why it ended.
type Served = (UnixStream, Arc<OnceLock<String>>);

struct SpiDevice(Spidev);

impl SpiBus for SpiDevice {
    type Error = io::Error;

    fn exchange(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        let out = bytes.to_vec();
        self.0.transfer(&mut SpidevTransfer::read_write(&out, bytes))
    }
}

struct I2cDevice {
    bus: LinuxI2CBus,
    address: u16,
}

impl I2cBus for I2cDevice {
    type Error = LinuxI2CError;

    fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), LinuxI2CError> {
        let number = [register];
        let mut messages = [
            LinuxI2CMessage::write(&number).with_address(self.address),
            LinuxI2CMessage::read(bytes).with_address(self.address),
        ];
        self.bus.transfer(&mut messages).map(drop)
    }

    fn write(&mut self, register: u8, bytes: &[u8]) -> Result<(), LinuxI2CError> {
        let whole: Vec<u8> = std::iter::once(register).chain(bytes.iter().copied()).collect();
        let mut messages = [LinuxI2CMessage::write(&whole).with_address(self.address)];
        self.bus.transfer(&mut messages).map(drop)
    }
}

/// Begins to clock an SPI device.
pub(super) fn start_spi(address: &SpiAddress) -> Result<Served, OpenError> {
    let refused = |error| OpenError::refused(&address.path, error);
    let mode = [
        SpiModeFlags::SPI_MODE_0,
        SpiModeFlags::SPI_MODE_1,
        SpiModeFlags::SPI_MODE_2,
        SpiModeFlags::SPI_MODE_3,
    ];
    let mode = mode.get(usize::from(address.mode)).copied();
    let mut device = Spidev::open(&address.path).map_err(refused)?;
    let options = SpidevOptions::new()
        .bits_per_word(8)
        .max_speed_hz(address.hz)
        .mode(mode.unwrap_or(SpiModeFlags::SPI_MODE_0))
        .build();
    device.configure(&options).map_err(refused)?;
    let place = (address.path.as_path(), address.attention.as_ref());
    start(SpiHost::default(), SpiDevice(device), place)
}

/// Begins to clock an I2C bus.
pub(super) fn start_i2c(address: &I2cAddress) -> Result<Served, OpenError> {
    let bus = LinuxI2CBus::new(&address.path)
        .map_err(|error| OpenError::refused(&address.path, io::Error::other(error)))?;
    let device = I2cDevice {
        bus,
        address: address.address.into(),
    };
    let place = (address.path.as_path(), address.attention.as_ref());
    start(I2cHost::default(), device, place)
}

fn start<H, B>(host: H, bus: B, (path, attention): (&Path, Option<&GpioLine>)) -> Result<Served, OpenError>
where
    H: TransfersOver<B, Error: Display> + Send + 'static,
    B: Send + 'static,
{
    let refused = |error| OpenError::refused(path, error);
    let attention = attention.map(request).transpose()?;
    let (ours, theirs) = BlockingStream::pair().map_err(refused)?;
    ours.set_nonblocking(true).map_err(refused)?;
    theirs.set_nonblocking(true).map_err(refused)?;
    let complaint = Arc::new(OnceLock::new());
    let told = Arc::clone(&complaint);
    std::thread::Builder::new()
        .name("link".to_owned())
        .spawn(move || {
            if let Err(reason) = clock((host, bus), &ours, attention.as_ref()) {
                // The first reason stays.
                told.set(reason).ok();
            }
        })
        .map_err(refused)?;
    Ok((UnixStream::from_std(theirs).map_err(refused)?, complaint))
}

fn request(attention: &GpioLine) -> Result<Request, OpenError> {
    let mut builder = Request::builder();
    builder
        .on_chip(&attention.chip)
        .with_consumer(CONSUMER)
        .with_line(attention.line)
        .as_input()
        .with_edge_detection(EdgeDetection::RisingEdge);
    builder
        .request()
        .map_err(|error| OpenError::refused(&attention.chip, io::Error::other(error.to_string())))
}

/// Passes bytes until the daemon closes the stream or the bus fails.
fn clock<H, B>(
    (host, mut bus): (H, B),
    stream: &BlockingStream,
    attention: Option<&Request>,
) -> Result<(), String>
where
    H: TransfersOver<B, Error: Display>,
{
    let mut end = ClockedEnd::new(host, attention.is_some());
    let mut heard = Vec::new();
    loop {
        if end.waiting() < WAITING_MAX && take_orders(&mut end, stream)? {
            return Ok(());
        }
        end.turn(&mut bus, &mut heard).map_err(|error| words(&error))?;
        if let Some(attention) = attention
            && calls(attention)?
        {
            end.called();
        }
        if !heard.is_empty() {
            give_out(stream, &heard)?;
            heard.clear();
        }
        if end.rest_us() > 0 {
            rest(stream, attention, Duration::from_micros(end.rest_us()))?;
        }
    }
}

/// Takes what the daemon sends; whether it has closed the stream.
fn take_orders(end: &mut ClockedEnd<impl ClockedHost>, mut stream: &BlockingStream) -> Result<bool, String> {
    let mut bytes = [0; 1024];
    match stream.read(&mut bytes) {
        Ok(0) => Ok(true),
        Ok(count) => {
            end.send(bytes.get(..count).unwrap_or_default());
            Ok(false)
        }
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(false),
        Err(error) => Err(error.to_string()),
    }
}

/// Whether the robot says that it has more.
fn calls(attention: &Request) -> Result<bool, String> {
    let text = |error: gpiocdev::Error| error.to_string();
    while attention.has_edge_event().map_err(text)? {
        attention.read_edge_event().map_err(text)?;
    }
    let lines = attention.lone_value().map_err(text)?;
    Ok(lines == Value::Active)
}

/// Hands on what was heard; a daemon that does not take it makes the bus wait.
fn give_out(mut stream: &BlockingStream, mut bytes: &[u8]) -> Result<(), String> {
    while !bytes.is_empty() {
        match stream.write(bytes) {
            Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                poll(&mut [PollFd::new(&stream, PollFlags::OUT)], None).map_err(|error| words(&error))?;
            }
            Err(error) => return Err(error.to_string()),
        }
    }
    Ok(())
}

/// Waits until the daemon has something, the robot calls, or the pause is over.
fn rest(stream: &BlockingStream, attention: Option<&Request>, pause: Duration) -> Result<(), String> {
    let pause = Timespec::try_from(pause).map_err(|error| words(&error))?;
    let daemon = PollFd::new(stream, PollFlags::IN);
    let woken = match attention {
        None => poll(&mut [daemon], Some(&pause)),
        Some(line) => {
            let line = line.as_fd();
            poll(&mut [daemon, PollFd::new(&line, PollFlags::IN)], Some(&pause))
        }
    };
    match woken {
        Ok(_) | Err(rustix::io::Errno::INTR) => Ok(()),
        Err(error) => Err(words(&error)),
    }
}

fn words(error: &dyn Display) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests;
