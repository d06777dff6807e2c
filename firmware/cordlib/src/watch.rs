//! S5: the watchdog is fed only when every supervised stage has checked in since the last feed. A stopped clock, a skipped
//! stage or a hanging loop lets it reset the chip.

use rvac_units::Tick;

/// Stages that must have run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Supervisor {
    /// The clock has moved on.
    Tick = 1,
    /// Reflexes and outputs were carried out.
    Loop = 2,
    /// Received bytes were taken in and the transmitter was served.
    Comms = 4,
}

const ALL: u8 = Supervisor::Tick as u8 | Supervisor::Loop as u8 | Supervisor::Comms as u8;

/// Who has checked in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch {
    present: u8,
    last: Tick,
}

impl Watch {
    /// Nobody yet.
    pub(crate) const fn starting_at(now: Tick) -> Self {
        Self {
            present: 0,
            last: now,
        }
    }

    /// A stage has run.
    pub(crate) const fn check_in(&mut self, supervisor: Supervisor) {
        self.present |= supervisor as u8;
    }

    /// Whether all have checked in; if so, they must all check in again.
    pub(crate) fn is_complete(&mut self, now: Tick) -> bool {
        if now != self.last {
            self.last = now;
            self.check_in(Supervisor::Tick);
        }
        let complete = self.present == ALL;
        if complete {
            self.present = 0;
        }
        complete
    }
}

#[cfg(test)]
mod tests {
    use super::{Supervisor, Watch};
    use rvac_units::Tick;

    #[test]
    fn one_missing_supervisor_starves_the_watchdog() {
        let mut watch = Watch::starting_at(Tick(0));
        watch.check_in(Supervisor::Loop);
        assert!(!watch.is_complete(Tick(1)));
        watch.check_in(Supervisor::Comms);
        assert!(watch.is_complete(Tick(1)));
        watch.check_in(Supervisor::Loop);
        watch.check_in(Supervisor::Comms);
        assert!(!watch.is_complete(Tick(1)), "the clock stands still");
        assert!(watch.is_complete(Tick(2)));
    }
}
