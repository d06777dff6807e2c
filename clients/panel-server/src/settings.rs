//! What the server is told at its start, and why it may refuse to start.

use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

use crate::AssetsError;

/// Settings of a server.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Unix socket of vthal. It need not exist yet.
    pub vthal: PathBuf,
    /// Unix socket of the simulator, if the robot is simulated. It need not exist yet.
    pub simulator: Option<PathBuf>,
    /// Address to listen on. Port 0 takes any free port.
    pub address: SocketAddr,
    /// Whether an address beyond loopback is allowed.
    pub network: NetworkAccess,
    /// Folder of the packed panel.
    pub assets: PathBuf,
    /// Names, beside those of loopback, by which browsers may call this server.
    pub host_names: Vec<String>,
}

/// Who may reach the server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetworkAccess {
    /// Only this computer.
    LoopbackOnly,
    /// Everyone on the network. There is no authentication yet: whoever reaches the port drives the robot.
    Everyone,
}

/// Why the server does not start. Each is one sentence with its remedy.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The address is reachable from outside and nobody allowed that.
    #[error(
        "refusing to listen on {0}: whoever reaches that address could drive the robot, because this version has no \
         authentication; use --bind 127.0.0.1, or add --allow-network if you trust everyone on your network"
    )]
    BeyondLoopback(IpAddr),
    /// Another program has the port.
    #[error("port {} on {} is already in use: stop the other program or choose another port with --port", .0.port(), .0.ip())]
    PortInUse(SocketAddr),
    /// Listening failed in another way.
    #[error("cannot listen on {address}: {source}; choose another --bind or --port")]
    Listen {
        /// Where.
        address: SocketAddr,
        /// Why.
        source: std::io::Error,
    },
    /// The packed panel cannot be read.
    #[error(transparent)]
    Assets(#[from] AssetsError),
}

impl Settings {
    /// Checks that the address is loopback or that the network is allowed.
    ///
    /// # Errors
    /// [`StartError::BeyondLoopback`].
    pub fn check_reach(&self) -> Result<(), StartError> {
        let ip = self.address.ip();
        if ip.is_loopback() || self.network == NetworkAccess::Everyone {
            return Ok(());
        }
        Err(StartError::BeyondLoopback(ip))
    }
}
