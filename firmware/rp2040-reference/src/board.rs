//! The parts that every robot has, on this chip: a clock, a link, a watchdog, and why it started. All others are absent until somebody
//! writes them.

use cordlib::board::{Absent, Clock, Link, Parts, Received, ResetRecord, Watchdog, WheelDrive, WheelMotors};
use rp2040_hal::gpio::bank0::{Gpio0, Gpio1};
use rp2040_hal::gpio::{FunctionUart, Pin, PullDown, PullUp};
use rp2040_hal::pac;
use rp2040_hal::timer::Timer;
use rp2040_hal::uart::{Enabled, ReadErrorType, UartPeripheral};
use rp2040_hal::watchdog::{ScratchRegister, Watchdog as ChipWatchdog};
use rvac_protocol::message::ResetCause;
use rvac_units::Tick;

/// The parts of this board, for cordlib.
pub(crate) struct ReferenceBoard;

impl Parts for ReferenceBoard {
    type Clock = MicrosecondClock;
    type Link = SerialLink;
    type Wheels = NoWheels;
    type Reset = ChipReset;
    type Watchdog = ChipDog;
    type Kept = Absent;
    type Checks = Absent;
    type Encoders = Absent;
    type Bumpers = Absent;
    type Cliffs = Absent;
    type WheelDrops = Absent;
    type Proximity = Absent;
    type Gyro = Absent;
    type Currents = Absent;
    type BrushMain = Absent;
    type BrushSides = Absent;
    type Vacuum = Absent;
    type Charger = Absent;
    type DockContacts = Absent;
    type DockBeams = Absent;
    type DustBox = Absent;
    type Beeper = Absent;
    type Lights = Absent;
    type Buttons = Absent;
    type Probe = Absent;
}

/// The chip's timer, which counts microseconds.
pub(crate) struct MicrosecondClock(pub(crate) Timer);

impl Clock for MicrosecondClock {
    fn tick(&mut self) -> Tick {
        // Wraps after 49 days, as ticks are meant to.
        Tick((self.0.get_counter().ticks() / 1_000) as u32)
    }

    fn microseconds(&mut self) -> u16 {
        (self.0.get_counter().ticks() % 1_000) as u16
    }
}

/// Transmit on GPIO 0.
type TransmitPin = Pin<Gpio0, FunctionUart, PullDown>;
/// Receive on GPIO 1, pulled up: a line without a Linux board at its end is at rest.
type ReceivePin = Pin<Gpio1, FunctionUart, PullUp>;
/// Both lines of the link.
pub(crate) type LinkLines = (TransmitPin, ReceivePin);
/// The serial port of the link.
pub(crate) type LinkPort = UartPeripheral<Enabled, pac::UART0, LinkLines>;

/// UART0. Its queues hold 32 bytes each way: at 230,400 baud 1.4 ms, and the main loop comes by at least once a millisecond.
pub(crate) struct SerialLink(pub(crate) LinkPort);

impl Link for SerialLink {
    fn receive(&mut self) -> Option<Received> {
        let mut byte = [0];
        match self.0.read_raw(&mut byte) {
            Ok(_) => Some(Received::Byte(byte[0])),
            Err(nb::Error::WouldBlock) => None,
            Err(nb::Error::Other(error)) => Some(match error.err_type {
                ReadErrorType::Overrun => Received::Overrun,
                ReadErrorType::Break | ReadErrorType::Parity | ReadErrorType::Framing => {
                    Received::FramingError
                }
            }),
        }
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        match self.0.write_raw(bytes) {
            Ok(rest) => bytes.len() - rest.len(),
            Err(_) => 0,
        }
    }
}

/// The robot has none yet. Write its bridges here: brake first, then a duty.
pub(crate) struct NoWheels;

impl WheelMotors for NoWheels {
    fn drive(&mut self, _left: WheelDrive, _right: WheelDrive) {}
}

/// The chip's watchdog.
pub(crate) struct ChipDog(pub(crate) ChipWatchdog);

impl Watchdog for ChipDog {
    fn feed(&mut self) {
        self.0.feed();
    }
}

/// Why the chip started. Registers of the watchdog, which only a loss of power clears, count the starts.
pub(crate) struct ChipReset {
    pub(crate) cause: ResetCause,
    pub(crate) boot_count: u32,
    pub(crate) recent: u8,
}

impl ChipReset {
    /// Counts this start.
    pub(crate) fn count(watchdog: &mut ChipWatchdog, cause: ResetCause) -> Self {
        let since_power = cause != ResetCause::PowerOn;
        let kept = |register| {
            if since_power {
                watchdog.read_scratch(register)
            } else {
                0
            }
        };
        let boot_count = kept(ScratchRegister::Scratch0).saturating_add(1);
        let recent = kept(ScratchRegister::Scratch1).saturating_add(u32::from(since_power));
        watchdog.write_scratch(ScratchRegister::Scratch0, boot_count);
        watchdog.write_scratch(ScratchRegister::Scratch1, recent);
        Self {
            cause,
            boot_count,
            recent: recent.min(u32::from(u8::MAX)) as u8,
        }
    }
}

impl ResetRecord for ChipReset {
    fn cause(&mut self) -> ResetCause {
        self.cause
    }

    fn boot_count(&mut self) -> u32 {
        self.boot_count
    }

    fn recent(&mut self) -> u8 {
        self.recent
    }

    fn forget_recent(&mut self) {
        self.recent = 0;
        // The handle of the watchdog's registers is the feeder's; this register is nobody else's.
        // SAFETY: one aligned store to a register that nothing else writes after the start.
        unsafe { (*pac::WATCHDOG::ptr()).scratch1().write(|word| word.bits(0)) };
    }
}
