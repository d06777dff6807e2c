//! Register, window and attempts together: everything about who comes in.

use crate::exchange::{Ends, Host};
use crate::stored::{Stored, StoredError};
use crate::window::{OPEN_US, Window};
use crate::wire::{Begin, Begun, Finish, Finished, Opened, Refused};
use crate::{Code, DeviceName, Register, RobotId, Role, Token, TokenId, Wanted};

/// Why somebody is not let in, or something not done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No window is open.
    #[error(
        "Nobody can be let in now: open a window on the robot with `rvac pair`, or on a device that is its administrator."
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

/// The two times of a moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// On the clock that never jumps.
    pub now_us: u64,
    /// On the wall, seconds since 1970, only to be shown.
    pub unix_s: u64,
}

/// An attempt whose proof is awaited.
#[derive(Debug)]
struct Attempt {
    id: [u8; 16],
    name: DeviceName,
    host: Host,
}

/// The door of one robot.
#[derive(Debug)]
pub struct Door {
    robot: RobotId,
    register: Register,
    window: Window,
    attempts: Vec<Attempt>,
}

impl Door {
    /// The door as it was kept, or of a robot that knows nobody yet. No window is open.
    ///
    /// # Errors
    /// See [`StoredError`].
    pub fn new(now_us: u64, robot: RobotId, stored: Option<&str>) -> Result<Self, StoredError> {
        let (counters, register) = match stored {
            Some(text) => {
                let stored = Stored::parse(text)?;
                (stored.counters, stored.clients)
            }
            None => Default::default(),
        };
        Ok(Self {
            robot,
            register,
            window: Window::new(now_us, counters),
            attempts: Vec::new(),
        })
    }

    /// What must be on the disk.
    #[must_use]
    pub fn stored(&self) -> String {
        Stored::new(self.window.counters, self.register.clone()).text()
    }

    /// The clients.
    #[must_use]
    pub const fn register(&self) -> &Register {
        &self.register
    }

    /// Whose door it is.
    #[must_use]
    pub const fn robot(&self) -> &RobotId {
        &self.robot
    }

    /// Whether somebody can be let in.
    #[must_use]
    pub fn is_open(&self, now_us: u64) -> bool {
        self.window.current(now_us).is_some()
    }

    /// Opens a window in which one client of this role can be let in.
    ///
    /// # Errors
    /// [`Refusal::Waiting`].
    pub fn open(&mut self, now_us: u64, role: Role, random: [u8; 8]) -> Result<Opened, Refusal> {
        let code = Code::from_random(random);
        let shown = code.shown();
        self.attempts.clear();
        self.window
            .open(now_us, code, role)
            .map_err(|left_us| Refusal::Waiting {
                seconds: left_us.div_ceil(1_000_000),
            })?;
        Ok(Opened {
            code: shown,
            seconds: u32::try_from(OPEN_US / 1_000_000).unwrap_or(u32::MAX),
        })
    }

    /// Takes a guest's first message. The attempt is counted: [`Self::stored`] must be on the disk before the answer goes out.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn begin(&mut self, now_us: u64, begin: Begin, random: &[u8; 80]) -> Result<Begun, Refusal> {
        if !self.is_open(now_us) {
            return Err(Refusal::WindowShut);
        }
        if self.register.is_full() {
            return Err(Refusal::Full);
        }
        let open = self.window.count_attempt(now_us).ok_or(Refusal::NoAttemptsLeft)?;
        let (attempt, scalar) = split(random);
        let ends = Ends {
            guest: &begin.name,
            robot: self.robot.full(),
        };
        let answer = Host::answer(&open.code, ends, scalar, &begin.message);
        let Ok((host, message)) = answer else {
            self.window.on_failure(now_us);
            return Err(Refusal::Malformed);
        };
        self.attempts.push(Attempt {
            id: attempt,
            name: begin.name,
            host,
        });
        Ok(Begun { attempt, message })
    }

    /// Takes a guest's proof; when it is right the guest is a client from now on. [`Self::stored`] must be on the disk before
    /// the answer goes out, whether it is a yes or a no.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn finish(
        &mut self,
        now: Moment,
        finish: &Finish,
        random: &[u8; 40],
    ) -> Result<(Finished, Token), Refusal> {
        let Moment { now_us, unix_s } = now;
        let Some(role) = self.window.current(now_us).map(|open| open.role) else {
            self.attempts.clear();
            return Err(Refusal::WindowShut);
        };
        let place = self
            .attempts
            .iter()
            .position(|attempt| attempt.id == finish.attempt);
        let attempt = self.attempts.swap_remove(place.ok_or(Refusal::NoAttempt)?);
        let Some(proof) = attempt.host.judge(&finish.proof) else {
            let left = self.window.attempts_left();
            if self.attempts.is_empty() {
                self.window.on_failure(now_us);
            }
            return Err(Refusal::WrongCode { left });
        };
        self.window.on_success();
        self.attempts.clear();
        let token = Token::from_random(random);
        let name = attempt.name;
        self.register.add(&token, Wanted { name, role }, unix_s);
        Ok((Finished { proof, role }, token))
    }

    /// Lets a program in, by the word of somebody at the console.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn add(&mut self, unix_s: u64, wanted: Wanted, random: &[u8; 40]) -> Result<Token, Refusal> {
        if self.register.is_full() {
            return Err(Refusal::Full);
        }
        let token = Token::from_random(random);
        self.register.add(&token, wanted, unix_s);
        Ok(token)
    }

    /// Shuts a client out.
    ///
    /// # Errors
    /// [`Refusal::NoClient`].
    pub fn revoke(&mut self, id: TokenId) -> Result<(), Refusal> {
        self.register.revoke(id).then_some(()).ok_or(Refusal::NoClient)
    }

    /// Gives a client another role.
    ///
    /// # Errors
    /// [`Refusal::NoClient`].
    pub fn set_role(&mut self, id: TokenId, role: Role) -> Result<(), Refusal> {
        self.register
            .set_role(id, role)
            .then_some(())
            .ok_or(Refusal::NoClient)
    }
}

fn split(random: &[u8; 80]) -> ([u8; 16], [u8; 64]) {
    let (mut attempt, mut scalar) = ([0; 16], [0; 64]);
    let (first, second) = random.split_at(16);
    attempt.copy_from_slice(first);
    scalar.copy_from_slice(second);
    (attempt, scalar)
}
