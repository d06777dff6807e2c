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
    /// Set the floor that the robot is on.
    Choose {
        /// Its number or name.
        floor: String,
    },
    /// Report that the robot is on a new floor; the map that it has drawn since it was lost becomes the map of that floor.
    New {
        /// Name of the floor.
        name: Option<String>,
    },
    /// Name a floor.
    Name {
        /// Its number or name.
        floor: String,
        /// Name of the floor.
        name: String,
    },
    /// Remove the name of a floor.
    Unname {
        /// Its number or name.
        floor: String,
    },
    /// Remove a floor; its maps are kept.
    Remove {
        /// Its number or name.
        floor: String,
    },
    /// Restore a removed floor, with all versions of its map.
    Restore {
        /// Its number or name.
        floor: String,
    },
    /// Export the floors with their newest maps, names and no-go zones to a file that this or another robot can import.
    Export {
        /// The file, which must not exist yet.
        file: PathBuf,
        /// Export only this floor: its number or name.
        #[arg(long)]
        floor: Option<String>,
    },
    /// Add the floors of such a file to the floors of the robot.
    Import {
        /// The file.
        file: PathBuf,
    },
}
