//! The settings of the server, and why it may refuse to start.

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};

use crate::AssetsError;
use crate::gate::GateError;

/// Settings of a server.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Unix socket of vthal. It need not exist yet.
    pub vthal: PathBuf,
    /// Unix socket of the simulator, if the robot is simulated. It need not exist yet.
    pub simulator: Option<PathBuf>,
    /// Unix socket at which `rvac-matter` tells its code, for administrators. It need not exist yet.
    pub matter: Option<PathBuf>,
    /// Address to listen on. Port 0 takes any free port.
    pub address: SocketAddr,
    /// With it the server speaks HTTPS to paired devices only, which it must beyond loopback; without it, HTTP to everybody on
    /// this computer.
    pub guard: Option<Guard>,
    /// Folder of the packed panel.
    pub assets: PathBuf,
    /// Names, beside those of loopback, by which browsers may call this server.
    pub host_names: Vec<String>,
}

/// How the robot is kept from others on the network.
#[derive(Clone, Debug)]
pub struct Guard {
    /// Folder of the robot's identity and of the list of its devices.
    pub state: PathBuf,
    /// Unix socket of the person at this computer; in `state` when absent.
    pub console: Option<PathBuf>,
    /// Folder in which the owner may put the file that has all devices forgotten.
    pub card: Option<PathBuf>,
    /// Whether the robot's name is announced on the home network.
    pub announce: bool,
    /// Port of a page that only points to the HTTPS address.
    pub page_port: Option<u16>,
    /// Where `rvac update` keeps its files: how far an update is stands there.
    pub updates: PathBuf,
    /// Bytes that fit on the disk of a folder still.
    pub free_bytes: fn(&Path) -> std::io::Result<u64>,
    /// The board's clock, seconds since 1970, on which nothing but the life of the certificate depends: see [`crate::unix_s`].
    pub clock: fn() -> u64,
}

/// Why the server does not start. Each is one sentence with its remedy.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The address is reachable from outside, and nothing would keep others out.
    #[error(
        "refusing to listen on {0} without --state: whoever reaches that address could drive the robot; name a folder with \
         --state, so that only paired devices may, or use --bind 127.0.0.1"
    )]
    BeyondLoopback(IpAddr),
    /// Another program has the port.
    #[error("port {} on {} is already in use: stop the other program or choose another port with --port", .0.port(), .0.ip())]
    PortInUse(SocketAddr),
    /// Listening failed for another reason.
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
    /// Certificate or clients are not to be had.
    #[error(transparent)]
    Gate(#[from] GateError),
    /// Deleting all devices, as the owner asked, failed.
    #[error(
        "cannot forget all devices, as the file on the card asks: {0}; then rename that file back and start again"
    )]
    Forget(String),
    /// The console's socket cannot be made.
    #[error("cannot listen on {path}: {source}; choose another place with --console")]
    Console {
        /// Where.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl Settings {
    /// Checks that the address is loopback or that only paired devices are answered.
    ///
    /// # Errors
    /// [`StartError::BeyondLoopback`].
    pub fn check_reach(&self) -> Result<(), StartError> {
        let ip = self.address.ip();
        if ip.is_loopback() || self.guard.is_some() {
            return Ok(());
        }
        Err(StartError::BeyondLoopback(ip))
    }
}
