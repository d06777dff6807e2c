//! What the shell must perform.

use brain::{Actions, Command, MapTrial, Observation, RoomName, StoredMap};
use rvac_api::{
    CalibrationAnswer, DeviceTable, LogEntry, Pose, RobotDescription, RunRecord, Status, Topic, Update,
};

use crate::Checkpoint;
use crate::ClientId;
use crate::health::StoredHealth;
use crate::learnt::StoredLearnings;
use crate::schedule::StoredBook;

/// Collected results of [`crate::Core::handle`]. The shell empties it after each call; keeping the value keeps its buffers.
#[derive(Debug, Default)]
pub struct Outputs {
    /// Bytes for the robot, in order.
    pub link: Vec<u8>,
    /// No robot answers: the line is to be opened again at the next rate of the make.
    pub next_rate: bool,
    /// From now on the serial line is the daemon's or a client's.
    pub line_holder: Option<LineHolder>,
    /// Updates for clients, in order.
    pub deliveries: Vec<Delivery>,
    /// Lines of the log. Followers of [`Topic::Log`] get them as deliveries besides.
    pub log: Vec<LogEntry>,
    /// Records of the running run; empty unless [`crate::Recording::On`].
    pub records: Vec<Record>,
    /// The newest state worth surviving a crash; replaces an older one that is not yet written.
    pub checkpoint: Option<Checkpoint>,
    /// The home after a run, worth keeping for the next start.
    pub home: Option<FloorHome>,
    /// What the procedure of a calibration is told, in order.
    pub calibration_orders: Vec<CalibrationOrder>,
    /// What clients ask of the kept maps, in order.
    pub map_orders: Vec<MapOrder>,
    /// The floor whose newest map the robot doubts from now on.
    pub doubted_floor: Option<u16>,
    /// Maps that clients have changed, in order.
    pub map_edits: Vec<EditedMap>,
    /// Orders of clients about floors, in order.
    pub floor_orders: Vec<FloorOrder>,
    /// What clients ask of archives of floors, in order.
    pub archive_orders: Vec<ArchiveOrder>,
    /// What clients ask of the kept control mixes, in order.
    pub mix_orders: Vec<MixOrder>,
    /// Schedules for the disk.
    pub schedules: Option<ScheduleOrder>,
    /// Loads of motors for the disk.
    pub health: Option<HealthOrder>,
    /// What robots have learnt of themselves, for the disk; replaces what was kept before.
    pub learnt: Option<LearntOrder>,
    /// A run that is over, for the disk. The shell reports the result with [`crate::Input::RunKept`]; until then no further
    /// one comes.
    pub run: Option<Box<RunRecord>>,
    /// What clients ask of the kept runs, in order.
    pub run_queries: Vec<RunQuery>,
}

/// Whose the serial line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineHolder {
    /// The daemon's, as usual.
    Daemon,
    /// A client's, which writes the robot's firmware: the daemon keeps away from the device.
    Client,
}

/// What the shell does for a client that calibrates the robot; it answers the client itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CalibrationOrder {
    /// Who asks.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// What.
    pub task: CalibrationTask,
}

/// See [`CalibrationOrder`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CalibrationTask {
    /// Tell what was measured of the robot of this name: [`Update::Calibration`].
    Show(Option<String>),
    /// Give the robot of this name to the procedure, for these values; none = all that are missing.
    Begin(String, Vec<String>),
    /// An answer to a page.
    Answer(u32, CalibrationAnswer),
    /// A person holds the motors on, or lets go.
    Hold(bool),
    /// Stop the motors, end the procedure, and give the robot back with [`crate::Input::CalibrationOver`].
    End,
}

/// Schedules that the shell keeps in place of the ones before, and says so with [`crate::Input::SchedulesKept`]. Until then no
/// further ones come.
#[derive(Clone, Debug, PartialEq)]
pub struct ScheduleOrder {
    /// Number of the order.
    pub number: u64,
    /// What is kept.
    pub book: StoredBook,
}

/// Loads of motors that the shell keeps in place of the ones before, and says so with [`crate::Input::HealthKept`].
#[derive(Clone, Debug, PartialEq)]
pub struct HealthOrder {
    /// Number of the order.
    pub number: u64,
    /// What is kept.
    pub health: StoredHealth,
}

