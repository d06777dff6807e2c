//! `rvac statistics`.

use clap::Args;

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct StatisticsOptions {
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}
