//! `rvac learnt`.

use clap::{Args, Subcommand, ValueEnum};
use rvac_api::LearntPart;

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct LearntJob {
    #[command(subcommand)]
    pub(crate) verb: Option<LearntVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum LearntVerb {
    /// Have a robot learn anew: its gyro or its pack was changed. It must be at rest.
    Forget {
        /// The robot's name.
        device: String,
        /// Only this; without it all.
        #[arg(long, value_enum)]
        part: Option<PartChoice>,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PartChoice {
    /// What is wrong with its gyro.
    Gyro,
    /// What driving takes from its pack.
    Energy,
}

impl From<PartChoice> for LearntPart {
    fn from(choice: PartChoice) -> Self {
        match choice {
            PartChoice::Gyro => Self::Gyro,
            PartChoice::Energy => Self::Energy,
        }
    }
}
