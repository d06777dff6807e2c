//! The two hardware UARTs, which only receive. The gyro module is on one of them and the built-in Linux board on the
//! other; which is not documented. Also the gyro itself, if its frames are calibrated.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use cordlib::board::HeadingSensor;
#[cfg(not(feature = "link-spi"))]
use pic32mx3_hal::gpio::Output;
use pic32mx3_hal::gpio::{Input, Pin};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::uart::{Listener, Receiver, Uart};
use rvac_protocol::message::{Gyro, Refusal};
use soft_uart::ByteRing;

use super::tick;
use crate::calibration::GyroCalibration;
use crate::logic::gyro_frame::FrameReader;
use crate::logic::interrupt_rate::InterruptRateLimit;

const BUS_HZ: u32 = 80_000_000;
/// Bytes that wait for the main loop: 2 ms at a million baud.
const BYTES: usize = 256;
/// Interrupts of a port in a millisecond: a byte each at a million baud.
const BYTES_PER_MS: u32 = 120;
/// A gyro that has sent nothing for this long gives no heading.
const SILENT_MS: u32 = 100;

static RECEIVED: [ByteRing<BYTES>; 2] = [const { ByteRing::new() }; 2];
static LOST: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];
static RATE_LIMITS: [InterruptRateLimit; 2] = [const { InterruptRateLimit::new(BYTES_PER_MS) }; 2];
static PORT_1: HandlerCell<vector::UART_1, Receiver<1, Pin<'F', 2, Input>>> = HandlerCell::empty();
static PORT_2: HandlerCell<vector::UART_2, Receiver<2, Pin<'F', 4, Input>>> = HandlerCell::empty();
const SOURCES: [Source; 2] = [Source::Uart1Received, Source::Uart2Received];

/// Bytes that the receiver's own queue holds.
const QUEUE: usize = 8;

macro_rules! on_byte {
    ($handler:ident, $vector:ident, $cell:ident, $number:literal) => {
        fn $handler(context: &mut Context<vector::$vector>) {
            if let Some(receiver) = $cell.get(context) {
                for _ in 0..QUEUE {
                    match receiver.try_read() {
                        None => break,
                        Some(Ok(byte)) if RECEIVED[$number].push(&[byte]) == 1 => {}
                        Some(_) => lose(&LOST[$number]),
                    }
                }
            }
            SOURCES[$number].clear();
            if !RATE_LIMITS[$number].spend() {
                SOURCES[$number].disable();
            }
        }
        interrupt!($vector, $handler);
    };
}

on_byte!(on_byte_1, UART_1, PORT_1, 0);
on_byte!(on_byte_2, UART_2, PORT_2, 1);

fn lose(lost: &AtomicU32) {
    lost.store(lost.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// A hardware port by the maker's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortNumber {
    /// UART1.
    One,
    /// UART2.
    Two,
}

impl PortNumber {
    /// 1 or 2.
    #[must_use]
    pub const fn new(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::One),
            2 => Some(Self::Two),
            _ => None,
        }
    }

    const fn index(self) -> usize {
        self as usize
    }
}

/// Who listens to a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum User {
    Nobody = 0,
    Gyro = 1,
    Probe = 2,
}

static USERS: [AtomicU8; 2] = [const { AtomicU8::new(User::Nobody as u8) }; 2];

fn user(port: PortNumber) -> User {
    const GYRO: u8 = User::Gyro as u8;
    const PROBE: u8 = User::Probe as u8;
    match USERS
        .get(port.index())
        .map_or(0, |user| user.load(Ordering::Relaxed))
    {
        GYRO => User::Gyro,
        PROBE => User::Probe,
        _ => User::Nobody,
    }
}

/// Low = the gyro module has power.
#[cfg(not(feature = "link-spi"))]
pub type GyroSwitch = Pin<'F', 7, Output>;

/// A link by SPI has the pin of the switch: the module has power always or never.
#[cfg(feature = "link-spi")]
#[derive(Debug)]
pub struct GyroSwitch;

#[cfg(feature = "link-spi")]
impl GyroSwitch {
    const fn set_low(&mut self) {}
    const fn set_high(&mut self) {}
}

/// Both ports and the power of the module.
#[derive(Debug)]
pub struct SerialPorts {
    one: Listener<1>,
    two: Listener<2>,
    power: GyroSwitch,
    gyro: Option<(PortNumber, u32)>,
    probed: Option<PortNumber>,
}

/// What the ports are made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct SerialParts {
    pub uart1: (Uart<1>, Pin<'F', 2, Input>),
    pub uart2: (Uart<2>, Pin<'F', 4, Input>),
    pub power: GyroSwitch,
}

impl SerialPorts {
    /// Opens the port of the gyro module if port and rate are calibrated; else both ports are off and it has no power.
    #[must_use]
    pub fn take(parts: SerialParts, gyro: Option<GyroCalibration>) -> Self {
        let (uart, pin) = parts.uart1;
        let (one, receiver) = uart.into_listener(pin);
        // Each is given once, because `Peripherals` gives its parts once.
        PORT_1.hand_over(receiver).ok();
        let (uart, pin) = parts.uart2;
        let (two, receiver) = uart.into_listener(pin);
        PORT_2.hand_over(receiver).ok();
        for vector in [Vector::Uart1, Vector::Uart2] {
            interrupt::set_priority(vector, Priority::Level3, SubPriority::Sub0).ok();
        }
        let mut power = parts.power;
        power.set_high();
        let mut ports = Self {
            one,
            two,
            power,
            gyro: None,
            probed: None,
        };
        let known = gyro.and_then(|known| Some((PortNumber::new(known.uart)?, known.baud)));
        ports.gyro = known.filter(|(port, baud)| ports.open(*port, *baud, User::Gyro).is_ok());
        ports
    }