/// What robots have learnt, which the shell keeps in place of what was before, and says so with [`crate::Input::LearntKept`].
#[derive(Clone, Debug, PartialEq)]
pub struct LearntOrder {
    /// Number of the order.
    pub number: u64,
    /// What is kept.
    pub learnt: StoredLearnings,
}

/// Something that a client asks of the kept runs; the shell answers the client itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunQuery {
    /// Who asks.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// What.
    pub task: RunTask,
}

/// See [`RunQuery`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunTask {
    /// Tell which there are, newest first: [`Update::Runs`].
    List {
        /// Only those with lower numbers.
        before: Option<u64>,
        /// At most so many.
        count: u8,
    },
    /// Tell what all runs come to: [`Update::Statistics`].
    Statistics,
    /// Tell all that is kept of one: [`Update::Run`].
    Show(u64),
    /// Send the summary of its recordings: [`Update::RunTrack`].
    Track {
        /// Number of the run.
        number: u64,
        /// Which of its recordings, from 0; `None` for all of them.
        recording: Option<u32>,
    },
    /// Give a piece of its recording: [`Update::RunFile`].
    File {
        /// Number of the run.
        number: u64,
        /// Which of its recordings, from 0; `None` for all of them as one.
        recording: Option<u32>,
        /// First byte.
        from: u64,
    },
}

/// Something that the shell does with the kept control mixes; it answers the client itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MixOrder {
    /// Who asks.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// What.
    pub task: MixTask,
}

/// See [`MixOrder`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MixTask {
    /// Tell the client which there are: [`Update::Mixes`].
    List,
    /// Keep a profile, which is not checked yet.
    Save {
        /// As JSON text.
        profile: String,
        /// What the client has seen under its name before, empty for nothing.
        was: Option<String>,
    },
    /// Remove the one with this name.
    Remove(String),
}

/// A map and the floor that it is of.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorHome {
    /// Number of the floor.
    pub floor: u16,
    /// What is known of it.
    pub home: StoredMap,
    /// What the run that leaves it has shown of the map with which it began.
    pub trial: Option<MapTrial>,
}

/// Something that the shell does with the floors that are kept: it says what they are then with
/// [`crate::Input::FloorsKept`], and answers the client itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FloorOrder {
    /// Who asks.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// What.
    pub task: FloorTask,
}

/// See [`FloorOrder`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FloorTask {
    /// Keep a new floor, of which nothing is known yet.
    New(Option<RoomName>),
    /// Name a floor, or take its name away.
    Name(u16, Option<RoomName>),
    /// Remove a floor; its maps stay on the disk.
    Remove(u16),
    /// Bring a removed floor back.
    Restore(u16),
}

/// Something that the shell does with archives of floors; it answers the client itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArchiveOrder {
    /// Who asks.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// What.
    pub task: ArchiveTask,
}

/// See [`ArchiveOrder`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ArchiveTask {
    /// Give a piece of an archive: [`Update::FloorArchive`].
    Export {
        /// The only floor in it; `None` = all that are not removed.
        floor: Option<u16>,
        /// First byte of the piece.
        from: u64,
    },
    /// Take a piece; after the last one the floors are kept, and come back as [`crate::Input::FloorsTakenIn`].
    Import {
        /// First byte of the piece.
        from: u64,
        /// Bytes of the whole archive.
        size: u64,
        /// The bytes in base 64.
        data: String,
    },
}

/// Something that the shell does with the kept maps of the home; it answers the client itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapOrder {
    /// Tell the client which versions there are: [`Update::Maps`].
    List {
        /// Who asks.
        client: ClientId,
        /// Number of the request.
        id: Option<u32>,
        /// Whose.
        floor: u16,
    },
    /// Make a version the newest one and give it back as [`crate::Input::MapRestored`].
    Restore {
        /// Who asks.
        client: ClientId,
        /// Number of the request.
        id: Option<u32>,
        /// Whose.
        floor: u16,
        /// Number of the version.
        number: u64,
    },
}

/// A map that a person has changed: the shell keeps it as the newest one and answers the client when it is on the disk.
#[derive(Clone, Debug, PartialEq)]
pub struct EditedMap {
    /// Who changed it.
    pub client: ClientId,
    /// Number of the request.
    pub id: Option<u32>,
    /// The map with the change.
    pub home: FloorHome,
}

