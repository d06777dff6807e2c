//! Versioned plain types of the socket and WebSocket interface. They compile to wasm and do no I/O.
//!
//! On the Unix socket each message is one JSON object followed by the separator 0x1F, as on the wire to the robot (without
//! the CRC: the kernel does not corrupt). On the WebSocket each message is one text frame. Unknown keys are ignored;
//! unknown messages are answered with the error `unknown`.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

extern crate alloc;

mod activity;
mod calibration;
mod cleaning_power;
mod client_input;
mod device;
mod example;
mod floor;
mod health;
mod history;
mod home;
mod learnt;
mod matter;
mod name;
mod order;
mod reasons;
mod request;
mod role;
mod schedule;
mod short_number;
mod simulated;
mod software_update;
mod statistics;
mod stop;
mod system;
mod thought;
mod topic;
mod trouble;
mod update;
mod verb;

pub use activity::{Activity, ActivityWords};
pub use calibration::{CalibrationAnswer, CalibrationAsk, CalibrationPage, CalibrationValue};
pub use cleaning_power::CleaningPower;
pub use client_input::{ClientInput, INPUT_LEASE_MS_MAX, INPUTS_MAX, INPUTS_PER_CLIENT_MAX, is_mix_name};
pub use device::{BatteryReading, ChargerReading, DaemonLoad, DeviceTable, LinkReading};
pub use example::example_of;
pub use floor::{
    ARCHIVE_BYTES_MAX, ARCHIVE_PIECE_BYTES, ARCHIVE_UPLOAD_BYTES, FloorQuestion, FloorView, FloorsView,
};
pub use health::{ComponentHealth, PartCare, PartHours};
pub use history::{
    RUN_PIECE_BYTES, Run, RunAsker, RunJob, RunPicture, RunRecord, RunRecording, RunResult, RunStop,
    RunTrack, TrackPose, TrackReading,
};
pub use home::{CarpetView, DoorView, HomeView, KeptMap, RoomView, SurenessView, WallView};
pub use learnt::{EnergyLearnt, GyroLearnt, LearntPart, LearntView};
pub use matter::MatterInvitation;
pub use name::{NAME_CHARS_MAX, NameProblem, name_problem};
pub use order::{
    CleaningPattern, JobEstimate, JobOrder, JobPart, NoGoShape, NoGoView, PlaceShape, PlaceView, RoomBefore,
    RoomChangeView, RoomNaming, RoomSettings, RoomSplitting, SPOT_RADIUS_M,
};
pub use reasons::{Explanation, explain, explanations, remedy};
pub use request::{Request, RequestBody};
pub use role::{Role, UnknownRole};
pub use schedule::{
    InQuiet, PlannedRun, QuietHours, ScheduleDecision, ScheduleEntry, ScheduleTime, ScheduleView,
    ScheduledJob, Schedules, Weekday,
};
pub use short_number::short_number;
pub use simulated::{SimulatedPlan, SimulatedTruth};
pub use software_update::{SoftwareUpdate, UPDATE_BYTES_MAX, UpdateEnd, UpdateStage};
pub use statistics::Statistics;
pub use stop::{Evidence, EvidenceSample, Standstill};
pub use system::{DiskSpace, NetworkAddress, SystemReport};
pub use thought::{Decision, Estimate, MapDoubt, PlannedPath};
pub use topic::Topic;
pub use trouble::{Gravity, Trouble, TroubleWords};
pub use update::{
    BumpMark, Failure, Gesture, Lacking, LogEntry, LogLevel, MapDelta, MapSnapshot, Pose, Rle,
    RobotDescription, RoomHere, Status, Update, Versions,
};
pub use verb::{VERBS, role_for};

/// Version of this interface. Raised when a message changes its meaning; additions need no new version.
pub const API_VERSION: u32 = 1;

/// Byte that ends each message on the Unix socket.
pub const SEPARATOR: u8 = 0x1F;