    /// The port of the gyro module, if it is known and could be opened.
    #[must_use]
    pub fn gyro(&self) -> Option<PortNumber> {
        self.gyro.map(|(port, _)| port)
    }

    /// Called once a millisecond: enables ports again that were disabled for noise.
    pub fn service(&mut self) {
        for (port, (budget, source)) in [PortNumber::One, PortNumber::Two]
            .into_iter()
            .zip(RATE_LIMITS.iter().zip(SOURCES))
        {
            if budget.renew() && user(port) != User::Nobody {
                source.enable();
            }
        }
    }

    /// Opens a port for a probe; one that was open is closed.
    ///
    /// # Errors
    /// `Absent` without such a port, `Range` if the chip cannot make the rate.
    pub fn probe(&mut self, port: u8, baud: u32) -> Result<(), Refusal> {
        self.end_probe();
        let port = PortNumber::new(port).ok_or(Refusal::Absent)?;
        self.probed = Some(port);
        let opened = self.open(port, baud, User::Probe);
        if opened.is_err() {
            self.end_probe();
        }
        opened
    }

    /// Takes bytes of the probed port.
    pub fn read_probed(&mut self, bytes: &mut [u8]) -> usize {
        let Some(port) = self.probed else {
            return 0;
        };
        let mut count = 0;
        for place in bytes {
            let Some(byte) = next(port) else {
                break;
            };
            *place = byte;
            count += 1;
        }
        count
    }

    /// Bytes lost on the probed port.
    #[must_use]
    pub fn probed_lost(&self) -> u32 {
        self.probed.map_or(0, lost)
    }

    /// Ends a probe and opens the gyro's port again.
    pub fn end_probe(&mut self) {
        let Some(port) = self.probed.take() else {
            return;
        };
        match port {
            PortNumber::One => self.one.stop(),
            PortNumber::Two => self.two.stop(),
        }
        self.set_user(port, User::Nobody);
        if let Some((gyro, baud)) = self.gyro
            && gyro == port
        {
            // It could be opened at this rate before.
            self.open(gyro, baud, User::Gyro).ok();
        }
    }

    fn open(&mut self, port: PortNumber, baud: u32, user: User) -> Result<(), Refusal> {
        let index = port.index();
        while RECEIVED.get(index).and_then(ByteRing::pop).is_some() {}
        if let Some(lost) = LOST.get(index) {
            lost.store(0, Ordering::Relaxed);
        }
        let started = match port {
            PortNumber::One => self.one.start(baud, BUS_HZ),
            PortNumber::Two => self.two.start(baud, BUS_HZ),
        };
        self.set_user(port, if started.is_ok() { user } else { User::Nobody });
        started.map_err(|_| Refusal::Range)
    }

    /// The module has power while any port is open: it may be on either port.
    fn set_user(&mut self, port: PortNumber, user: User) {
        let index = port.index();
        if let Some(place) = USERS.get(index) {
            place.store(user as u8, Ordering::Relaxed);
        }
        if let Some(source) = SOURCES.get(index) {
            match user {
                User::Nobody => source.disable(),
                User::Gyro | User::Probe => source.enable(),
            }
        }
        if USERS
            .iter()
            .any(|user| user.load(Ordering::Relaxed) != User::Nobody as u8)
        {
            self.power.set_low();
        } else {
            self.power.set_high();
        }
    }
}

/// The next byte of a port.
fn next(port: PortNumber) -> Option<u8> {
    RECEIVED.get(port.index()).and_then(ByteRing::pop)
}

/// Bytes that a port has lost since it was opened.
fn lost(port: PortNumber) -> u32 {
    LOST.get(port.index())
        .map_or(0, |lost| lost.load(Ordering::Relaxed))
}

/// The gyro module.
#[derive(Debug)]
pub struct GyroModule {
    port: Option<PortNumber>,
    reader: FrameReader,
    newest: Option<(Gyro, u32)>,
    lost: u32,
}

impl GyroModule {
    /// Reads frames from this port; `None` if the module is not calibrated.
    #[must_use]
    pub fn take(port: Option<PortNumber>) -> Self {
        Self {
            port,
            reader: FrameReader::default(),
            newest: None,
            lost: 0,
        }
    }

    /// Called once a millisecond: reads received frames.
    pub fn service(&mut self) {
        let Some(port) = self.port.filter(|port| user(*port) == User::Gyro) else {
            self.reader.restart();
            return;
        };
        let lost = lost(port);
        if lost != self.lost {
            self.lost = lost;
            self.reader.restart();
        }
        while let Some(byte) = next(port) {
            if let Some(gyro) = self.reader.push(byte) {
                self.newest = Some((gyro, tick::ticks()));
            }
        }
    }
}

impl HeadingSensor for GyroModule {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        let (gyro, at) = self.newest?;
        let age_ms = tick::ticks().wrapping_sub(at);
        if age_ms > SILENT_MS {
            self.newest = None;
            return None;
        }
        Some(gyro)
    }
}
