//! Starts the services and shows the way in.

use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use anyhow::bail;

use super::say;
use crate::arguments::{Console, PairOptions};
use crate::board::Board;
use crate::devices;

/// The services, in the order of their start.
const SERVICES: [&str; 2] = ["vthal.service", "rvac-panel.service"];
/// The panel makes its certificate at its first start, which takes seconds on a small board.
const PATIENCE: Duration = Duration::from_secs(30);

/// Has systemd start both; without systemd the commands are shown.
pub(super) fn services(board: &Board) -> anyhow::Result<()> {
    if !board.has_systemd() {
        return Ok(say(
            "systemd does not run here, so nothing is started. By hand:\n  \
             vthal --config /etc/vthal.toml &\n  \
             panel-server --vthal /run/vthal/vthal.sock --assets /usr/share/rvac-panel --bind :: --port 443 --page-port 80 --announce \
             --state /var/lib/rvac-panel &",
        )?);
    }
    let status = Command::new("systemctl")
        .args(["enable", "--now"])
        .args(SERVICES)
        .status()?;
    if !status.success() {
        bail!(
            "systemctl could not start the services ({status}): start it with sudo, or look at journalctl -u vthal"
        );
    }
    let restarted = Command::new("systemctl").arg("restart").args(SERVICES).status()?;
    if !restarted.success() {
        bail!("the services do not stay up: journalctl -u vthal -u rvac-panel says why");
    }
    Ok(say(
        "vthal and the panel are started, now and at each start of this board",
    )?)
}

/// Opens a window for the first device and shows its code and the addresses, as text and as a QR code. Without a panel that runs, it says
/// how to get there.
pub(super) fn show_way_in(console: &Console) -> anyhow::Result<ExitCode> {
    let deadline = Instant::now() + PATIENCE;
    while console.console.parent().is_some_and(|folder| folder.is_dir()) && Instant::now() < deadline {
        if std::os::unix::net::UnixStream::connect(&console.console).is_ok() {
            return devices::pair(&PairOptions::here(console.clone()));
        }
        std::thread::sleep(Duration::from_millis(200));
        if !std::path::Path::new("/run/systemd/system").is_dir() {
            break;
        }
    }
    say("Once the panel runs, rvac pair shows its address and lets the first device in.")?;
    Ok(ExitCode::SUCCESS)
}
