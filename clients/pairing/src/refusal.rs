//! Why a device is not paired.

use crate::wire::Refused;

/// Why a device is not paired, or a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No window is open.
    #[error(
        "Nobody can be let in now: hold START on the robot for 5 s, or open a window with `rvac pair`, or on a device that is its administrator."
    )]
    WindowShut,
    /// Codes were guessed in earlier windows.
    #[error("Too many wrong codes were tried: a window can be opened again in {seconds} s.")]
    Waiting {
        /// How long.
        seconds: u64,
    },
    /// The window's attempts are used up.
    #[error("Too many wrong codes were tried: open a new window.")]
    NoAttemptsLeft,
    /// The code was another one.
    #[error("The code is wrong; {left} more attempts.")]
    WrongCode {
        /// Attempts left.
        left: u8,
    },
    /// The guest's message is none.
    #[error("The device sent a message that cannot be read: reload the page.")]
    Malformed,
    /// The attempt is not known any more.
    #[error("This attempt has ended: begin again.")]
    NoAttempt,
    /// A window is open, so that none is opened.
    #[error("A window is open already.")]
    OpenAlready,
    /// As many devices wait for their presses as can.
    #[error("Four devices wait for their presses already: try again in the next window.")]
    TooManyWait,
    /// The presses were not those of the device.
    #[error("Something else was pressed: hold START for 5 s and begin again.")]
    NotMatched,
    /// There is no room.
    #[error("The robot knows 64 devices, which is all it takes: shut one out first.")]
    Full,
    /// There is no such client.
    #[error("The robot knows no device with this number: list them again.")]
    NoClient,
}

impl Refusal {
    /// One word for programs.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Self::WindowShut => "window-shut",
            Self::Waiting { .. } => "waiting",
            Self::NoAttemptsLeft => "no-attempts-left",
            Self::WrongCode { .. } => "wrong-code",
            Self::Malformed => "malformed",
            Self::NoAttempt => "no-attempt",
            Self::OpenAlready => "open-already",
            Self::TooManyWait => "too-many-wait",
            Self::NotMatched => "not-matched",
            Self::Full => "full",
            Self::NoClient => "no-client",
        }
    }
}

impl From<Refusal> for Refused {
    fn from(refusal: Refusal) -> Self {
        Self {
            reason: refusal.reason().to_owned(),
            text: refusal.to_string(),
        }
    }
}
