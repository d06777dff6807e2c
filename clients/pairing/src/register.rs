//! The clients that were let in.

use serde::{Deserialize, Serialize};

use crate::token::TokenDigest;
use crate::{DeviceName, Role, Token, TokenId};

/// Clients at one time; a home with more has lost count of them.
pub const CLIENTS_MAX: usize = 64;

/// A client that was let in.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Paired {
    /// Its number.
    pub id: TokenId,
    /// What its owner calls it.
    pub name: DeviceName,
    /// What it may do.
    pub role: Role,
    /// When it was let in, seconds since 1970, as far as the robot knew the time.
    pub since_s: u64,
    digest: TokenDigest,
}

/// What a new client shall be.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// How it is called.
    pub name: DeviceName,
    /// What it may do.
    pub role: Role,
}

/// All of them, oldest first.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Register {
    clients: Vec<Paired>,
}

impl Register {
    /// The client whose token this is.
    #[must_use]
    pub fn admit(&self, token: &Token) -> Option<&Paired> {
        let client = self.get(token.id())?;
        client.digest.matches(&token.digest()).then_some(client)
    }

    /// A client by its number.
    #[must_use]
    pub fn get(&self, id: TokenId) -> Option<&Paired> {
        self.clients.iter().find(|client| client.id == id)
    }

    /// All, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = &Paired> {
        self.clients.iter()
    }

    pub(crate) fn is_full(&self) -> bool {
        self.clients.len() >= CLIENTS_MAX
    }

    pub(crate) fn add(&mut self, token: &Token, wanted: Wanted, since_s: u64) {
        self.clients.push(Paired {
            id: token.id(),
            name: wanted.name,
            role: wanted.role,
            since_s,
            digest: token.digest(),
        });
    }

    /// Whether there was one.
    pub(crate) fn revoke(&mut self, id: TokenId) -> bool {
        let before = self.clients.len();
        self.clients.retain(|client| client.id != id);
        self.clients.len() < before
    }

    /// Whether there is one.
    pub(crate) fn set_role(&mut self, id: TokenId, role: Role) -> bool {
        let client = self.clients.iter_mut().find(|client| client.id == id);
        client.map(|client| client.role = role).is_some()
    }

    /// Whether a file may say so.
    pub(crate) fn is_sound(&self) -> bool {
        let doubled = |(place, client): (usize, &Paired)| {
            self.clients
                .iter()
                .skip(place + 1)
                .any(|other| other.id == client.id)
        };
        self.clients.len() <= CLIENTS_MAX && !self.clients.iter().enumerate().any(doubled)
    }
}
