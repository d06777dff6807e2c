//! What can be said on the command line.

mod devices;
mod floors;
mod health;
mod history;
mod learnt;
mod orders;
mod schedules;
mod setup;
mod statistics;

use std::path::PathBuf;

use clap::{Args, Parser, ValueEnum};

use crate::remote::Address;

pub(crate) use devices::{ClientsJob, ClientsVerb, Console, PairOptions, TrustOptions};
pub(crate) use floors::{FloorJob, FloorVerb};
pub(crate) use health::{HealthJob, HealthVerb};
pub(crate) use history::{HistoryJob, HistoryVerb};
pub(crate) use learnt::{LearntJob, LearntVerb};
pub(crate) use orders::{
    EstimateOptions, OrderOptions, OrderParts, Place, PlacesJob, PlacesVerb, RoomsJob, RoomsVerb, ZoneJob,
    ZoneVerb,
};
pub(crate) use schedules::{ScheduleJob, ScheduleOptions, ScheduleVerb, day_name};
pub(crate) use setup::{DoctorOptions, SetupOptions};
pub(crate) use statistics::StatisticsOptions;

/// LibreRVAC from the command line.
#[derive(Debug, Parser)]
#[command(name = "rvac", version, about)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) subcommand: Subcommand,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum Subcommand {
    /// Type packets to the robot; see both directions.
    Term(TermOptions),
    /// Add the CRC to a packet, check it, or decode the packet.
    Packet(PacketJob),
    /// What the robot is doing.
    Status(StatusOptions),
    /// What the robot is doing, line by line, until interrupted.
    Watch(WatchOptions),
    /// What the robot knows of the home; the saved versions of its map, and how to restore one.
    Map(MapJob),
    /// The floors of the home, each with its own map, and the floor that the robot is on; without a command, list them.
    Floor(FloorJob),
    /// Clean rooms, zones and spots; the whole home when none is named.
    Clean(OrderOptions),
    /// Estimate the time and energy of such a job.
    Estimate(EstimateOptions),
    /// The rooms of the home, their names, and how they are split and joined.
    #[command(visible_alias = "room")]
    Rooms(RoomsJob),
    /// Zones and spots that are saved under names.
    Places(PlacesJob),
    /// No-go zones and virtual walls.
    Zone(ZoneJob),
    /// What the robot starts by itself, and when; without a command, list it.
    Schedule(ScheduleJob),
    /// Past runs and their results; without a command, list them, newest first.
    History(HistoryJob),
    /// What all runs since the first one come to: hours, area, distance, ends and stops.
    Statistics(StatisticsOptions),
    /// Wear and dirt of parts, by the currents of their motors or by hours of work.
    Health(HealthJob),
    /// What robots have learnt about themselves; without a command, list it.
    Learnt(LearntJob),
    /// What the robot has decided recently, and why.
    Why(WhyOptions),
    /// Replay a recording through the brain.
    Replay(ReplayOptions),
    /// Measure the unknown figures of a robot's parts; without --port, list them.
    Calibrate(CalibrateOptions),
    /// Look at a robot's raw readings, or record its gyro module.
    Probe(ProbeJob),
    /// Drive by hand, with a gamepad or the keyboard.
    Drive(DriveOptions),
    /// The control mixes that are saved on the robot; without a command, list them.
    Mix(MixJob),
    /// Set this board up: find the robot, write the configuration, start the services, show the way in.
    Setup(SetupOptions),
    /// What helps or hinders the robot, a line each: for reports of faults.
    Doctor(DoctorOptions),
    /// Let a new device in: open a window and show its code.
    Pair(PairOptions),
    /// The paired devices; without a command, list them.
    Clients(ClientsJob),
    /// The robot's certificate: its fingerprint, and files for devices that are to trust it.
    Trust(TrustOptions),
    /// Back up, write, verify and restore the robot's firmware.
    Flash {
        #[command(flatten)]
        job: rvac_flash::FlashJob,
        /// Unix socket of vthal, which lends its line.
        #[arg(
            long,
            value_name = "PATH",
            env = "RVAC_SOCKET",
            default_value = "/run/vthal/vthal.sock",
            global = true
        )]
        socket: PathBuf,
    },
    /// Put a signed update of daemon, panel and firmware in use, or go back to what was there.
    Update {
        #[command(flatten)]
        job: rvac_update::UpdateJob,
        /// Unix socket of vthal.
        #[arg(
            long,
            value_name = "PATH",
            env = "RVAC_SOCKET",
            default_value = "/run/vthal/vthal.sock"
        )]
        socket: PathBuf,
    },
    /// Print what a shell needs to complete rvac's commands.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write the manual pages, for packages.
    #[command(hide = true)]
    Manual {
        /// Where to.
        folder: PathBuf,
    },
    /// Start cleaning.
    Start {
        /// Name of the strategy; the daemon's default when not given.
        #[arg(long)]
        strategy: Option<String>,
        #[command(flatten)]
        daemon: Daemon,
    },
    /// End the job and stop.
    Stop(Daemon),
    /// Stop and keep the job.
    Pause(Daemon),
    /// Continue the paused job.
    Resume(Daemon),
    /// Return to the dock.
    Dock(Daemon),
    /// Clean a small disc around the robot.
    Spot(Daemon),
    /// Drive to a place without cleaning, and stand there.
    Go {
        /// Where, metres in the map.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        place: Place,
        #[command(flatten)]
        daemon: Daemon,
    },
    /// Beep, so that you can find the robot.
    Locate(Daemon),
}

