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
    /// Forget it, after the gyro or the battery pack was replaced: the robot learns again. It must be at rest.
    Forget {
        /// The robot's name.
        device: String,
        /// Forget only this; everything when not given.
        #[arg(long, value_enum)]
        part: Option<PartChoice>,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PartChoice {
    /// The errors of its gyro.
    Gyro,
    /// The energy that driving and cleaning take.
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
