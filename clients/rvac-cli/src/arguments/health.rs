//! `rvac health`.

use clap::{Args, Subcommand};

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct HealthJob {
    #[command(subcommand)]
    pub(crate) verb: Option<HealthVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum HealthVerb {
    /// Report that a part was replaced, or sensors were cleaned: its hours begin again.
    Renew {
        /// brush-main, brush-sides, filter or sensors.
        component: String,
    },
    /// Take the last of these reports back.
    Undo {
        /// brush-main, brush-sides, filter or sensors.
        component: String,
    },
    /// Report that a part was cleaned or replaced: the robot learns its load again.
    Reset {
        /// brush-main, wheel-left or wheel-right.
        component: String,
    },
}
