//! `rvac-mqtt`: the bridge from the daemon to a broker of MQTT, and to Home Assistant behind it.
#![forbid(unsafe_code)]

mod commands;
mod configuration;
mod core;
mod dialect;
mod discovery;
mod documents;
mod session;
mod shell;
mod topics;
mod voice;
mod wire;

use std::path::PathBuf;
use std::process::ExitCode;

use bridge::service;
use clap::Parser;

/// Shows the robot to a broker of MQTT and to Home Assistant, and takes their commands.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Configuration
    #[arg(long, value_name = "FILE", default_value = "/etc/rvac-mqtt.toml")]
    config: PathBuf,
}

fn main() -> ExitCode {
    service::start("rvac-mqtt", |arguments: Arguments| async move {
        shell::run(service::read(&arguments.config)?).await
    })
}
