//! Checks of what a person gave, before anything is started or written.

use super::{DEFAULT_HOME, DemoArguments};
use crate::firmware::RobotFirmware;
use crate::workspace::{self, Profile};
use crate::{process, system};
use anyhow::{Context, bail};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, TcpListener};
use std::process::Command;

/// Longest simulated run that makes sense without a browser: a week.
const MINUTES_MAX: f64 = 10_080.0;

/// Checks what needs no program of ours.
pub(crate) fn arguments(arguments: &DemoArguments) -> anyhow::Result<()> {
    let meta = match std::fs::metadata(here(arguments)) {
        Ok(meta) => meta,
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "home {}: there is no such file; give a map_server YAML, a Valetudo map JSON or a TOML such as {}",
            arguments.home.display(),
            DEFAULT_HOME
        ),
        Err(error) => return Err(error).with_context(|| format!("home {}", arguments.home.display())),
    };
    if !meta.is_file() {
        bail!(
            "home {}: that is not a file; give the map file itself",
            arguments.home.display()
        );
    }
    if !(arguments.minutes > 0.0 && arguments.minutes <= MINUTES_MAX) {
        bail!(
            "--minutes {}: must be above 0 and at most {MINUTES_MAX}",
            arguments.minutes
        );
    }
    robot(&arguments.robot)?;
    if arguments.emulated {
        RobotFirmware::of(&arguments.robot)?;
    }
    if arguments.headless {
        Ok(())
    } else {
        port(arguments.port)
    }
}

/// The home as the person meant it: relative to where they stand, or else to the root of the repository.
pub(crate) fn here(arguments: &DemoArguments) -> std::path::PathBuf {
    if arguments.home.exists() {
        arguments.home.clone()
    } else {
        workspace::root().join(&arguments.home)
    }
}

fn robot(name: &str) -> anyhow::Result<()> {
    let known = crate::codegen::robots::names(&workspace::root().join("robots"))?;
    if known.iter().any(|known| known == name) {
        return Ok(());
    }
    bail!(
        "robot {name:?} is unknown; robots/ describes: {}",
        known.join(", ")
    )
}

/// Checks that the port is free on this machine.
pub(crate) fn port(port: u16) -> anyhow::Result<()> {
    match TcpListener::bind((Ipv4Addr::LOCALHOST, port)) {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AddrInUse => {
            bail!("port {port} is in use by another program; end that one or choose another with --port")
        }
        Err(error) => bail!("port {port} cannot be opened ({error}); choose one above 1023 with --port"),
    }
}

/// Builds the simulator and lets it try the home for a blink: it knows the formats and what can be wrong with each.
pub(crate) fn home(arguments: &DemoArguments) -> anyhow::Result<()> {
    system::need("cc", &["gcc", "libc6-dev"]).context("Rust programs need a linker")?;
    workspace::build(&["rvac-sim"], Profile::Dev)?;
    let mut check = Command::new(workspace::program("rvac-sim", Profile::Dev));
    check.args(["run", "--json", "--minutes", "0.001", "--robot", &arguments.robot]);
    check.arg("--home").arg(std::path::absolute(here(arguments))?);
    check.current_dir(workspace::root());
    let output = process::finish(&mut check)?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    bail!("{}", said.trim().trim_start_matches("rvac-sim: "))
}
