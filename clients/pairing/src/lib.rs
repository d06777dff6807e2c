//! Who is let in to a robot, by what proof, and what each may do. No I/O, no clock, no randomness of its own.
//!
//! Words used here. A *client* is a browser, a program or a person's phone that was let in once; its *token* is what it shows
//! from then on, and its *role* says what it may do. The *register* lists the clients. The *window* is the short time in which
//! a new one can be let in, opened by a person; its *code* has eight digits. *Guest* and *host* are the two ends of the
//! exchange that proves the code without showing it. *Matching* lets one in without a code: it shows a *pattern* of presses,
//! and a person presses it on the robot. The *door* is register, window and counters together.
//!
//! What changes must be on the disk before anybody is answered: the caller writes [`Door::stored`] after each change.
#![forbid(unsafe_code)]

mod code;
pub mod console;
mod door;
mod exchange;
mod hex;
mod matching;
mod name;
mod presence;
mod profile;
mod refusal;
mod register;
mod rhythm;
mod rights;
mod robot_id;
mod stored;
mod token;
mod window;
pub mod wire;

pub use code::{Code, CodeError};
pub use door::{AskingDevice, Door, Moment};
pub use exchange::{Ends, ExchangeError, Guest, Waiting};
pub use matching::{MATCHING_MAX, Pattern};
pub use name::{DeviceName, NameError};
pub use presence::Presence;
pub use refusal::Refusal;
pub use register::{CLIENTS_MAX, Paired, Register, Wanted};
pub use rights::{
    Asker, Denied, Method, Need, PRESENCE, ROUTES, Route, Ways, checked_request, need_of, ways_of,
};
pub use robot_id::{RobotId, sha256};
pub use rvac_api::{Role, UnknownRole};
pub use stored::StoredError;
pub use token::{Token, TokenId};
pub use window::{ATTEMPTS_MAX, OPEN_US, REOPENING_US};
