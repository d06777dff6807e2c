//! What can be said on the command line.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// `rvac flash`.
#[derive(Debug, Args)]
pub struct FlashJob {
    /// What to do.
    #[command(subcommand)]
    pub verb: FlashVerb,
    /// How the Linux board is wired to the robot.
    #[arg(
        long,
        value_name = "FILE",
        default_value = "/etc/rvac-flash.toml",
        global = true
    )]
    pub wiring: PathBuf,
    /// The robot does not answer, and you have looked: it stands on its dock with a charged pack.
    #[arg(long, global = true)]
    pub robot_is_silent: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum FlashVerb {
    /// Say which chip answers; nothing is changed.
    Probe,
    /// Read the whole chip twice, compare, and keep it.
    Backup,
    /// Write an Intel HEX file and verify it.
    Write {
        /// The firmware.
        file: PathBuf,
        /// What the owner takes upon himself.
        #[command(flatten)]
        safeguards: Safeguards,
    },
    /// Write what was measured on this robot into its flash, where its firmware finds it; the firmware stays.
    Calibration {
        /// The values, as `rvac calibrate` and the panel keep them.
        #[arg(default_value = "/var/lib/vthal/calibration.toml")]
        file: PathBuf,
    },
    /// Compare the chip with an Intel HEX file.
    Verify {
        /// The firmware.
        file: PathBuf,
    },
    /// Write a backup back and verify it.
    Restore {
        /// Its name, as `rvac flash backup` told it; the oldest when not given, which is the maker's firmware.
        name: Option<String>,
        /// What the owner takes upon himself.
        #[command(flatten)]
        safeguards: Safeguards,
    },
}

/// What the owner takes upon himself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Args)]
pub struct Safeguards {
    /// Write although no way back is known: the maker's firmware is lost.
    #[arg(long = "i-have-no-way-back")]
    pub no_way_back: bool,
    /// Erase the whole chip first: the only way into one that is protected. What it holds is lost.
    #[arg(long)]
    pub erase_chip: bool,
}
