//! Where the log goes: standard error, and files of bounded size.

use std::io;
use std::path::Path;
use std::sync::Mutex;

use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{Layer, fmt};

use crate::config::LogConfig;
use crate::rotation::{RotatingFile, RotationLimits};
use crate::told_lines::{ToldLines, told_lines};

/// Starts the log. Call it once. Gives the warnings and errors that clients are to read, and why the log file cannot be opened, if it
/// cannot: then the log goes to standard error alone.
pub(crate) fn start(folder: &Path, config: &LogConfig) -> (ToldLines, io::Result<()>) {
    let limits = RotationLimits {
        size_max: u64::from(config.size_mib) << 20,
        files_max: config.files,
    };
    let (file, result) = match RotatingFile::open(&folder.join("vthal.log"), limits) {
        Ok(file) => (Some(file), Ok(())),
        Err(error) => (None, Err(error)),
    };
    let to_stderr = fmt::layer()
        .with_target(false)
        .with_ansi(false)
        .without_time()
        .with_writer(io::stderr);
    let to_file = file.map(|file| {
        fmt::layer()
            .with_target(false)
            .with_ansi(false)
            .with_writer(Mutex::new(file))
            .with_filter(config.level)
    });
    let (telling, lines) = told_lines();
    tracing_subscriber::registry()
        .with(telling)
        .with(to_stderr.with_filter(config.level))
        .with(to_file)
        .init();
    (lines, result)
}
