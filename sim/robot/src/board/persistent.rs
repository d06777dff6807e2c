//! Memory that a reset does not clear.

use cordlib::board::{KeptMemory, KeptWords, ResetRecord};
use rvac_protocol::message::ResetCause;

/// Memory that survives a reset, and the chip's reset cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersistentMemory {
    cause: ResetCause,
    boots: u32,
    recent: u8,
}

impl PersistentMemory {
    /// After the power came on for the first time.
    #[must_use]
    pub const fn first() -> Self {
        Self {
            cause: ResetCause::PowerOn,
            boots: 1,
            recent: 0,
        }
    }

    /// After another start with this cause: what the board's start-up code does before it calls the firmware.
    #[must_use]
    pub const fn restarted(self, cause: ResetCause) -> Self {
        let recent = match cause {
            ResetCause::PowerOn => 0,
            _ => self.recent.saturating_add(1),
        };
        Self {
            cause,
            boots: self.boots.saturating_add(1),
            recent,
        }
    }
}

impl ResetRecord for PersistentMemory {
    fn cause(&mut self) -> ResetCause {
        self.cause
    }

    fn boot_count(&mut self) -> u32 {
        self.boots
    }

    fn recent(&mut self) -> u8 {
        self.recent
    }

    fn forget_recent(&mut self) {
        self.recent = 0;
    }
}

/// Memory that keeps latches and clocks over a reset, until the power goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptRam {
    words: Option<KeptWords>,
}

impl KeptRam {
    /// After another start with this cause.
    #[must_use]
    pub const fn restarted(self, cause: ResetCause) -> Self {
        match cause {
            ResetCause::PowerOn => Self { words: None },
            _ => self,
        }
    }
}

impl KeptMemory for KeptRam {
    const PRESENT: bool = true;

    fn load(&mut self) -> Option<KeptWords> {
        self.words
    }

    fn store(&mut self, words: &KeptWords) {
        self.words = Some(*words);
    }
}

#[cfg(test)]
mod tests {
    use super::{KeptRam, PersistentMemory};
    use cordlib::board::{KEPT_WORDS, KeptMemory, ResetRecord};
    use rvac_protocol::message::ResetCause;

    #[test]
    fn resets_count_up_until_they_are_forgotten() {
        let mut record = PersistentMemory::first()
            .restarted(ResetCause::Watchdog)
            .restarted(ResetCause::BrownOut);
        assert_eq!(
            (record.boot_count(), record.recent(), record.cause()),
            (3, 2, ResetCause::BrownOut)
        );
        record.forget_recent();
        let mut record = record.restarted(ResetCause::PowerOn);
        assert_eq!((record.boot_count(), record.recent()), (4, 0));
    }

    #[test]
    fn what_is_kept_goes_with_the_power_only() {
        let mut kept = KeptRam::default();
        assert_eq!(kept.load(), None);
        kept.store(&[3; KEPT_WORDS]);
        let mut kept = kept.restarted(ResetCause::Watchdog);
        assert_eq!(kept.load(), Some([3; KEPT_WORDS]));
        assert_eq!(kept.restarted(ResetCause::PowerOn).load(), None);
    }
}
