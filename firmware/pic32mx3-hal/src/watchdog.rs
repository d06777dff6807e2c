//! The watchdog: resets the chip unless it is fed (section 17).
//!
//! Its clock is the internal oscillator of about 31 kHz, so the period is a rough one: it is meant to be two to the power
//! chosen in the configuration words, in milliseconds. Nobody has measured it on this chip.

use crate::register::map::WDTCON;

const CLEAR: u32 = 1;
const ON: u32 = 1 << 15;

/// The watchdog.
#[derive(Debug)]
pub struct Watchdog(());

impl Watchdog {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Turns it on. Only a reset turns it off again, as far as this library goes.
    pub fn start(&mut self) {
        WDTCON.set(ON);
    }

    /// Restarts its period.
    #[inline(always)]
    pub fn feed(&mut self) {
        WDTCON.set(CLEAR);
    }

    /// Whether it runs: by [`Self::start`] or by the configuration words.
    #[must_use]
    pub fn is_running(&self) -> bool {
        WDTCON.has(ON)
    }

    /// Its period, nominally, in milliseconds, as the configuration words say.
    #[must_use]
    pub fn period_ms(&self) -> u32 {
        1 << ((WDTCON.read() >> 2) & 0x1F)
    }
}
