//! Why the chip started, and starting it again (section 4).

use crate::cpu;
use crate::register::map::{RCON, RSWRST, SYSKEY};

/// What started the chip: bits of RCON. More than one may be set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Causes(u32);

impl Causes {
    const POWER_ON: u32 = 1;
    const BROWN_OUT: u32 = 1 << 1;
    const IDLE: u32 = 1 << 2;
    const SLEEP: u32 = 1 << 3;
    const WATCHDOG: u32 = 1 << 4;
    const SOFTWARE: u32 = 1 << 6;
    const PIN: u32 = 1 << 7;
    const CONFIGURATION: u32 = 1 << 9;
    const ALL: u32 = Self::POWER_ON
        | Self::BROWN_OUT
        | Self::IDLE
        | Self::SLEEP
        | Self::WATCHDOG
        | Self::SOFTWARE
        | Self::PIN
        | Self::CONFIGURATION;

    /// Reads the causes and clears them, so that the next start reads its own only: the chip does not clear them.
    #[must_use]
    pub fn take() -> Self {
        let causes = RCON.read() & Self::ALL;
        RCON.clear(causes);
        Self(causes)
    }

    /// The bits as RCON has them.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Power came. RCON.BOR is set then, too.
    #[must_use]
    pub const fn power_on(self) -> bool {
        self.0 & Self::POWER_ON != 0
    }

    /// The supply was too low for a while, or power came.
    #[must_use]
    pub const fn brown_out(self) -> bool {
        self.0 & Self::BROWN_OUT != 0
    }

    /// The watchdog was not fed in time.
    #[must_use]
    pub const fn watchdog(self) -> bool {
        self.0 & Self::WATCHDOG != 0
    }

    /// [`software_reset`].
    #[must_use]
    pub const fn software(self) -> bool {
        self.0 & Self::SOFTWARE != 0
    }

    /// The pin MCLR.
    #[must_use]
    pub const fn pin(self) -> bool {
        self.0 & Self::PIN != 0
    }

    /// The configuration words changed by themselves.
    #[must_use]
    pub const fn configuration(self) -> bool {
        self.0 & Self::CONFIGURATION != 0
    }
}

/// Resets the chip: every pin becomes an input.
pub fn software_reset() -> ! {
    cpu::disable_interrupts();
    loop {
        with_system_unlocked(|| {
            RSWRST.set(1);
            // The reading starts it.
            RSWRST.read()
        });
    }
}

/// Runs a function while OSCCON and RSWRST can be written. Interrupts are off, because the two keys must be written one
/// after the other.
pub(crate) fn with_system_unlocked<R>(function: impl FnOnce() -> R) -> R {
    const FIRST_KEY: u32 = 0xAA99_6655;
    const SECOND_KEY: u32 = 0x5566_99AA;
    const ANYTHING_ELSE: u32 = 0x3333_3333;
    cpu::without_interrupts(|| {
        SYSKEY.write(0);
        SYSKEY.write(FIRST_KEY);
        SYSKEY.write(SECOND_KEY);
        let result = function();
        SYSKEY.write(ANYTHING_ELSE);
        result
    })
}
