//! `rvac-matter`: the robot as a vacuum cleaner of Matter.
#![forbid(unsafe_code)]

mod choices;
mod clusters;
mod code_socket;
mod identity;
mod network;
mod node;
mod progress;
mod refusal;
mod relay;
mod robot;
mod store;
mod text;
mod view;

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use bridge::service::{self, ConfigurationError};
use choices::Choices;
use clap::Parser;
use identity::Identity;
use store::Folder;

/// Joins the robot to a home by Matter.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET", default_value = "/run/vthal/vthal.sock")]
    vthal: PathBuf,
    /// Folder in which the code and the homes that the robot has joined are kept
    #[arg(long, value_name = "FOLDER", default_value = "/var/lib/rvac-matter")]
    state: PathBuf,
    /// Network to be found on, for example wlan0; the first that is up when none is given
    #[arg(long, value_name = "NAME")]
    network: Option<String>,
    /// UDP port to listen on
    #[arg(long, default_value_t = rs_matter::MATTER_PORT)]
    port: u16,
    /// Unix socket at which the panel's server asks for the code by which a home lets the robot in
    #[arg(long, value_name = "SOCKET")]
    code_socket: Option<PathBuf>,
    /// Only prints the code by which a home lets the robot in
    #[arg(long)]
    qr: bool,
}

fn main() -> ExitCode {
    service::start("rvac-matter", run)
}

async fn run(arguments: Arguments) -> anyhow::Result<()> {
    let folder = Folder::open(&arguments.state).map_err(|error| {
        ConfigurationError::Unfit(format!(
            "cannot keep anything in {}: {error}; choose another --state",
            arguments.state.display()
        ))
    })?;
    let identity = Identity::kept(&folder, &mut rand::rng()).context("the code")?;
    if arguments.qr {
        return Ok(write!(std::io::stdout(), "{}", identity.code()?)?);
    }
    let site = node::Site {
        socket: arguments.vthal,
        network: arguments.network,
        port: arguments.port,
        code_socket: arguments.code_socket,
    };
    let choices = Choices::kept(&folder);
    node::run(site, &identity, (folder, choices)).await
}
