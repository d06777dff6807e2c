//! What can be said about setting a board up.

use std::path::PathBuf;

use clap::Args;

use super::{Console, Daemon};

#[derive(Debug, Args)]
pub(crate) struct SetupOptions {
    /// Serial device of the robot; looked for when not given.
    #[arg(long, value_name = "PATH")]
    pub(crate) serial: Option<PathBuf>,
    /// Model of a robot that does not answer yet: sr8730 or relax.
    #[arg(long)]
    pub(crate) model: Option<String>,
    /// Ask nothing.
    #[arg(long, short)]
    pub(crate) yes: bool,
    /// Configure once more, though there is a configuration.
    #[arg(long)]
    pub(crate) anew: bool,
    /// Folder of the system to set up, for images of cards.
    #[arg(long, value_name = "DIR", default_value = "/")]
    pub(crate) root: PathBuf,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    #[command(flatten)]
    pub(crate) console: Console,
}

#[derive(Debug, Args)]
pub(crate) struct DoctorOptions {
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    #[command(flatten)]
    pub(crate) console: Console,
}
