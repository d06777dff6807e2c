//! The log of resets, in memory that the start-up code does not clear.

use rvac_protocol::message::ResetCause;

/// Words in memory.
pub const WORDS: usize = 3;

/// Why the firmware ended a run, noted before the reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FatalCause {
    /// Nothing was noted.
    #[default]
    None,
    /// A panic.
    Panic,
    /// An exception of the processor (bad address, bad instruction).
    Exception,
    /// An interrupt without handler.
    StrayInterrupt,
    /// A faulty memory cell.
    Memory,
    /// The image in flash differs from its checksum.
    Flash,
    /// The stack grew into the words that guard its end.
    Stack,
    /// A critical variable and its complement disagree.
    Variable,
    /// The crystal failed; the chip ran on its own oscillator.
    Clock,
    /// A register of the chip that controls motors or charger has changed.
    Register,
}

impl FatalCause {
    const ALL: [Self; 10] = [
        Self::None,
        Self::Panic,
        Self::Exception,
        Self::StrayInterrupt,
        Self::Memory,
        Self::Flash,
        Self::Stack,
        Self::Variable,
        Self::Clock,
        Self::Register,
    ];

    /// The number in memory.
    #[must_use]
    pub const fn number(self) -> u32 {
        self as u32
    }

    fn from_number(number: u32) -> Self {
        Self::ALL
            .into_iter()
            .find(|fatal_cause| fatal_cause.number() == number)
            .unwrap_or_default()
    }

    /// For the log that goes to the host; empty for none.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Panic => "last run ended by a panic",
            Self::Exception => "last run ended by an exception",
            Self::StrayInterrupt => "last run ended by a stray interrupt",
            Self::Memory => "last run ended by a memory fault",
            Self::Flash => "last run ended by a damaged image",
            Self::Stack => "last run ended by a stack overflow",
            Self::Variable => "last run ended by a damaged variable",
            Self::Clock => "last run ended by a clock failure",
            Self::Register => "last run ended by a changed register",
        }
    }
}

/// The record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResetLog {
    /// Starts since the memory last lost power.
    pub boots: u32,
    /// Resets in a row other than power-on, since [`Self::recent`] was set to 0.
    pub recent: u32,
    /// Why the previous run ended.
    pub fatal_cause: FatalCause,
}

impl ResetLog {
    /// Reads the record.
    #[must_use]
    pub fn from_words([boots, recent, fatal_cause]: [u32; WORDS]) -> Self {
        Self {
            boots,
            recent,
            fatal_cause: FatalCause::from_number(fatal_cause),
        }
    }

    /// The record as it is stored.
    #[must_use]
    pub const fn words(self) -> [u32; WORDS] {
        [self.boots, self.recent, self.fatal_cause.number()]
    }

    /// The record after a start with this cause. `before` is what memory held.
    #[must_use]
    pub fn after_start(before: Option<Self>, cause: ResetCause) -> Self {
        let before = before.unwrap_or(Self {
            boots: 0,
            recent: 0,
            fatal_cause: FatalCause::None,
        });
        let is_power_on = cause == ResetCause::PowerOn;
        Self {
            boots: before.boots.saturating_add(1),
            recent: if is_power_on {
                0
            } else {
                before.recent.saturating_add(1)
            },
            fatal_cause: if is_power_on {
                FatalCause::None
            } else {
                before.fatal_cause
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FatalCause, ResetLog};
    use rvac_protocol::message::ResetCause;

    #[test]
    fn resets_in_a_row_are_counted_and_power_on_begins_anew() {
        let mut log = None;
        for (cause, boots, recent) in [
            (ResetCause::PowerOn, 1, 0),
            (ResetCause::Watchdog, 2, 1),
            (ResetCause::Software, 3, 2),
            (ResetCause::External, 4, 3),
            (ResetCause::PowerOn, 5, 0),
        ] {
            let started = ResetLog::after_start(log, cause);
            assert_eq!((started.boots, started.recent), (boots, recent));
            log = Some(ResetLog::from_words(started.words()));
        }
    }

    #[test]
    fn memory_that_lost_its_content_begins_anew() {
        let started = ResetLog::after_start(None, ResetCause::BrownOut);
        assert_eq!((started.boots, started.recent), (1, 1));
        assert_eq!(ResetLog::from_words([1, 2, 99]).fatal_cause, FatalCause::None);
    }

    #[test]
    fn the_cause_is_reported_after_the_reset_and_lost_with_the_power() {
        let died = ResetLog {
            boots: 1,
            recent: 0,
            fatal_cause: FatalCause::Stack,
        };
        let log = Some(ResetLog::from_words(died.words()));
        assert_eq!(log, Some(died));
        assert_eq!(
            ResetLog::after_start(log, ResetCause::Software).fatal_cause,
            FatalCause::Stack
        );
        assert_eq!(
            ResetLog::after_start(log, ResetCause::PowerOn).fatal_cause,
            FatalCause::None
        );
    }
}
