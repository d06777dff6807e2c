//! Clocks: what runs how fast, and what happens when the crystal fails (section 6).

use crate::register::map::OSCCON;
use crate::reset::with_system_unlocked;

/// The two frequencies that everything else follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clocks {
    /// The processor's, SYSCLK. The core timer counts at half of it.
    pub system_hz: u32,
    /// The peripherals', PBCLK.
    pub peripheral_hz: u32,
}

impl Clocks {
    /// Counts of the core timer a second.
    #[must_use]
    pub const fn core_timer_hz(self) -> u32 {
        self.system_hz / 2
    }
}

/// The source that the chip runs on now (OSCCON.COSC).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Running {
    /// The internal oscillator, in one of its forms; after a failure of the clock, about 8 MHz.
    Internal,
    /// The internal oscillator through the PLL.
    InternalPll,
    /// The crystal.
    Primary,
    /// The crystal through the PLL.
    PrimaryPll,
    /// The 32 kHz crystal.
    Secondary,
    /// The oscillator of about 31 kHz.
    LowPower,
}

/// What the chip runs on now.
#[must_use]
pub fn running() -> Running {
    match (OSCCON.read() >> 12) & 0b111 {
        1 => Running::InternalPll,
        2 => Running::Primary,
        3 => Running::PrimaryPll,
        4 => Running::Secondary,
        5 => Running::LowPower,
        _ => Running::Internal,
    }
}

const CLOCK_FAILED: u32 = 1 << 3;
const PLL_LOCKED: u32 = 1 << 5;

/// Whether the clock failed and the chip went over to its internal oscillator: everything runs at a tenth of its speed
/// then. The monitor must be on ([`crate::configuration::Configuration::clock_monitor`]); it also asks for the interrupt
/// [`crate::interrupt::Source::ClockMonitor`].
#[must_use]
pub fn has_failed() -> bool {
    OSCCON.has(CLOCK_FAILED)
}

/// Whether the PLL is in step.
#[must_use]
pub fn pll_is_locked() -> bool {
    OSCCON.has(PLL_LOCKED)
}

/// Forgets a failure. The chip stays on its internal oscillator; a reset starts with the crystal again. While DMA moves something,
/// call it within [`crate::dma::suspended`].
pub fn forget_failure() {
    with_system_unlocked(|| OSCCON.clear(CLOCK_FAILED));
}
