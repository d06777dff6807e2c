//! What can be said about devices and who may use them.

use std::path::PathBuf;

use clap::Args;
use pairing::{DeviceName, Role, TokenId};

use crate::remote::Address;

/// Where panel-server listens for the person at its computer.
#[derive(Clone, Debug, Args)]
pub(crate) struct Console {
    /// Unix socket of panel-server.
    #[arg(
        long,
        value_name = "PATH",
        env = "RVAC_CONSOLE",
        default_value = "/var/lib/rvac-panel/console.sock",
        global = true
    )]
    pub(crate) console: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct PairOptions {
    #[command(flatten)]
    pub(crate) console: Console,
    /// What the new device may do: view, drive or admin.
    #[arg(long, default_value_t = Role::Admin)]
    pub(crate) role: Role,
    /// Pair this computer with that robot, by a code that it shows.
    #[arg(long, value_name = "https://NAME[:PORT]", conflicts_with = "role")]
    pub(crate) robot: Option<Address>,
    /// Name of this computer in the robot's list; its host name when not given.
    #[arg(long, value_parser = DeviceName::new, requires = "robot")]
    pub(crate) name: Option<DeviceName>,
}

impl PairOptions {
    /// An administrator's device, let in by whoever is at this computer.
    pub(crate) fn here(console: Console) -> Self {
        Self {
            console,
            role: Role::Admin,
            robot: None,
            name: None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct ClientsJob {
    #[command(subcommand)]
    pub(crate) verb: Option<ClientsVerb>,
    #[command(flatten)]
    pub(crate) console: Console,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum ClientsVerb {
    /// Remove a device.
    Revoke {
        /// Its number.
        id: TokenId,
    },
    /// Confirm that the person who uses a device is beside the robot: for five minutes it may send raw packets, if it is an administrator.
    Vouch {
        /// Its number.
        id: TokenId,
    },
    /// Remove all devices: each must be paired again. Maps and schedules stay.
    ForgetAll {
        /// Create a new identity as well: whatever trusts the robot's certificate must trust the new one.
        #[arg(long)]
        identity: bool,
    },
    /// Give a device another role.
    Role {
        /// Its number.
        id: TokenId,
        /// view, drive or admin.
        role: Role,
    },
    /// Add a program, and print the token that it sends as `Authorization: Bearer TOKEN`.
    Add {
        /// Name of the program in the list.
        #[arg(value_parser = DeviceName::new)]
        name: DeviceName,
        /// What the program may do: view, drive or admin.
        #[arg(long, default_value_t = Role::View)]
        role: Role,
    },
}

#[derive(Debug, Args)]
pub(crate) struct TrustOptions {
    #[command(flatten)]
    pub(crate) console: Console,
    /// Write the certificate into this folder: as PEM, for Android and Windows, and as a profile for iPhones.
    #[arg(long, value_name = "DIR")]
    pub(crate) save: Option<PathBuf>,
    /// Put it into the store that Chromium on this computer uses.
    #[arg(long)]
    pub(crate) install: bool,
}
