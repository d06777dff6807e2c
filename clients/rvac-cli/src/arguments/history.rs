//! What can be said of the history.

use std::path::PathBuf;

use clap::Args;

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct HistoryJob {
    #[command(subcommand)]
    pub(crate) verb: Option<HistoryVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Largest number of runs to list.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u8).range(1..=50))]
    pub(crate) count: u8,
    /// List only runs with lower numbers.
    #[arg(long, value_name = "NUMBER")]
    pub(crate) before: Option<u64>,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum HistoryVerb {
    /// Show everything about one run, with its stops.
    Show {
        /// Its number.
        number: u64,
    },
    /// Save the recordings of a run as one file, for a bug report.
    Save {
        /// Its number.
        number: u64,
        /// The file, which must not exist yet.
        file: PathBuf,
        /// Save only one of them, if the daemon restarted during the run; 1 is the first.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
        recording: Option<u32>,
    },
}
