//! `rvac floor`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct FloorJob {
    #[command(subcommand)]
    pub(crate) verb: Option<FloorVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum FloorVerb {
    /// Say on which floor the robot is.
    Choose {
        /// Its number or name.
        floor: String,
    },
    /// Say that the robot is on a floor of which nothing is kept yet; what it has drawn since it lost its way is the map of it.
    New {
        /// What to call it.
        name: Option<String>,
    },
    /// Name a floor.
    Name {
        /// Its number or name.
        floor: String,
        /// What to call it.
        name: String,
    },
    /// Take the name of a floor away.
    Unname {
        /// Its number or name.
        floor: String,
    },
    /// Remove a floor; its maps are kept.
    Remove {
        /// Its number or name.
        floor: String,
    },
    /// Bring a removed floor back, with all versions of its map.
    Restore {
        /// Its number or name.
        floor: String,
    },
    /// Write the floors with their newest maps, names and no-go zones into a file that another robot, or this one, takes.
    Export {
        /// Where to; nothing that is there is written over.
        file: PathBuf,
        /// Only this one: its number or name.
        #[arg(long)]
        floor: Option<String>,
    },
    /// Take the floors of such a file, beside those that there are.
    Import {
        /// The file.
        file: PathBuf,
    },
}
