//! The short time in which a new client can be let in, and how often a code may be tried.
//!
//! Attempts are counted before they are answered and given back only by success, so that neither going away nor ending the
//! server buys a guess. A window whose attempts are used up closes, and each such window makes the next one wait longer.

use serde::{Deserialize, Serialize};

use crate::{Code, Role};

/// How long a window stays open.
pub const OPEN_US: u64 = 120_000_000;

/// Attempts in one window.
pub const ATTEMPTS_MAX: u8 = 5;

/// How long a window stays shut after the first, second, ... one whose attempts were used up; then always the last.
pub const REOPENING_US: [u64; 5] = [0, 0, 60_000_000, 300_000_000, 3_600_000_000];

/// What survives the end of the server.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Counters {
    /// Attempts in the present window, or in the one that the end of the server closed.
    pub(crate) attempts: u8,
    /// Windows since the last success whose attempts were used up.
    pub(crate) used_up: u8,
}

/// An open window.
#[derive(Clone, Debug)]
pub(crate) struct Open {
    pub(crate) until_us: u64,
    pub(crate) code: Code,
    pub(crate) role: Role,
}

/// The window, open or shut.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub(crate) counters: Counters,
    open: Option<Open>,
    shut_until_us: u64,
}

impl Window {
    /// Shut, at the start of the server. Nobody knows how long it was off, so a pause that was due begins anew.
    pub(crate) fn new(now_us: u64, counters: Counters) -> Self {
        let mut window = Self {
            counters,
            open: None,
            shut_until_us: now_us,
        };
        if counters.used_up > 0 {
            window.shut_until_us = now_us + window.pause_us();
        }
        window
    }

    /// Opens it for 120 s, also when it is open already. Attempts of a window that a crash ended go on counting.
    ///
    /// # Errors
    /// How long it stays shut, in microseconds.
    pub(crate) fn open(&mut self, now_us: u64, code: Code, role: Role) -> Result<(), u64> {
        if now_us < self.shut_until_us {
            return Err(self.shut_until_us - now_us);
        }
        let ended_by_time = self.current(now_us).is_none() && self.open.take().is_some();
        if ended_by_time && self.attempts_left() > 0 {
            self.counters.attempts = 0;
        }
        if self.attempts_left() == 0 {
            self.use_up(now_us);
            return self.open(now_us, code, role);
        }
        self.open = Some(Open {
            until_us: now_us + OPEN_US,
            code,
            role,
        });
        Ok(())
    }

    /// The open window.
    pub(crate) fn current(&self, now_us: u64) -> Option<&Open> {
        self.open.as_ref().filter(|open| now_us < open.until_us)
    }

    pub(crate) fn attempts_left(&self) -> u8 {
        ATTEMPTS_MAX.saturating_sub(self.counters.attempts)
    }

    /// Counts an attempt, if one is left.
    pub(crate) fn count_attempt(&mut self, now_us: u64) -> Option<Open> {
        let open = self.current(now_us)?.clone();
        if self.attempts_left() == 0 {
            return None;
        }
        self.counters.attempts += 1;
        Some(open)
    }

    /// An attempt failed: the last one shuts the window.
    pub(crate) fn on_failure(&mut self, now_us: u64) {
        if self.attempts_left() == 0 {
            self.use_up(now_us);
        }
    }

    /// Somebody was let in: one is all that a window lets in.
    pub(crate) fn on_success(&mut self) {
        self.open = None;
        self.counters = Counters::default();
    }

    fn use_up(&mut self, now_us: u64) {
        self.open = None;
        self.counters.attempts = 0;
        self.counters.used_up = self.counters.used_up.saturating_add(1);
        self.shut_until_us = now_us + self.pause_us();
    }

    fn pause_us(&self) -> u64 {
        let place = usize::from(self.counters.used_up).saturating_sub(1);
        REOPENING_US
            .get(place)
            .or(REOPENING_US.last())
            .copied()
            .unwrap_or_default()
    }
}
