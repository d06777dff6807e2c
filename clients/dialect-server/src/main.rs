//! `rvac-dialect`: the REST interface that Valetudo's clients speak, for a robot that is none of theirs. Off until its owner writes a
//! configuration.
#![forbid(unsafe_code)]

mod access;
mod answer;
mod capabilities;
mod configuration;
mod connections;
mod desk;
mod driving;
mod reads;
mod routes;
mod site;
mod streams;

use std::io::Write as _;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use bridge::service::{self, ConfigurationError};
use clap::Parser;
use configuration::Configuration;
use site::Site;
use tokio::net::TcpListener;

/// Shows the robot to clients that know Valetudo's REST interface, and takes their commands.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Configuration
    #[arg(long, value_name = "FILE", default_value = "/etc/rvac-dialect.toml")]
    config: PathBuf,
}

fn main() -> ExitCode {
    service::start("rvac-dialect", |arguments: Arguments| async move {
        run(service::read(&arguments.config)?).await
    })
}

async fn run(configuration: Configuration) -> anyhow::Result<()> {
    configuration.check()?;
    let address = SocketAddr::new(configuration.bind, configuration.port);
    let listener = TcpListener::bind(address).await.map_err(|error| {
        ConfigurationError::Unfit(format!(
            "cannot listen on {address}: {error}; choose another bind or port"
        ))
    })?;
    writeln!(
        std::io::stdout(),
        "ready http://{}/api/v2",
        listener.local_addr()?
    )?;
    service::tell_ready();
    let (desk, questions) = desk::open();
    let site = Arc::new(Site::new(&configuration, desk));
    let router = routes::router(Arc::clone(&site));
    tokio::select! {
        () = desk::follow(configuration.vthal, site, questions) => {}
        () = connections::accept(listener, router) => {}
    }
    Ok(())
}
