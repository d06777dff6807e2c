//! What the daemon sends to its clients.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{
    CalibrationPage, CalibrationValue, ClientInput, ComponentHealth, Decision, DeviceTable, Estimate,
    Evidence, FloorsView, HomeView, JobEstimate, KeptMap, LearntView, PlannedPath, Run, RunRecord, RunTrack,
    Schedules, SimulatedPlan, SimulatedTruth, SoftwareUpdate, Standstill, Statistics,
};

/// The closed set of updates; on the wire `{"e":"pose","x":0.1,...}` and so on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "e", rename_all = "kebab-case")]
pub enum Update {
    /// Answer to `hello`.
    Hello {
        /// Version of this interface.
        api: u32,
        /// Versions of the parts.
        versions: Versions,
        /// The robot, once known.
        #[serde(default)]
        robot: Option<RobotDescription>,
        /// Names of the strategies that can be started.
        strategies: Vec<String>,
        /// Whether raw packets are allowed.
        expert: bool,
    },
    /// A numbered request was done.
    Done {
        /// Its number.
        id: u32,
    },
    /// A request was refused. Without number when the request could not be read.
    Failed(Failure),
    /// What the robot is doing.
    Status(Status),
    /// The estimated pose.
    Pose(Pose),
    /// The device table.
    Device(DeviceTable),
    /// The whole map.
    Map(MapSnapshot),
    /// What changed in the map.
    MapDelta(MapDelta),
    /// What is known of the home.
    Home(HomeView),
    /// How sure the robot is.
    Estimate(Estimate),
    /// Where it means to drive. The wire says `way`.
    #[serde(rename = "way")]
    PlannedPath(PlannedPath),
    /// Something that it decided.
    Decision(Decision),
    /// The robot waits, or gave up, without having been ordered to.
    Standstill(Box<Standstill>),
    /// What the sensors have reported and the robot has tried up to now.
    Evidence {
        /// Number of the request.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<u32>,
        /// Up to the request.
        #[serde(flatten)]
        evidence: Evidence,
    },
    /// How the parts are.
    Health {
        /// Number of the request.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<u32>,
        /// All parts whose loads are measured or whose hours are counted.
        components: Vec<ComponentHealth>,
    },
    /// What robots have learnt of themselves.
    Learnt {
        /// Number of the request.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<u32>,
        /// The robots of which something is kept, the one that learnt last at the end.
        devices: Vec<LearntView>,
    },
    /// What was measured of the robot.
    Calibration {
        /// Name of the robot.
        device: String,
        /// All values, in the order in which they are best measured.
        values: Vec<CalibrationValue>,
        /// The file of the measured ones, as text: what its firmware is built with.
        file: String,
    },
    /// A step of a calibration, to the client that does it.
    CalibrationPage(Box<CalibrationPage>),
    /// The versions of the map of a floor that are kept.
    Maps {
        /// Number of the floor.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        floor: Option<u16>,
        /// Newest first.
        maps: Vec<KeptMap>,
    },
    /// The floors of the home, and on which of them the robot is.
    Floors(FloorsView),
    /// A piece of an archive of floors.
    FloorArchive {
        /// Its first byte.
        from: u64,
        /// Bytes of the whole archive.
        size: u64,
        /// Checksum of the whole archive: pieces with different ones do not belong together.
        check: u32,
        /// The bytes, at most [`crate::ARCHIVE_PIECE_BYTES`] of them, in base 64; none at the end.
        data: String,
    },
    /// The control mixes that are kept.
    Mixes {
        /// By their names, each as one line of JSON, see the crate `mixer`.
        mixes: Vec<String>,
    },
    /// All schedules.
    Schedules(Schedules),
    /// Runs that are over.
    Runs {
        /// Newest first.
        runs: Vec<Run>,
        /// There are older ones.
        more: bool,
    },
    /// A run that is over.
    Run(Box<RunRecord>),
    /// What all runs come to.
    Statistics(Box<Statistics>),
    /// A run is over, and what is kept of it is on the disk.
    RunKept(Box<Run>),
    /// The summary of a run's recordings.
    RunTrack(Box<RunTrack>),
    /// A piece of the recording of a run.
    RunFile {
        /// Number of the run.
        number: u64,
        /// Name of the file.
        name: String,
        /// Its first byte.
        from: u64,
        /// Bytes of the whole file; absent where several recordings become one file while it is read.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        size: Option<u64>,
        /// The bytes, at most [`crate::RUN_PIECE_BYTES`] of them, in base 64; none at the end of the file.
        data: String,
    },
    /// What a job will take.
    JobEstimate(JobEstimate),
    /// A line of the log.
    Log(LogEntry),
    /// A packet of the wire as text; binary ones are shown by their text twin.
    Packet {
        /// Host time, seconds since the daemon's start.
        t: f64,
        /// `>` to the robot, `<` from it.
        direction: char,
        /// The packet.
        text: String,
    },
    /// A person did something with the buttons on the robot.
    Button {
        /// What.
        gesture: Gesture,
        /// With which; of several the lowest.
        button: u8,
        /// Host time, seconds since the daemon's start.
        t: f64,
    },
    /// The inputs of control mixes that clients send now.
    Inputs {
        /// By their names.
        inputs: Vec<ClientInput>,
    },
    /// A device was paired with the robot. Said by the server of the panel to paired devices.
    NewDevice {
        /// What its owner calls it.
        name: String,
        /// What it may do: `view`, `drive` or `admin`.
        role: String,
        /// The address it came from, or `console`.
        from: String,
    },
    /// An update of the robot's software goes on or has ended. Said by the server of the panel to administrators.
    SoftwareUpdate(Box<SoftwareUpdate>),
    /// The server of the panel is there: once a second to whoever asked for it with the connection.
    Heartbeat {
        /// Since when nothing has come from the daemon, in ms; absent while there is no connection to it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        silent_ms: Option<u64>,
    },
    /// A piece of an update that is long, from the server of the panel to whoever asked for it with the connection. Short updates come
    /// between two pieces.
    Piece {
        /// Which of the updates that come in pieces at the same time.
        lane: u8,
        /// The update is whole with it.
        last: bool,
        /// The next part of its JSON.
        text: String,
    },
    /// Only with a simulated robot: the floor plan.
    SimulatedPlan(SimulatedPlan),
    /// Only with a simulated robot: where it really is.
    SimulatedTruth(SimulatedTruth),
}

