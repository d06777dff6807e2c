//! The binary: reads the command line, serves until a signal ends it.
#![forbid(unsafe_code)]

mod host_name;

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser};
use panel_server::{Guard, Server, Settings, StartError, free_bytes, unix_s};
use tokio::signal::unix::{SignalKind, signal};

/// Serves the panel of LibreRVAC and relays between browsers and vthal.
#[derive(Debug, Parser)]
#[command(
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
struct Arguments {
    #[command(flatten)]
    serve: Option<Serve>,
    #[command(subcommand)]
    command: Option<Job>,
}

#[derive(Debug, clap::Args)]
struct Serve {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET")]
    vthal: PathBuf,
    /// Unix socket of the simulator, when the robot is simulated
    #[arg(long, value_name = "SOCKET")]
    simulator: Option<PathBuf>,
    /// Unix socket at which rvac-matter tells the code by which a home lets the robot in
    #[arg(long, value_name = "SOCKET")]
    matter: Option<PathBuf>,
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
    #[arg(long, value_name = "NAME", value_parser = host_name::parse)]
    host_name: Vec<String>,
    /// Folder of the robot's identity and of its paired devices: with it, HTTPS and for paired devices only
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,
    /// Unix socket for rvac pair, clients and trust; console.sock in the folder of --state when absent
    #[arg(long, value_name = "SOCKET", requires = "state")]
    console: Option<PathBuf>,
    /// Folder of the card that this computer starts from: a file librvac-reset in it has all devices forgotten
    #[arg(long, value_name = "DIR", requires = "state")]
    card: Option<PathBuf>,
    /// Port of a page that points to the HTTPS address, usually 80
    #[arg(long, value_name = "PORT", requires = "state")]
    page_port: Option<u16>,
    /// Folder in which rvac update keeps its files
    #[arg(
        long,
        value_name = "DIR",
        requires = "state",
        default_value = "/var/lib/librervac"
    )]
    updates: PathBuf,
    /// Announce the robot's name on the home network, so that https://NAME.local/ is found
    #[arg(long, requires = "state")]
    announce: bool,
}

#[derive(Debug, clap::Subcommand)]
enum Job {
    /// Prints the manual page, for packages
    #[command(hide = true)]
    Manual,
}

impl From<Serve> for Settings {
    fn from(arguments: Serve) -> Self {
        let (console, card, page_port) = (arguments.console, arguments.card, arguments.page_port);
        let (announce, updates) = (arguments.announce, arguments.updates);
        let guard = arguments.state.map(|state| Guard {
            state,
            console,
            card,
            page_port,
            announce,
            updates,
            free_bytes,
            clock: unix_s,
        });
        Self {
            vthal: arguments.vthal,
            simulator: arguments.simulator,
            matter: arguments.matter,
            address: SocketAddr::new(arguments.bind, arguments.port),
            guard,
            assets: arguments.assets,
            host_names: arguments.host_name,
        }
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match (arguments.command, arguments.serve) {
        (Some(Job::Manual), _) | (None, None) => print_manual(),
        (None, Some(serve)) => run_server(serve.into()),
    }
}

fn run_server(settings: Settings) -> ExitCode {
    tracing_subscriber::fmt().with_writer(std::io::stderr).init();
    match run(settings) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let refused = error.downcast_ref::<StartError>().is_some();
            eprintln!("panel-server: {error}");
            ExitCode::from(if refused { 2 } else { 1 })
        }
    }
}

fn print_manual() -> ExitCode {
    let manual = clap_mangen::Man::new(Arguments::command());
    match manual.render(&mut std::io::stdout()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

#[tokio::main(flavor = "current_thread")]
async fn run(settings: Settings) -> anyhow::Result<()> {
    let server = Server::bind(settings).await?;
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    writeln!(std::io::stdout(), "ready {}", server.url())?;
    systemd_notice::tell_ready();
    tokio::select! {
        () = server.run() => {}
        () = systemd_notice::show_life() => {}
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
    }
    systemd_notice::tell_stopping();
    Ok(())
}
