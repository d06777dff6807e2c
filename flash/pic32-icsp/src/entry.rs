//! Into programming mode and out of it; identity, status and erasure, which need no core.

use crate::error::IcspError;
use crate::part::Part;
use crate::pins::{IcspPins, LineLevel};
use crate::test_port::TestPort;

/// "MCHP", most significant bit first.
const KEY: u32 = 0x4D43_4850;
/// The pulse of the reset line before the key, and how long it may last: a host that was interrupted in it tries again.
const PULSE_US: u32 = 100;
const PULSE_US_MAX: u64 = 400;
/// Before the key and after it.
const KEY_PAUSE_US: u32 = 1_000;
/// Before the first cycle.
const FIRST_CYCLE_US: u32 = 25_000;
/// How often entry is tried.
const TRIES: u32 = 8;
/// The configuration is read within 10 ms; with polls of a millisecond.
const READY_POLLS: u32 = 30;
/// An erasure takes 80 to 400 ms.
const ERASE_POLL_US: u32 = 10_000;
const ERASE_POLLS: u32 = 300;

// Instructions and commands of the chip's own port.
const IDCODE: u8 = 0x01;
const SWITCH_TO_CHIP: u8 = 0x04;
const COMMAND: u8 = 0x07;
const STATUS: u8 = 0x00;
const ERASE: u8 = 0xFC;

const NOT_PROTECTED: u8 = 1 << 7;
const READY: u8 = 1 << 3;
const BUSY: u8 = 1 << 2;
/// These read zero in every status.
const UNUSED: u8 = 1 << 6 | 1 << 4;

impl<P: IcspPins> TestPort<'_, P> {
    /// Enters programming mode, whatever the chip does at the moment.
    ///
    /// # Errors
    /// When a line cannot be set.
    pub fn enter(&mut self) -> Result<(), IcspError<P::Error>> {
        for _ in 0..TRIES {
            self.line_up()?;
            let risen = self.pins.now_us();
            self.pins.set_reset(LineLevel::High).map_err(IcspError::Pins)?;
            self.pins.pause_us(PULSE_US);
            self.pins.set_reset(LineLevel::Low).map_err(IcspError::Pins)?;
            if self.pins.now_us().saturating_sub(risen) <= PULSE_US_MAX {
                break;
            }
        }
        self.pins.pause_us(KEY_PAUSE_US);
        for bit in (0..32).rev() {
            self.key_bit(KEY >> bit & 1 == 1)?;
        }
        self.pins.pause_us(KEY_PAUSE_US);
        self.pins.set_reset(LineLevel::High).map_err(IcspError::Pins)?;
        self.pins.pause_us(FIRST_CYCLE_US);
        self.reset()
    }

    fn line_up(&mut self) -> Result<(), IcspError<P::Error>> {
        self.pins.set_clock(LineLevel::Low).map_err(IcspError::Pins)?;
        self.pins.drive_data(LineLevel::Low).map_err(IcspError::Pins)?;
        self.pins.set_reset(LineLevel::Low).map_err(IcspError::Pins)?;
        self.pins.pause_us(KEY_PAUSE_US);
        Ok(())
    }

    /// Leaves programming mode; the program starts.
    pub(crate) fn leave(&mut self) -> Result<(), IcspError<P::Error>> {
        self.rest()?;
        self.pins.set_reset(LineLevel::Low).map_err(IcspError::Pins)?;
        self.pins.release_data().map_err(IcspError::Pins)?;
        self.pins.pause_us(KEY_PAUSE_US);
        self.pins.set_reset(LineLevel::High).map_err(IcspError::Pins)
    }

    /// What the chip says it is; read twice.
    pub(crate) fn identity(&mut self) -> Result<u32, IcspError<P::Error>> {
        self.reset()?;
        self.instruction(SWITCH_TO_CHIP)?;
        self.instruction(IDCODE)?;
        let first = self.word(0)?;
        let second = self.word(0)?;
        match first {
            0 => Err(IcspError::NoAnswer(LineLevel::Low)),
            u32::MAX => Err(IcspError::NoAnswer(LineLevel::High)),
            _ if first != second => Err(IcspError::Unsteady { first, second }),
            _ => Ok(first),
        }
    }

    /// Selects the chip's commands.
    pub(crate) fn select_commands(&mut self) -> Result<(), IcspError<P::Error>> {
        self.instruction(SWITCH_TO_CHIP)?;
        self.reset()?;
        self.instruction(COMMAND)
    }

    /// Waits until the chip has read its configuration; then refuses another part, and one that is protected.
    pub(crate) fn check(&mut self, allowed: Allowed) -> Result<u32, IcspError<P::Error>> {
        let id = self.identity()?;
        if !Part::SR8730.is(id) {
            return Err(IcspError::WrongPart(id));
        }
        self.select_commands()?;
        let status = self.await_ready(1_000, READY_POLLS)?;
        // A second look: one wrong bit must not let an erasure in.
        let again = self.byte(STATUS)?;
        if status != again {
            return Err(IcspError::Unsteady {
                first: u32::from(status),
                second: u32::from(again),
            });
        }
        match allowed {
            Allowed::OnlyUnprotected if status & NOT_PROTECTED == 0 => Err(IcspError::CodeProtected),
            _ => Ok(id),
        }
    }

    fn await_ready(&mut self, pause_us: u32, polls: u32) -> Result<u8, IcspError<P::Error>> {
        let mut status = 0;
        for _ in 0..polls {
            status = self.byte(STATUS)?;
            if status & (READY | BUSY | UNUSED) == READY {
                return Ok(status);
            }
            self.pins.pause_us(pause_us);
        }
        Err(IcspError::NotReady(status))
    }

    /// Erases everything, configuration words included.
    pub(crate) fn erase_all(&mut self) -> Result<(), IcspError<P::Error>> {
        self.select_commands()?;
        self.byte(ERASE)?;
        self.await_ready(ERASE_POLL_US, ERASE_POLLS).map(|_| ())
    }
}

/// Which chips [`TestPort::check`] lets through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Allowed {
    /// One that may be read.
    OnlyUnprotected,
    /// One that is protected, too: it is going to be erased.
    Protected,
}