/// What a person does with the buttons on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gesture {
    /// One was pressed for a moment and let go.
    Press,
    /// START is held for five seconds: a device shall be let in.
    PairingHold,
    /// START and DOCK are held for fifteen seconds, soon after the robot was switched on: all devices shall be forgotten.
    RecoveryHold,
}

/// Why a request was refused.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Number of the request, if it had one that could be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
    /// Named reason, for example `driver-busy`, `no-robot`, `wheel-drop`, `unknown-strategy`, `syntax`.
    pub reason: String,
    /// One sentence for people: what, where, what to do.
    pub text: String,
}

/// Versions of all parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct Versions {
    /// The daemon.
    pub vthal: String,
    /// The brain.
    pub brain: String,
    /// The robot's firmware, once known.
    #[serde(default)]
    pub firmware: Option<String>,
    /// cordlib in the firmware, once known.
    #[serde(default)]
    pub cordlib: Option<String>,
    /// Version of the wire in use, once known.
    #[serde(default)]
    pub protocol: Option<u8>,
}

/// What a client must know of the robot to draw and drive it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotDescription {
    /// Device, for example `sr8730`.
    pub device: String,
    /// Radius of the body in metres.
    pub radius_m: f64,
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Highest forward speed.
    pub speed_max_m_per_s: f64,
    /// Highest turn rate.
    pub turn_max_rad_per_s: f64,
    /// Number of proximity sensors.
    pub proximity: u8,
    /// Names of optional parts it has: `gyro`, `brush-main`, `brush-sides`, `vacuum`, `beeper`, `battery`, `currents`,
    /// `charger`, `dock` (receivers for the beams of a dock).
    pub parts: Vec<String>,
    /// Motors of which nothing notices that they are held fast: `wheels`, `brush-main`, `brush-sides`, `vacuum`. Robots of older
    /// firmware do not say.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unguarded: Vec<String>,
    /// Motors whose current is not measured though that of others is: their place in `currents_a` means nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unmeasured: Vec<String>,
    /// What the robot lacks because values of its own were never measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lacking: Vec<Lacking>,
}

