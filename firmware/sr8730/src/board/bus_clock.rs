//! A second clock beside the core timer, from the peripheral bus: the free-running Timer5. If the link samples its
//! input with that timer, the number of samples serves as the clock.

#[cfg(not(feature = "link-sampled"))]
use pic32mx3_hal::timer::{Prescaler, Timer};

/// The clock.
#[cfg(not(feature = "link-sampled"))]
#[derive(Debug)]
pub struct BusClock(Timer<5>);

#[cfg(not(feature = "link-sampled"))]
impl BusClock {
    /// Half counts of the core timer in one of this clock: its prescaler is 256.
    pub const HALVES_PER_COUNT: u32 = crate::logic::clock_check::HALVES_PER_COUNT;

    /// Running.
    #[must_use]
    pub fn take(mut timer: Timer<5>) -> Self {
        timer.start(Prescaler::By256, 0x1_0000);
        Self(timer)
    }

    /// The count, modulo 2^16.
    #[must_use]
    pub fn count(&self) -> u16 {
        self.0.count()
    }
}

/// The clock.
#[cfg(feature = "link-sampled")]
#[derive(Debug)]
pub struct BusClock;

#[cfg(feature = "link-sampled")]
impl BusClock {
    /// Half counts of the core timer in one of this clock.
    pub const HALVES_PER_COUNT: u32 = super::link::uart::by_samples::CORE_HALVES_PER_SAMPLE;

    /// The count, modulo 2^16.
    #[must_use]
    pub fn count(&self) -> u16 {
        super::link::uart::by_samples::samples()
    }
}
