//! Register, window and attempts together: everything about who comes in.

use crate::exchange::{Ends, Host};
use crate::matching::{Matching, Standing};
use crate::stored::{Stored, StoredError};
use crate::window::{OPEN_US, Window};
use crate::wire::{Begin, Begun, Finish, Finished, Forgotten, Joined, Opened};
use crate::{Code, DeviceName, Refusal, Register, RobotId, Role, Token, TokenId, Wanted};

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

/// A device that asks for presses.
#[derive(Clone, Debug)]
pub struct AskingDevice<'a> {
    /// What it wants to be called.
    pub name: DeviceName,
    /// Its address.
    pub from: &'a str,
}

/// The door of one robot.
#[derive(Debug)]
pub struct Door {
    robot: RobotId,
    register: Register,
    /// Why all clients were forgotten, until an administrator is let in.
    forgotten: Option<Forgotten>,
    window: Window,
    attempts: Vec<Attempt>,
    matching: Matching,
}

/// What a device that presses let in may do.
const ROLE_BY_PRESSES: Role = Role::Drive;

impl Door {
    /// The stored door, or that of a robot without paired devices. No window is open.
    ///
    /// # Errors
    /// See [`StoredError`].
    pub fn new(now_us: u64, robot: RobotId, stored: Option<&str>) -> Result<Self, StoredError> {
        let (counters, register, forgotten) = match stored {
            Some(text) => {
                let stored = Stored::parse(text)?;
                (stored.counters, stored.clients, stored.forgotten)
            }
            None => Default::default(),
        };
        Ok(Self {
            robot,
            register,
            forgotten,
            window: Window::new(now_us, counters),
            attempts: Vec::new(),
            matching: Matching::default(),
        })
    }

    /// What must be on the disk.
    #[must_use]
    pub fn stored(&self) -> String {
        Stored::new(self.window.counters, self.register.clone(), self.forgotten).text()
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

    /// Why all clients were forgotten, until an administrator is let in.
    #[must_use]
    pub const fn forgotten(&self) -> Option<Forgotten> {
        self.forgotten
    }

    /// Forgets all clients and all counters, and shuts the window. The robot stays who it is.
    pub fn forget_all(&mut self, now_us: u64, why: Forgotten) {
        self.register = Register::default();
        self.window = Window::new(now_us, Default::default());
        self.attempts.clear();
        self.matching = Matching::default();
        self.forgotten = Some(why);
    }

    /// The robot has a new identity from now on; proofs for the previous one are not valid.
    pub fn rename(&mut self, robot: RobotId) {
        self.robot = robot;
        self.attempts.clear();
    }

    /// Whether pairing is possible now.
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
        self.window.open(now_us, code, role).map_err(waiting)?;
        self.matching = Matching::default();
        let seconds = OPEN_S;
        Ok(Opened { code: shown, seconds })
    }

    /// Opens a window because a person holds the button: a device that shows the presses it asks for can be let in. The window is counted:
    /// [`Self::stored`] must be on the disk before anybody is informed.
    ///
    /// # Errors
    /// [`Refusal::OpenAlready`], [`Refusal::Waiting`].
    pub fn open_by_button(&mut self, now_us: u64, random: [u8; 8]) -> Result<(), Refusal> {
        if self.is_open(now_us) {
            return Err(Refusal::OpenAlready);
        }
        self.window
            .open_by_button(now_us, ROLE_BY_PRESSES)
            .map_err(waiting)?;
        self.attempts.clear();
        self.matching = Matching::new(random);
        Ok(())
    }

    /// Whether the open window is one for presses.
    #[must_use]
    pub fn is_open_for_presses(&self, now_us: u64) -> bool {
        self.window.role_by_presses(now_us).is_some()
    }

