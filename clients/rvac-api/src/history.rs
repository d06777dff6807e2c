//! Runs of the robot that are over: what was ordered, how it ended, and why the robot stopped during it.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{BumpMark, Evidence, HomeView, Pose, RoomHere};

/// Piece of a recording that [`crate::RequestBody::RunFile`] gives at once, in bytes before they are spelled in base 64.
pub const RUN_PIECE_BYTES: u64 = 48 << 10;

/// A run that is over, as a list shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Its number; later runs have higher ones.
    pub number: u64,
    /// What was asked for.
    pub job: RunJob,
    /// Who asked.
    pub by: RunAsker,
    /// When it began, seconds since 1970; absent while nobody had set the clock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_s: Option<i64>,
    /// When it ended, seconds since 1970; absent if the clock was not set, or the run was cut short.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_s: Option<i64>,
    /// The clock was set by so many seconds during the run, back if negative: both times are by the clock as it was set last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_set_s: Option<i64>,
    /// From the order to the end, pauses included, seconds.
    pub duration_s: f64,
    /// Seconds of it in motion.
    pub moving_s: f64,
    /// Floor that it swept, square metres, by the robot's own estimate.
    pub swept_m2: f64,
    /// The same as a share of the floor that it was to sweep, 0..1; absent where the map does not contain that floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Distance driven, metres.
    pub path_m: f64,
    /// Bumps.
    pub bumps: u32,
    /// Charge of the battery at the start, 0..1, where it is measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub charge_start: Option<f64>,
    /// Charge of the battery at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub charge_end: Option<f64>,
    /// What came of it.
    pub result: RunResult,
    /// Named reason of the result.
    pub reason: String,
    /// Result and reason as a sentence for people.
    pub text: String,
    /// Number of times that it stopped or waited.
    pub stop_count: u32,
    /// The floor on which it was, as in [`crate::FloorView`]; absent where the robot did not know.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<u16>,
    /// Version of that floor's map that was kept when it ended, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<u64>,
    /// Its recordings: one, none if recording is off, or more if the daemon restarted during the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub recordings: Vec<RunRecording>,
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunJob {
    /// To clean.
    Clean {
        /// Strategy by name.
        strategy: String,
        /// Rooms that were named; with no zones and spots either, the whole home.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        rooms: Vec<RoomHere>,
        /// How many zones were given.
        #[serde(default)]
        zones: u32,
        /// How many spots were given.
        #[serde(default, skip_serializing_if = "is_none")]
        spots: u32,
        /// How often each part.
        passes: u8,
    },
    /// To clean a small disc.
    Spot,
    /// To go to a place.
    GoTo,
    /// To go to the dock.
    Dock,
}

fn is_none(count: &u32) -> bool {
    *count == 0
}

/// Who asked for a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunAsker {
    /// A client, by its name.
    Client(String),
    /// A button on the robot.
    Button,
    /// A schedule.
    Schedule {
        /// Its number.
        number: u32,
        /// Its name at that time.
        name: String,
    },
    /// The robot by itself, for example because it had slipped off its dock.
    Robot,
}

/// What came of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunResult {
    /// It did what it was asked for.
    Finished,
    /// Somebody ended it.
    Stopped,
    /// The robot could not go on.
    GaveUp,
    /// The daemon was ended in good order meanwhile.
    DaemonEnded,
    /// The daemon or its board failed. The record holds the last saved state.
    CutShort,
    /// Another robot was attached.
    OtherRobot,
}

impl RunResult {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Finished,
        Self::Stopped,
        Self::GaveUp,
        Self::DaemonEnded,
        Self::CutShort,
        Self::OtherRobot,
    ];

    /// As it stands in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Stopped => "stopped",
            Self::GaveUp => "gave-up",
            Self::DaemonEnded => "daemon-ended",
            Self::CutShort => "cut-short",
            Self::OtherRobot => "other-robot",
        }
    }
}

/// A recording of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecording {
    /// Its file name.
    pub name: String,
    /// Time of the recording, in seconds of the daemon's clock, at which the run began; below 0 if that was before the daemon.
    pub zero_s: f64,
    /// Its size in bytes; absent when it was removed because newer ones took its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
}

/// All that is kept of a run besides its recordings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// The run.
    pub run: Run,
    /// Where it stopped or waited, in order.
    pub stops: Vec<RunStop>,
    /// What it drew; absent while it goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<RunPicture>,
}

/// The robot stopped or waited.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunStop {
    /// Seconds since the run began.
    pub at_s: f64,
    /// For how long, seconds; absent when it was the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lasted_s: Option<f64>,
    /// State, as in [`crate::Status::state`], or `daemon-ended` while no daemon ran.
    pub state: String,
    /// Named reason.
    pub reason: String,
    /// The same as a sentence for people.
    pub text: String,
    /// What to do about it; absent when there is nothing to do, and in older records.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub remedy: String,
    /// Who asked for it, if somebody did, in English words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// The same for programs; absent in older records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asker: Option<RunAsker>,
    /// Where; its time is that of the daemon's clock.
    pub place: Pose,
    /// What the sensors reported and the robot tried before, unless a person stopped it.
    #[serde(flatten)]
    pub evidence: Evidence,
}

/// What a run drew, in the frame of the map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunPicture {
    /// Metres per cell of `swept_rows`.
    pub cell_m: f64,
    /// Swept cells in rows: `[x0,y0,length0,x1,y1,length1,...]`.
    pub swept_rows: Vec<i32>,
    /// Path as `[x0,y0,x1,y1,...]` in millimetres, simplified to within some centimetres.
    pub path_mm: Vec<i32>,
    /// Bumps.
    pub bumps: Vec<BumpMark>,
    /// The home as the robot knew it at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub home: Option<HomeView>,
}

/// A summary of a run's recordings for a replay: thinned, so that it stays below a megabyte. Times are seconds
/// since the run began.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunTrack {
    /// Number of the run.
    pub number: u64,
    /// Which of its recordings, from 0; absent = all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recording: Option<u32>,
    /// Start times of the recordings in it, in order. On either side of one the daemon ran anew, or the robot was in
    /// another map.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub begins_s: Vec<f32>,
    /// Poses, at most two a second.
    pub poses: Vec<TrackPose>,
    /// Readings, at most one a second.
    pub readings: Vec<TrackReading>,
    /// A recording ends in the middle, as after a crash.
    pub truncated: bool,
}

/// An estimated pose: time in seconds, x and y in metres, heading in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackPose(pub f32, pub f32, pub f32, pub f32);

/// What was measured at a time. What was not is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackReading {
    /// Time, seconds.
    pub t: f32,
    /// Charge of the battery, 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub charge: Option<f32>,
    /// Current into the pack, amperes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub battery_a: Option<f32>,
    /// Motor currents in amperes: left wheel, right wheel, main brush.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motors_a: Option<[f32; 3]>,
    /// Share of bad packets on the link, 0..1.
    pub bad_share: f32,
}