/// An ability that the robot lacks until somebody measures what it needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lacking {
    /// `drive`, `cliffs`, `proximity`, `gyro`, `wheel-currents`, `charging` or `dock-beams`. Without the first two it may not move.
    pub ability: String,
    /// The values that it needs, as `rvac calibrate` calls them. At least one of them is not measured.
    pub values: Vec<String>,
}

/// What the robot is doing and why.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct Status {
    /// `disconnected`, `idle`, `starting`, `cleaning`, `spot`, `docking`, `docked`, `manual`, `paused`, `stuck`, `error`.
    pub state: String,
    /// Named reason of this state, for example `command`, `bump-left`, `wheel-drop`, `link-lost`.
    pub reason: String,
    /// Strategy of the running job.
    #[serde(default)]
    pub strategy: Option<String>,
    /// Names of what keeps the firmware from moving.
    pub inhibits: Vec<String>,
    /// Seconds of the running or last job.
    pub job_s: f64,
    /// Swept area of the running or last job in square metres, by the robot's own estimate.
    pub swept_m2: f64,
    /// Distance driven in the running or last job, metres.
    pub path_m: f64,
    /// Bumps of the running or last job.
    pub bumps: u32,
    /// Name of the client in the driver's seat.
    #[serde(default)]
    pub driver: Option<String>,
    /// The room in which the robot is, if home and pose are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room: Option<RoomHere>,
}

/// The room in which the robot is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct RoomHere {
    /// Identity as in [`RoomView`](crate::RoomView), from 1.
    pub id: u16,
    /// What people call it, if anybody has named it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl RoomHere {
    /// What to call it in a sentence.
    #[must_use]
    pub fn title(&self) -> String {
        self.name.clone().unwrap_or_else(|| format!("room {}", self.id))
    }
}

/// A pose in the map frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Radians, counter-clockwise, 0 along x.
    pub heading: f64,
    /// Host time in seconds since the daemon's start.
    pub t: f64,
}

/// Cells of a grid, row by row from the lowest y, as pairs of value and run length: `[v0,n0,v1,n1,...]`.
pub type Rle = Vec<u32>;

/// The whole map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapSnapshot {
    /// Counts the maps since the daemon's start: a delta belongs to the snapshot with the same number.
    pub map: u32,
    /// Metres per cell.
    pub cell_m: f64,
    /// Swept cells as a list `[ix0,iy0,ix1,iy1,...]` of integer cell coordinates (cell ix spans ix*cell_m to (ix+1)*cell_m).
    pub swept: Vec<i32>,
    /// How sure the robot was of its place when it swept them, as `[n0,s0,n1,s1,...]`: the first n0 cells with a standard deviation of
    /// s0 centimetres, and so on. Cells for which nothing is said were swept with a sure place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub swept_sigma: Vec<u32>,
    /// Path as `[x0,y0,x1,y1,...]` in millimetres, thinned to 2 cm.
    pub path_mm: Vec<i32>,
    /// Bumps.
    pub bumps: Vec<BumpMark>,
}

/// What was added to the map since the last delta.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapDelta {
    /// Number of the map.
    pub map: u32,
    /// Newly swept cells, as in [`MapSnapshot::swept`].
    pub swept: Vec<i32>,
    /// The same of these, as in [`MapSnapshot::swept_sigma`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub swept_sigma: Vec<u32>,
    /// Continuation of the path, as in [`MapSnapshot::path_mm`].
    pub path_mm: Vec<i32>,
    /// New bumps.
    pub bumps: Vec<BumpMark>,
}

/// A bump on the map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BumpMark {
    /// Place of contact in metres.
    pub x: f64,
    /// Place of contact in metres.
    pub y: f64,
    /// Contact, else cliff.
    pub contact: bool,
}

/// How grave a log entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LogLevel {
    /// For developers.
    Debug,
    /// Worth knowing.
    Info,
    /// Something is wrong, work goes on.
    Warn,
    /// Something is wrong and stops work.
    Error,
}

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogEntry {
    /// Rising number.
    pub number: u64,
    /// Seconds since the daemon's start.
    pub t: f64,
    /// How grave.
    pub level: LogLevel,
    /// Part that speaks: `vthal`, `brain`, `firmware`, `link`, `client`.
    pub part: String,
    /// What.
    pub text: String,
}
