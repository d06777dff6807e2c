//! What `rvac` and the server exchange over the server's own Unix socket: one line of JSON in each direction.

use serde::{Deserialize, Serialize};

use crate::wire::{ClientRow, OpenedHere, Refused};
use crate::{DeviceName, Role, TokenId};

/// A question or an order of the person at the console.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
pub enum Order {
    /// Opens a window.
    Pair {
        /// What the new device may do.
        role: Role,
    },
    /// Lets a program in without a window: its token is the answer.
    Add {
        /// How it is called.
        name: DeviceName,
        /// What it may do.
        role: Role,
    },
    /// Lists the clients.
    Clients,
    /// Shuts one out.
    Revoke {
        /// Whom.
        id: TokenId,
    },
    /// Gives one another role.
    SetRole {
        /// Whom.
        id: TokenId,
        /// Which.
        role: Role,
    },
    /// Says that the person who uses this device is beside the robot.
    Vouch {
        /// Which.
        id: TokenId,
    },
    /// Forgets all devices.
    ForgetAll {
        /// Also the robot's identity: devices that trust its certificate must trust a new one.
        identity: bool,
    },
    /// Asks for what devices may trust.
    Trust,
}

/// What the server says to it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "is", rename_all = "kebab-case")]
pub enum Reply {
    /// The window is open.
    Opened(OpenedHere),
    /// The program was let in.
    Added {
        /// What it shows with each request.
        token: String,
    },
    /// The clients.
    Clients {
        /// Oldest first.
        clients: Vec<ClientRow>,
    },
    /// Done.
    Done,
    /// What devices may trust.
    Trust(Trust),
    /// Not done.
    Refused(Refused),
}

/// The robot's certificate authority.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trust {
    /// The robot's full number.
    pub robot: String,
    /// Its host name.
    pub host_name: String,
    /// Where devices find the robot.
    pub addresses: Vec<String>,
    /// The certificate.
    pub pem: String,
    /// SHA-256 of the certificate, as devices show it.
    pub fingerprint: String,
}
