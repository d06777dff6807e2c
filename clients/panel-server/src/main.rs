//! The binary: reads the command line, serves until it is told to stop.
#![forbid(unsafe_code)]

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use panel_server::{NetworkAccess, Server, Settings, StartError};
use tokio::signal::unix::{SignalKind, signal};

/// Serves the panel of LibreRVAC and relays between browsers and vthal.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET")]
    vthal: PathBuf,
    /// Unix socket of the simulator, when the robot is simulated
    #[arg(long, value_name = "SOCKET")]
    simulator: Option<PathBuf>,
    /// Address to listen on
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Port to listen on; 0 takes any free one
    #[arg(long, default_value_t = 8080)]
    port: u16,
    /// Folder of the packed panel
    #[arg(long, value_name = "DIR")]
    assets: PathBuf,
    /// Further name by which browsers may call this server, for example robot.local
    #[arg(long, value_name = "NAME")]
    host_name: Vec<String>,
    /// Listen beyond this computer although there is no authentication yet
    #[arg(long)]
    allow_network: bool,
}

impl From<Arguments> for Settings {
    fn from(arguments: Arguments) -> Self {
        let network = if arguments.allow_network {
            NetworkAccess::Everyone
        } else {
            NetworkAccess::LoopbackOnly
        };
        Self {
            vthal: arguments.vthal,
            simulator: arguments.simulator,
            address: SocketAddr::new(arguments.bind, arguments.port),
            network,
            assets: arguments.assets,
            host_names: arguments.host_name,
        }
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    tracing_subscriber::fmt().with_writer(std::io::stderr).init();
    match run(arguments.into()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let refused = error.downcast_ref::<StartError>().is_some();
            eprintln!("panel-server: {error}");
            ExitCode::from(if refused { 2 } else { 1 })
        }
    }
}

#[tokio::main(flavor = "current_thread")]
async fn run(settings: Settings) -> anyhow::Result<()> {
    let server = Server::bind(settings).await?;
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    writeln!(std::io::stdout(), "ready http://{}/", server.address())?;
    tokio::select! {
        () = server.run() => {}
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
    }
    Ok(())
}
