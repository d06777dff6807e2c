//! Inputs of control mixes that one client sends for another client to drive by.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// Longest lease of inputs in ms: the one of the driver's seat (S23), so that a chain of two clients stops no later than
/// one.
pub const INPUT_LEASE_MS_MAX: u16 = 400;
/// Most inputs of one client: two sticks and a dozen switches.
pub const INPUTS_PER_CLIENT_MAX: usize = 16;
/// Most inputs of all clients together.
pub const INPUTS_MAX: usize = 32;

/// Longest name in characters.
const NAME_LENGTH_MAX: usize = 32;

/// An input of a client.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClientInput {
    /// Its name, as in the input `client-NAME` of a mix.
    pub name: String,
    /// What it reads, -1..=1.
    pub value: f64,
    /// It is absent when so many ms have passed without news.
    pub left_ms: u16,
}

/// Whether a text can be a name in control mixes, of an input too: 1 to 32 letters, digits, blanks, `-` and `_`, with something
/// other than a blank at both ends.
#[must_use]
pub fn is_mix_name(text: &str) -> bool {
    let fits = |letter: char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    let length = text.chars().count();
    (1..=NAME_LENGTH_MAX).contains(&length) && text.trim() == text && text.chars().all(fits)
}
