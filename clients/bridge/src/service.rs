//! How a bridge starts and ends: its configuration, its words to systemd, its signals.

use std::path::Path;
use std::process::ExitCode;

use serde::de::DeserializeOwned;
pub use systemd_notice::tell_ready;
use systemd_notice::{show_life, tell_stopping};
use tokio::signal::unix::{SignalKind, signal};

/// What must be changed before another start can go better.
const EXIT_REFUSED: u8 = 2;

/// Why a bridge does not start.
#[derive(Debug, thiserror::Error)]
pub enum ConfigurationError {
    /// The file cannot be read.
    #[error("cannot read {path}: {source}")]
    Unreadable {
        /// Which.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// It says something that cannot be.
    #[error("{path}: {source}")]
    Wrong {
        /// Which.
        path: String,
        /// What.
        source: Box<toml::de::Error>,
    },
    /// It names something that does not fit.
    #[error("{0}")]
    Unfit(String),
}

/// Reads a configuration.
///
/// # Errors
/// [`ConfigurationError`].
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<T, ConfigurationError> {
    let named = || path.display().to_string();
    let text = kept_file::read_text(path).map_err(|source| ConfigurationError::Unreadable {
        path: named(),
        source,
    })?;
    toml::from_str(&text).map_err(|source| ConfigurationError::Wrong {
        path: named(),
        source: Box::new(source),
    })
}

/// The word by which a bridge prints its manual page, for packages.
const MANUAL: &str = "manual";

/// Starts a bridge with the words of its command line, or prints its manual page. It runs until a signal ends it. What refuses its
/// configuration ends with 2, so that systemd does not try again.
pub fn start<A, W>(name: &str, work: impl FnOnce(A) -> W) -> ExitCode
where
    A: clap::Parser,
    W: Future<Output = anyhow::Result<()>>,
{
    let manual = clap::Command::new(MANUAL)
        .about("Prints the manual page, for packages")
        .hide(true);
    let command = A::command().subcommand(manual);
    let words = command.clone().get_matches();
    if words.subcommand_name() == Some(MANUAL) {
        return print_manual(command);
    }
    match A::from_arg_matches(&words) {
        Ok(arguments) => run(name, work(arguments)),
        Err(error) => error.exit(),
    }
}

fn print_manual(command: clap::Command) -> ExitCode {
    match clap_mangen::Man::new(command).render(&mut std::io::stdout()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn run(name: &str, work: impl Future<Output = anyhow::Result<()>>) -> ExitCode {
    let filter = tracing_subscriber::EnvFilter::try_from_default_env()
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("info"));
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_env_filter(filter)
        .init();
    let runtime = match tokio::runtime::Builder::new_current_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return fail(name, &error.into()),
    };
    match runtime.block_on(until_signal(work)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(name, &error),
    }
}

fn fail(name: &str, error: &anyhow::Error) -> ExitCode {
    eprintln!("{name}: {error:#}");
    let refused = error.downcast_ref::<ConfigurationError>().is_some();
    if refused {
        ExitCode::from(EXIT_REFUSED)
    } else {
        ExitCode::FAILURE
    }
}

async fn until_signal(work: impl Future<Output = anyhow::Result<()>>) -> anyhow::Result<()> {
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    let ended = tokio::select! {
        ended = work => ended,
        () = show_life() => Ok(()),
        _ = terminate.recv() => Ok(()),
        _ = interrupt.recv() => Ok(()),
    };
    tell_stopping();
    ended
}