impl Outputs {
    /// Empties everything and keeps the memory.
    pub fn clear(&mut self) {
        self.link.clear();
        self.next_rate = false;
        self.line_holder = None;
        self.deliveries.clear();
        self.log.clear();
        self.records.clear();
        self.checkpoint = None;
        self.home = None;
        self.calibration_orders.clear();
        self.map_orders.clear();
        self.doubted_floor = None;
        self.floor_orders.clear();
        self.archive_orders.clear();
        self.mix_orders.clear();
        self.map_edits.clear();
        self.schedules = None;
        self.health = None;
        self.learnt = None;
        self.run = None;
        self.run_queries.clear();
    }
}

/// An update and who gets it.
#[derive(Clone, Debug, PartialEq)]
pub struct Delivery {
    /// Who.
    pub to: Recipients,
    /// What.
    pub update: Update,
}

/// Who gets an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recipients {
    /// One client.
    One(ClientId),
    /// All clients that follow the topic now: [`crate::Core::followers`].
    Followers(Topic),
}

/// Direction of a packet on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Host to robot.
    ToRobot,
    /// Robot to host.
    FromRobot,
}

impl Direction {
    /// The character for it in the interface to clients and in the CRC.
    #[must_use]
    pub const fn symbol(self) -> char {
        match self {
            Self::ToRobot => '>',
            Self::FromRobot => '<',
        }
    }
}

/// One entry of a run's recording, in the order in which things happened. Commands and observations are all that the
/// brain perceives: given [`RunStart`] and these, it decides the same again.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// A run begins.
    RunStarted(Box<RunStart>),
    /// The brain was given a command.
    Command {
        /// Host time in microseconds.
        time_us: u64,
        /// What.
        command: Command,
    },
    /// The brain was given an observation.
    Observation(Observation),
    /// What the brain answered to the observation before it.
    Actions {
        /// Host time in microseconds.
        time_us: u64,
        /// What.
        actions: Actions,
    },
    /// A packet of the wire.
    Packet {
        /// Host time in microseconds.
        time_us: u64,
        /// The direction of the packet.
        direction: Direction,
        /// As text; binary ones are shown by their text twin.
        text: String,
    },
    /// The status changed.
    Status {
        /// Host time in microseconds.
        time_us: u64,
        /// To what.
        status: Status,
    },
    /// The robot's pose as the brain estimates it.
    Pose(Pose),
    /// A line of the log.
    Log(LogEntry),
    /// The device table.
    Device {
        /// Host time in microseconds.
        time_us: u64,
        /// It.
        table: Box<DeviceTable>,
    },
    /// The summary of the run for people, when its job is over. The newest one counts.
    RunSummary {
        /// Host time in microseconds.
        time_us: u64,
        /// The record, without its picture.
        run: Box<RunRecord>,
    },
    /// The run is over.
    RunEnded {
        /// Host time in microseconds.
        time_us: u64,
        /// Why.
        end: RunEnd,
    },
}

/// Where a run starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct RunStart {
    /// Host time in microseconds.
    pub time_us: u64,
    /// Number of the run since the daemon's start, from 1.
    pub run: u32,
    /// Why it begins.
    pub cause: RunCause,
    /// Seed of the brain for this run.
    pub seed: u64,
    /// Settings of the brain.
    pub brain: brain::BrainConfig,
    /// The state that the brain loads before its first step.
    pub checkpoint: brain::Checkpoint,
    /// Device, for example `sr8730`; empty while unknown.
    pub device: String,
    /// Firmware version; empty while unknown.
    pub firmware: String,
    /// How the robot has described itself.
    pub robot: RobotDescription,
}

/// Why a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunCause {
    /// A job was asked for.
    Job,
    /// A person took the stick.
    Manual,
    /// The daemon before this one was killed while a job ran.
    ResumedAfterRestart,
    /// The robot has found out on which floor it is.
    FloorFound,
}

impl RunCause {
    /// The name in logs and recordings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Job => "job",
            Self::Manual => "manual",
            Self::ResumedAfterRestart => "resumed-after-restart",
            Self::FloorFound => "floor-found",
        }
    }
}

/// Why a run is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// The brain is idle again, or has reached the dock.
    Finished,
    /// The daemon ends.
    Shutdown,
    /// Another robot was attached.
    OtherRobot,
}

impl RunEnd {
    /// The name in logs and recordings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Shutdown => "shutdown",
            Self::OtherRobot => "other-robot",
        }
    }
}
