//! What can be said on the command line.

use std::path::PathBuf;

use clap::Args;

/// `rvac update`.
#[derive(Debug, Args)]
pub struct UpdateJob {
    /// The update. Without one it says what is installed.
    pub file: Option<PathBuf>,
    /// Bring an update that was cut off to an end.
    #[arg(long, conflicts_with = "file")]
    pub settle: bool,
    /// The board starts: the programs are started by somebody else, afterwards.
    #[arg(long, requires = "settle")]
    pub at_boot: bool,
    /// Remove the file once it is open, and wait for an update that runs: the panel hands updates over like this.
    #[arg(long, requires = "file")]
    pub take: bool,
    /// The daemon is about to start: systemd says so.
    #[arg(long, hide = true, conflicts_with_all = ["file", "settle"])]
    pub daemon_starts: bool,
    /// The daemon has ended, with this result and this status: systemd says so.
    #[arg(long, hide = true, num_args = 2, value_names = ["RESULT", "STATUS"], allow_hyphen_values = true, conflicts_with_all = ["file", "settle", "daemon_starts"])]
    pub daemon_ended: Option<Vec<String>>,
    /// Take the programs alone; the robot's firmware stays.
    #[arg(long)]
    pub without_firmware: bool,
    /// Write a chip that cannot be read although no image is known to run on it: the maker's firmware is lost.
    #[arg(long = "i-have-no-way-back")]
    pub no_way_back: bool,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
    /// Folder of updates.
    #[arg(long, value_name = "DIR", default_value = "/var/lib/librervac")]
    pub folder: PathBuf,
    /// Folder with the public keys (.pub) of those who may sign.
    #[arg(long, value_name = "DIR", default_value = "/etc/librervac/update-keys")]
    pub keys: PathBuf,
    /// How the Linux board is wired to the robot.
    #[arg(long, value_name = "FILE", default_value = "/etc/rvac-flash.toml")]
    pub wiring: PathBuf,
    /// Port of the panel's plain page; 0 for a board without a panel.
    #[arg(long, value_name = "PORT", default_value_t = 80)]
    pub page_port: u16,
    /// How long daemon, robot and panel may take to answer.
    #[arg(long, value_name = "SECONDS", default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=600))]
    pub patience_s: u64,
    /// Command that starts daemon and panel again, its words separated by spaces.
    #[arg(
        long,
        value_name = "COMMAND",
        default_value = "systemctl restart vthal.service rvac-panel.service"
    )]
    pub restart: String,
}
