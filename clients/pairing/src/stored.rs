//! The door as it lies on the disk.

use serde::{Deserialize, Serialize};

use crate::register::Register;
use crate::window::Counters;
use crate::wire::Forgotten;

/// Version of this file.
const VERSION: u32 = 1;

/// A file of clients that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoredError {
    /// It is damaged.
    #[error("it cannot be read: {0}")]
    Unreadable(#[from] serde_json::Error),
    /// A later version of the software wrote it.
    #[error("it is of version {0}, and this software knows {VERSION}")]
    Version(u32),
    /// It contradicts itself.
    #[error("it lists a client twice, or too many")]
    Unsound,
}

#[derive(Serialize, Deserialize)]
pub(crate) struct Stored {
    version: u32,
    pub(crate) counters: Counters,
    pub(crate) clients: Register,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) forgotten: Option<Forgotten>,
}

impl Stored {
    pub(crate) fn new(counters: Counters, clients: Register, forgotten: Option<Forgotten>) -> Self {
        Self {
            version: VERSION,
            counters,
            clients,
            forgotten,
        }
    }

    pub(crate) fn parse(text: &str) -> Result<Self, StoredError> {
        #[derive(Deserialize)]
        struct Head {
            version: u32,
        }
        let head: Head = serde_json::from_str(text)?;
        if head.version != VERSION {
            return Err(StoredError::Version(head.version));
        }
        let stored: Self = serde_json::from_str(text)?;
        if !stored.clients.is_sound() {
            return Err(StoredError::Unsound);
        }
        Ok(stored)
    }

    pub(crate) fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain types without maps can be written")
    }
}
