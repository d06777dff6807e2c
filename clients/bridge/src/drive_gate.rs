//! Who may drive by hand from afar: only who began from rest.

use std::time::Duration;

use tokio::time::Instant;

/// After so long without a word driving begins anew.
pub const DRIVE_SILENCE: Duration = Duration::from_secs(1);

/// Lets only those drive who began from rest. A stream of commands that runs when a program starts, or goes on after a person has
/// stopped the robot, must not set it off.
#[derive(Clone, Copy, Debug)]
pub struct DriveGate {
    heard_at: Instant,
    is_open: bool,
}

impl DriveGate {
    /// Shut, until a silence or a zero.
    #[must_use]
    pub const fn shut_at(now: Instant) -> Self {
        Self {
            heard_at: now,
            is_open: false,
        }
    }

    /// Open, because it is known that nobody commanded before.
    #[must_use]
    pub const fn open_at(now: Instant) -> Self {
        Self {
            heard_at: now,
            is_open: true,
        }
    }

    /// A command has come.
    pub fn hear(&mut self, is_zero: bool, now: Instant) {
        self.is_open |= is_zero || now.duration_since(self.heard_at) >= DRIVE_SILENCE;
        self.heard_at = now;
    }

    /// Whether what was heard may be driven.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.is_open
    }

    /// What was asked for is refused.
    pub const fn shut(&mut self) {
        self.is_open = false;
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use tokio::time::Instant;

    use super::{DRIVE_SILENCE, DriveGate};

    #[test]
    fn only_who_begins_from_rest_drives() {
        let start = Instant::now();
        let mut gate = DriveGate::shut_at(start);
        let mut now = start;
        for _ in 0..100 {
            now += Duration::from_millis(50);
            gate.hear(false, now);
            assert!(!gate.is_open(), "a stream that was there before");
        }
        now += DRIVE_SILENCE;
        gate.hear(false, now);
        assert!(gate.is_open(), "after a silence");
        gate.shut();
        now += Duration::from_millis(50);
        gate.hear(false, now);
        assert!(!gate.is_open(), "the same stream, after a refusal");
        gate.hear(true, now);
        gate.hear(false, now);
        assert!(gate.is_open(), "after a zero");
    }
}
