//! The lock, reset causes and the software reset, device identity, and who owns the JTAG pins.

use super::configuration::Configuration;

/// What resets the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResetSource {
    /// The supply comes up.
    PowerOn,
    /// The supply was too low for a moment.
    BrownOut,
    /// The MCLR pin.
    MasterClear,
    /// The program, through RSWRST.
    Software,
    /// The watchdog.
    Watchdog,
}

impl ResetSource {
    /// Its bit in RCON.
    const fn bit(self) -> u32 {
        match self {
            ResetSource::PowerOn => 1 << 0 | 1 << 1,
            ResetSource::BrownOut => 1 << 1,
            ResetSource::MasterClear => 1 << 7,
            ResetSource::Software => 1 << 6,
            ResetSource::Watchdog => 1 << 4,
        }
    }
}

/// RCON.WDTO.
pub(crate) const WATCHDOG_BIT: u32 = 1 << 4;
/// RCON.SLEEP.
pub(crate) const SLEEP_BIT: u32 = 1 << 3;
/// RCON.IDLE.
pub(crate) const IDLE_BIT: u32 = 1 << 2;
const RCON_WRITABLE: u32 = 0x3DF;
/// Bits 27:0 name the part; the silicon revision above them is given as 0.
const DEVICE: u32 = 0x0093_4053;
const JTAG: u32 = 1 << 3;
const TRACE: u32 = 1 << 2;
const FIRST_KEY: u32 = 0xAA99_6655;
const SECOND_KEY: u32 = 0x5566_99AA;

/// A lock that two words in a row open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lock {
    Closed,
    HalfOpen,
    Open,
}

impl Lock {
    /// The lock after this word; any word but the next of the two closes it.
    pub(crate) fn after(self, word: u32) -> Lock {
        match (self, word) {
            (_, FIRST_KEY) => Lock::HalfOpen,
            (Lock::HalfOpen, SECOND_KEY) => Lock::Open,
            _ => Lock::Closed,
        }
    }
}

/// The registers.
#[derive(Clone, Debug)]
pub(crate) struct SystemRegisters {
    lock: Lock,
    causes: u32,
    reset_armed: bool,
    debug_port: u32,
}

/// What a write leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SystemWrite {
    /// Nothing for others.
    Fine,
    /// The JTAG or trace pins changed hands.
    Pins,
    /// The register is locked, and the write was lost.
    Locked,
}

impl SystemRegisters {
    pub(crate) fn new() -> SystemRegisters {
        SystemRegisters {
            lock: Lock::Closed,
            causes: ResetSource::PowerOn.bit(),
            reset_armed: false,
            debug_port: JTAG,
        }
    }

    /// After a reset: RCON keeps what it had, except at power-on.
    pub(crate) fn reset(&mut self, source: ResetSource) {
        let causes = if source == ResetSource::PowerOn {
            0
        } else {
            self.causes
        };
        *self = SystemRegisters {
            causes: causes | source.bit(),
            ..SystemRegisters::new()
        };
    }

    /// Sets a bit of RCON.
    pub(crate) fn note_cause(&mut self, bit: u32) {
        self.causes |= bit;
    }

    pub(crate) fn causes(&self) -> u32 {
        self.causes
    }

    /// Another access came between the two words.
    pub(crate) fn disturb_lock(&mut self) {
        if self.lock == Lock::HalfOpen {
            self.lock = Lock::Closed;
        }
    }

    pub(crate) fn is_open(&self) -> bool {
        self.lock == Lock::Open
    }

    /// Pins of port A that JTAG and trace hold, and those of port G.
    pub(crate) fn held_pins(&self) -> (u16, u16) {
        let jtag = if self.debug_port & JTAG != 0 { 0x0033 } else { 0 };
        if self.debug_port & TRACE != 0 {
            (jtag | 0x00C0, 0x7000)
        } else {
            (jtag, 0)
        }
    }

    /// The block at 0xBF80F200: DDPCON, DEVID, SYSKEY.
    pub(crate) fn read_device(&self, word: u8) -> Option<u32> {
        match word {
            0 => Some(self.debug_port),
            2 => Some(DEVICE),
            3 => Some(0),
            _ => None,
        }
    }

    pub(crate) fn write_device(&mut self, word: u8, value: u32) -> SystemWrite {
        match word {
            0 => {
                self.debug_port = value & (JTAG | TRACE);
                SystemWrite::Pins
            }
            3 => {
                self.lock = self.lock.after(value);
                SystemWrite::Fine
            }
            _ => SystemWrite::Fine,
        }
    }

    /// The block at 0xBF80F600: RCON, RSWRST.
    pub(crate) fn read_reset(&self, word: u8) -> Option<u32> {
        match word {
            0 => Some(self.causes),
            1 => Some(u32::from(self.reset_armed)),
            _ => None,
        }
    }

    pub(crate) fn write_reset(&mut self, word: u8, value: u32) -> SystemWrite {
        if word == 0 {
            self.causes = value & RCON_WRITABLE;
        } else if self.is_open() {
            self.reset_armed = value & 1 != 0;
        } else {
            return SystemWrite::Locked;
        }
        SystemWrite::Fine
    }

    /// The program has read RSWRST: whether that resets the chip.
    pub(crate) fn is_reset_armed(&self) -> bool {
        self.reset_armed
    }
}

/// The watchdog, which runs from the low-power oscillator whatever the system clock does.
#[derive(Clone, Debug)]
pub(crate) struct Watchdog {
    on: bool,
    always: bool,
    exponent: u32,
    fed_at: u64,
}

const WATCHDOG_ON: u32 = 1 << 15;
const WATCHDOG_CLEAR: u32 = 1 << 0;

impl Watchdog {
    pub(crate) fn new(configuration: &Configuration, cycle: u64) -> Watchdog {
        let always = configuration.watchdog_always();
        Watchdog {
            on: always,
            always,
            exponent: configuration.watchdog_exponent(),
            fed_at: cycle,
        }
    }

    pub(crate) fn read(&self) -> u32 {
        self.exponent << 2 | if self.on { WATCHDOG_ON } else { 0 }
    }

    pub(crate) fn write(&mut self, value: u32, cycle: u64) {
        let on = self.always || value & WATCHDOG_ON != 0;
        if value & WATCHDOG_CLEAR != 0 || on && !self.on {
            self.fed_at = cycle;
        }
        self.on = on;
    }

    /// When it barks: 2^WDTPS ms after it was fed.
    pub(crate) fn barks_at(&self) -> u64 {
        let period = super::rate::Rate::from_hz(super::clock::LOW_POWER_HZ).cycles_for(32 << self.exponent);
        if self.on {
            self.fed_at + period
        } else {
            super::rate::NEVER
        }
    }

    /// It has barked without a reset (out of Idle, or in debug mode): it starts again.
    pub(crate) fn restart(&mut self, cycle: u64) {
        self.fed_at = cycle;
    }
}
