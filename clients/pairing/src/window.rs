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
    /// Windows since the last success that the button opened.
    #[serde(default)]
    pub(crate) by_button: u8,
}

/// An open window.
#[derive(Clone, Debug)]
pub(crate) struct Open {
    pub(crate) until_us: u64,
    pub(crate) proof: Proof,
    pub(crate) role: Role,
}

/// What lets a client in.
#[derive(Clone, Debug)]
pub(crate) enum Proof {
    /// The digits that its person was shown.
    Code(Code),
    /// The presses that it shows to its person.
    Presses,
}

/// The window, open or shut.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub(crate) counters: Counters,
    open: Option<Open>,
    shut_until_us: u64,
    /// The same for the button, which may be stuck or be played with: it must not keep the console out.
    button_shut_until_us: u64,
}

impl Window {
    /// Shut, at the start of the server. The time that it was off is unknown, so a pause that was due starts again.
    pub(crate) fn new(now_us: u64, counters: Counters) -> Self {
        let mut window = Self {
            counters,
            open: None,
            shut_until_us: now_us,
            button_shut_until_us: now_us,
        };
        window.shut_until_us += pause_us(counters.used_up);
        window.button_shut_until_us += pause_us(counters.by_button);
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
        self.forget_ended(now_us);
        if self.attempts_left() == 0 {
            self.use_up(now_us);
            return self.open(now_us, code, role);
        }
        self.open = Some(Open {
            until_us: now_us + OPEN_US,
            proof: Proof::Code(code),
            role,
        });
        Ok(())
    }

    /// Opens it for presses of the button, by the button, while it is shut.
    ///
    /// # Errors
    /// How long it stays shut for the button, in microseconds.
    pub(crate) fn open_by_button(&mut self, now_us: u64, role: Role) -> Result<(), u64> {
        let shut_until_us = self.shut_until_us.max(self.button_shut_until_us);
        if now_us < shut_until_us {
            return Err(shut_until_us - now_us);
        }
        self.forget_ended(now_us);
        let until_us = now_us + OPEN_US;
        self.counters.by_button = self.counters.by_button.saturating_add(1);
        self.button_shut_until_us = until_us + pause_us(self.counters.by_button);
        self.open = Some(Open {
            until_us,
            proof: Proof::Presses,
            role,
        });
        Ok(())
    }

    /// A window for codes that ended by its time takes its attempts with it.
    fn forget_ended(&mut self, now_us: u64) {
        if self.current(now_us).is_some() {
            return;
        }
        let ended = self.open.take();
        let was_for_codes = ended.is_some_and(|open| matches!(open.proof, Proof::Code(_)));
        if was_for_codes && self.attempts_left() > 0 {
            self.counters.attempts = 0;
        }
    }

    /// The presses were wrong.
    pub(crate) fn on_wrong_presses(&mut self, now_us: u64) {
        self.open = None;
        self.button_shut_until_us = now_us + pause_us(self.counters.by_button);
    }

    /// The open window.
    pub(crate) fn current(&self, now_us: u64) -> Option<&Open> {
        self.open.as_ref().filter(|open| now_us < open.until_us)
    }

    pub(crate) fn attempts_left(&self) -> u8 {
        ATTEMPTS_MAX.saturating_sub(self.counters.attempts)
    }

    /// The code of the open window, if it is one for codes.
    pub(crate) fn code(&self, now_us: u64) -> Option<&Code> {
        match &self.current(now_us)?.proof {
            Proof::Code(code) => Some(code),
            Proof::Presses => None,
        }
    }

    /// The role of the open window, if it is one for presses.
    pub(crate) fn role_by_presses(&self, now_us: u64) -> Option<Role> {
        let open = self.current(now_us)?;
        matches!(open.proof, Proof::Presses).then_some(open.role)
    }

    /// Counts an attempt, if one is left.
    pub(crate) fn count_attempt(&mut self, now_us: u64) -> Option<Code> {
        let code = self.code(now_us)?.clone();
        if self.attempts_left() == 0 {
            return None;
        }
        self.counters.attempts += 1;
        Some(code)
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
        self.button_shut_until_us = 0;
    }

    fn use_up(&mut self, now_us: u64) {
        self.open = None;
        self.counters.attempts = 0;
        self.counters.used_up = self.counters.used_up.saturating_add(1);
        self.shut_until_us = now_us + pause_us(self.counters.used_up);
    }
}

/// How long it stays shut after so many failed windows.
fn pause_us(in_vain: u8) -> u64 {
    let Some(place) = usize::from(in_vain).checked_sub(1) else {
        return 0;
    };
    REOPENING_US
        .get(place)
        .or(REOPENING_US.last())
        .copied()
        .unwrap_or_default()
}
