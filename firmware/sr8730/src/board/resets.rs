//! Why the chip started, how often of late, and the watchdog.

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

/// The cause in the words of the wire. With power the brown-out bit is set, too, and a watchdog that bites during a brown-out is
/// a brown-out; so the order matters.
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

/// Notes what ended this run, for the next one to tell.
pub fn note(fatal_cause: FatalCause) {
    let log = LOG.load().map(ResetLog::from_words);
    let log = log.unwrap_or(ResetLog {
        boots: 0,
        recent: 0,
        fatal_cause,
    });
    LOG.store(ResetLog { fatal_cause, ..log }.words());
}

/// This start, and those before it.
#[derive(Debug)]
pub struct Starts {
    cause: ResetCause,
    log: ResetLog,
    fatal_cause: FatalCause,
}

impl Starts {
    /// Counts this start. Once in a run: the chip's bits are cleared by it.
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

    /// What ended the run before this one, if it could note it.
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

/// The watchdog of 128 ms. It is fed from the main loop only, when cordlib's stages have run and both interrupts that the
/// rest hangs on still come.
#[derive(Debug)]
pub struct Supervised {
    watchdog: watchdog::Watchdog,
    life: SignsOfLife,
}

impl Supervised {
    /// Running from here on, if the configuration words did not start it already.
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
