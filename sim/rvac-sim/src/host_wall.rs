//! The wall clock of a simulated host: it follows the virtual clock.

/// Microseconds of a second, the pause between two readings of it.
const LOOK_US: u64 = 1_000_000;

/// A clock on the wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HostWall {
    set_us: u64,
    shown_s: i64,
    looked_us: Option<u64>,
}

impl HostWall {
    /// One that shows `utc_s` at `now_us`.
    pub(crate) const fn showing(now_us: u64, utc_s: i64) -> Self {
        Self {
            set_us: now_us,
            shown_s: utc_s,
            looked_us: None,
        }
    }

    /// What it shows, once a second.
    pub(crate) fn look(&mut self, now_us: u64) -> Option<i64> {
        let due = self.looked_us.is_none_or(|then_us| now_us >= then_us + LOOK_US);
        due.then(|| {
            self.looked_us = Some(now_us);
            self.shown_s + ((now_us - self.set_us) / LOOK_US).cast_signed()
        })
    }
}