/// Where the daemon listens.
#[derive(Clone, Debug, Args)]
pub(crate) struct Daemon {
    /// Unix socket of vthal.
    #[arg(
        long,
        value_name = "PATH",
        env = "RVAC_SOCKET",
        default_value = "/run/vthal/vthal.sock",
        global = true
    )]
    pub(crate) socket: PathBuf,
    /// A robot on the network that this computer is paired with (rvac pair --robot), in place of --socket.
    #[arg(long, value_name = "https://NAME[:PORT]", env = "RVAC_ROBOT", global = true)]
    pub(crate) robot: Option<Address>,
}

#[derive(Debug, Args)]
pub(crate) struct TermOptions {
    /// Serial device or pseudo-terminal of the robot.
    #[arg(
        long,
        value_name = "PATH",
        conflicts_with_all = ["socket", "robot"],
        required_unless_present_any = ["socket", "robot"]
    )]
    pub(crate) port: Option<PathBuf>,
    /// Bits per second on the serial device.
    #[arg(long, default_value_t = 230_400, value_parser = clap::value_parser!(u32).range(300..=4_000_000))]
    pub(crate) baud: u32,
    /// Talk through the raw pass-through of the vthal that listens here (its configuration must allow it).
    #[arg(long, value_name = "PATH")]
    pub(crate) socket: Option<PathBuf>,
    /// The same on a robot that this computer is paired with as its administrator; somebody must be beside it to press a button.
    #[arg(long, value_name = "https://NAME[:PORT]", conflicts_with = "socket")]
    pub(crate) robot: Option<Address>,
    /// Send what is typed unchanged, without a CRC, as a serial terminal would.
    #[arg(long, conflicts_with_all = ["socket", "robot"])]
    pub(crate) hand: bool,
    /// Hide packets of this kind, for example `state`; may be given several times.
    #[arg(long, value_name = "WORD")]
    pub(crate) skip: Vec<String>,
    /// How long to show answers after the end of the input, in milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 1_000)]
    pub(crate) linger: u64,
}