    /// A device asks for presses.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn join(
        &mut self,
        now_us: u64,
        asking: AskingDevice<'_>,
        random: [u8; 16],
    ) -> Result<Joined, Refusal> {
        if !self.is_open_for_presses(now_us) {
            return Err(Refusal::WindowShut);
        }
        if self.register.is_full() {
            return Err(Refusal::Full);
        }
        let presses = self
            .matching
            .join(random, asking.name, asking.from)
            .ok_or(Refusal::TooManyWait)?;
        Ok(Joined {
            session: random,
            presses,
        })
    }

    /// Whether presses are waited for now: then they are for nothing else.
    #[must_use]
    pub fn waits_for_presses(&self, now_us: u64) -> bool {
        self.is_open_for_presses(now_us) && self.matching.is_waited()
    }

    /// The button was pressed.
    pub fn press(&mut self, now_us: u64) {
        if self.is_open_for_presses(now_us) {
            self.matching.press(now_us);
        }
    }

    /// Lets time pass. A complete pattern that matches no waiting device closes the window.
    pub fn judge_presses(&mut self, now_us: u64) {
        if self.is_open_for_presses(now_us) && self.matching.judge(now_us) == Some(false) {
            self.window.on_wrong_presses(now_us);
        }
    }

    /// A device asks what became of it; when its presses came, it is a client from now on. [`Self::stored`] must be on the disk before
    /// the answer goes out.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn ask_matched(
        &mut self,
        now: Moment,
        session: &[u8; 16],
        random: &[u8; 40],
    ) -> Result<Option<(Role, Token)>, Refusal> {
        let role = self.window.role_by_presses(now.now_us);
        match (self.matching.standing(session), role) {
            (None, _) => Err(Refusal::NoAttempt),
            (Some(Standing::Missed), _) => Err(Refusal::NotMatched),
            (Some(_), None) => Err(Refusal::WindowShut),
            (Some(Standing::Waits), Some(_)) => Ok(None),
            (Some(Standing::Chosen), Some(role)) => {
                let name = self.matching.take(session).ok_or(Refusal::NoAttempt)?;
                let token = self.add(now.unix_s, Wanted { name, role }, random)?;
                self.window.on_success();
                Ok(Some((role, token)))
            }
        }
    }

    /// Takes a guest's first message. The attempt is counted: [`Self::stored`] must be on the disk before the answer goes out.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn begin(&mut self, now_us: u64, begin: Begin, random: &[u8; 80]) -> Result<Begun, Refusal> {
        if self.window.code(now_us).is_none() {
            return Err(Refusal::WindowShut);
        }
        if self.register.is_full() {
            return Err(Refusal::Full);
        }
        let code = self.window.count_attempt(now_us).ok_or(Refusal::NoAttemptsLeft)?;
        let (attempt, scalar) = split(random);
        let ends = Ends {
            guest: &begin.name,
            robot: self.robot.full(),
        };
        let answer = Host::answer(&code, ends, scalar, &begin.message);
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
        let name = attempt.name;
        let token = self.add(unix_s, Wanted { name, role }, random)?;
        Ok((Finished { proof, role }, token))
    }

    /// Pairs a program on behalf of a person at the console.
    ///
    /// # Errors
    /// [`Refusal::Full`].
    pub fn add(&mut self, unix_s: u64, wanted: Wanted, random: &[u8; 40]) -> Result<Token, Refusal> {
        if self.register.is_full() {
            return Err(Refusal::Full);
        }
        if wanted.role == Role::Admin {
            self.forgotten = None;
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

const OPEN_S: u32 = (OPEN_US / 1_000_000) as u32;

fn waiting(left_us: u64) -> Refusal {
    Refusal::Waiting {
        seconds: left_us.div_ceil(1_000_000),
    }
}

fn split(random: &[u8; 80]) -> ([u8; 16], [u8; 64]) {
    let (mut attempt, mut scalar) = ([0; 16], [0; 64]);
    let (first, second) = random.split_at(16);
    attempt.copy_from_slice(first);
    scalar.copy_from_slice(second);
    (attempt, scalar)
}
