//! Reset cause, recent resets, and the watchdog.

use cordlib::board::{ResetRecord, Watchdog};
use pic32mx3_hal::persistent::Persistent;
use pic32mx3_hal::reset::Causes;
use pic32mx3_hal::watchdog;
use rvac_protocol::message::ResetCause;

use super::{converter, tick};
use crate::logic::life::SignsOfLife;
use crate::logic::reset_log::{FatalCause, ResetLog, WORDS};

#[cfg_attr(target_arch = "mips", unsafe(link_section = ".noinit"))]
static LOG: Persistent<WORDS> = Persistent::uninitialised();

/// The reset cause of the wire. Power-on sets the brown-out bit as well, and a watchdog reset during a brown-out counts
/// as a brown-out, so the order matters.
#[must_use]
pub fn cause_of(causes: Causes) -> ResetCause {
    if causes.power_on() {
        ResetCause::PowerOn
    } else if causes.brown_out() {
        ResetCause::BrownOut
    } else if causes.watchdog() {
        ResetCause::Watchdog
    } else if causes.software() {
        ResetCause::Software
    } else if causes.pin() {
        ResetCause::External
    } else {
        ResetCause::Unknown
    }
}

/// Notes what ended this run, for the report of the next one.
pub fn note(fatal_cause: FatalCause) {
    let log = LOG.load().map(ResetLog::from_words);
    let log = log.unwrap_or(ResetLog {
        boots: 0,
        recent: 0,
        fatal_cause,
    });
    LOG.store(ResetLog { fatal_cause, ..log }.words());
}

/// This start and the log of earlier ones.
#[derive(Debug)]
pub struct Starts {
    cause: ResetCause,
    log: ResetLog,
    fatal_cause: FatalCause,
}

impl Starts {
    /// Counts this start. Called once: it clears the chip's reset bits.
    #[must_use]
    pub fn take() -> Self {
        let cause = cause_of(Causes::take());
        let log = ResetLog::after_start(LOG.load().map(ResetLog::from_words), cause);
        let fatal_cause = log.fatal_cause;
        let log = ResetLog {
            fatal_cause: FatalCause::None,
            ..log
        };
        LOG.store(log.words());
        Self {
            cause,
            log,
            fatal_cause,
        }
    }

    /// What ended the previous run, if it was noted.
    #[must_use]
    pub const fn fatal_cause(&self) -> FatalCause {
        self.fatal_cause
    }
}

impl ResetRecord for Starts {
    fn cause(&mut self) -> ResetCause {
        self.cause
    }

    fn boot_count(&mut self) -> u32 {
        self.log.boots
    }

    fn recent(&mut self) -> u8 {
        u8::try_from(self.log.recent).unwrap_or(u8::MAX)
    }

    fn forget_recent(&mut self) {
        self.log.recent = 0;
        LOG.store(self.log.words());
    }
}

/// The watchdog of 128 ms. It is fed only from the main loop, if cordlib's stages have run and the two essential
/// interrupts still come.
#[derive(Debug)]
pub struct Supervised {
    watchdog: watchdog::Watchdog,
    life: SignsOfLife,
}

impl Supervised {
    /// Starts it, unless the configuration words did so already.
    #[must_use]
    pub fn take(mut watchdog: watchdog::Watchdog) -> Self {
        watchdog.start();
        watchdog.feed();
        Self {
            watchdog,
            life: SignsOfLife::default(),
        }
    }
}

impl Watchdog for Supervised {
    fn feed(&mut self) {
        if self.life.are_complete(tick::ticks(), converter::scans()) {
            self.watchdog.feed();
        }
    }
}