#[derive(Debug, Args)]
pub(crate) struct PacketJob {
    #[command(subcommand)]
    pub(crate) verb: PacketVerb,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum PacketVerb {
    /// Print the packets with their CRC.
    #[command(alias = "seal")]
    Crc(PacketOptions),
    /// Check the CRC; exit code 1 if one is wrong.
    Check(PacketOptions),
    /// Explain the packets, or why they would be refused; exit code 1 if one is bad.
    Decode(PacketOptions),
}

#[derive(Debug, Args)]
pub(crate) struct PacketOptions {
    /// The packet; without it each line of the input is one (0x1F and 0x1E end a packet too).
    pub(crate) packet: Option<String>,
    /// Session number of the CRC; 0 = before any handshake.
    #[arg(long, default_value_t = 0)]
    pub(crate) session: u16,
    /// Direction of the packet.
    #[arg(long, value_enum, default_value_t = DirectionName::ToRobot)]
    pub(crate) direction: DirectionName,
    /// Packets are given as hexadecimal digits, as binary packets must be.
    #[arg(long)]
    pub(crate) hex: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DirectionName {
    /// Commands, host to robot.
    #[value(name = "to-robot", alias = ">")]
    ToRobot,
    /// Reports, robot to host.
    #[value(name = "from-robot", alias = "<")]
    FromRobot,
}

#[derive(Debug, Args)]
pub(crate) struct StatusOptions {
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WatchOptions {
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON, one message a line.
    #[arg(long)]
    pub(crate) json: bool,
    /// End after this many lines.
    #[arg(long, value_name = "N")]
    pub(crate) lines: Option<u64>,
}

#[derive(Debug, Args)]
pub(crate) struct MapJob {
    #[command(subcommand)]
    pub(crate) verb: Option<MapVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON of the home.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Debug, clap::Subcommand)]
pub(crate) enum MapVerb {
    /// List the saved versions, newest first.
    List {
        /// Floor by number or name; the floor that the robot is on when not given.
        #[arg(long)]
        floor: Option<String>,
    },
    /// Restore a version: it becomes the newest, and the others stay.
    Restore {
        /// Number of the version, as `rvac map list` shows it.
        number: u64,
        /// Floor by number or name; the floor that the robot is on when not given.
        #[arg(long)]
        floor: Option<String>,
    },
    /// Set the place of a dock that was moved: by eye is enough, the robot measures it when it docks.
    Dock {
        /// Where the middle of a docked robot is.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        at: Place,
        /// A place that a docked robot faces, behind the dock.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        towards: Place,
    },
}

#[derive(Debug, Args)]
pub(crate) struct DriveOptions {
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Drive with gamepads alone, not with the keyboard of this terminal.
    #[arg(long, conflicts_with = "readings")]
    pub(crate) pad: bool,
    /// Read the values of inputs from standard input, one a line: `pad-0-axis-1 -0.5`, `pad-0 gone`.
    #[arg(long)]
    pub(crate) readings: bool,
    /// Drive by this mix of the robot; the standard one when not given.
    #[arg(long, value_name = "NAME", conflicts_with = "mix_file")]
    pub(crate) mix: Option<String>,
    /// Drive by the mix in this file.
    #[arg(long, value_name = "PATH")]
    pub(crate) mix_file: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct MixJob {
    #[command(subcommand)]
    pub(crate) verb: Option<MixVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum MixVerb {
    /// Print a mix as a file for `save`.
    Show {
        /// Name of the mix; the standard one when not given.
        name: Option<String>,
    },
    /// Save the mix of a file on the robot; it replaces one with the same name.
    Save {
        /// The file.
        file: PathBuf,
    },
    /// Remove a mix from the robot.
    Remove {
        /// Its name.
        name: String,
    },
}

#[derive(Debug, Args)]
pub(crate) struct WhyOptions {
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON, one decision a line.
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of decisions, the newest last.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) lines: usize,
    /// Print instead what the robot sensed in the last ten seconds and tried in the last half minute.
    #[arg(long, conflicts_with = "stop")]
    pub(crate) felt: bool,
    /// Print instead why the robot last stopped by itself, with what it sensed and tried before.
    #[arg(long)]
    pub(crate) stop: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ReplayOptions {
    /// Recording (MCAP).
    pub(crate) file: PathBuf,
    /// The `vthal` executable; by default the one beside this program, else the one in the PATH.
    #[arg(long, value_name = "PATH")]
    pub(crate) vthal: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CalibrateOptions {
    /// Values to measure; by default all that the file lacks.
    pub(crate) names: Vec<String>,
    /// Serial device of the robot; vthal must not run.
    #[arg(long, value_name = "PATH")]
    pub(crate) port: Option<PathBuf>,
    /// Bits per second.
    #[arg(long, default_value_t = 230_400, value_parser = clap::value_parser!(u32).range(300..=4_000_000))]
    pub(crate) baud: u32,
    /// File of the measured values.
    #[arg(long, value_name = "PATH", default_value = "calibration.toml")]
    pub(crate) file: PathBuf,
    /// Robot whose values are listed when none is connected.
    #[arg(long, default_value = "sr8730")]
    pub(crate) robot: String,
}

#[derive(Debug, Args)]
pub(crate) struct ProbeJob {
    #[command(subcommand)]
    pub(crate) target: ProbeWhat,
    /// Serial device of the robot; vthal must not run.
    #[arg(long, value_name = "PATH", global = true)]
    pub(crate) port: Option<PathBuf>,
    /// Bits per second.
    #[arg(long, default_value_t = 230_400, global = true, value_parser = clap::value_parser!(u32).range(300..=4_000_000))]
    pub(crate) baud: u32,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum ProbeWhat {
    /// Counts of the converter, channel by channel.
    Analog,
    /// Totals of the wheel encoders.
    Encoders,
    /// Levels of all digital lines, port by port.
    Lines,
    /// The line of the buttons.
    Buttons,
    /// Find the gyro module, record it at rest and in both turns, and look for its frames.
    Gyro {
        /// Where the recorded bytes go.
        #[arg(long, value_name = "PATH", default_value = "gyro.bin")]
        file: PathBuf,
    },
}
