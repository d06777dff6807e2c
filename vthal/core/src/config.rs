//! Settings of the core.

use brain::SensorLayout;

use crate::lacking::CalibrationValue;
use brain::command::StrategyName;

use crate::Checkpoint;
use crate::device::{Make, cordlib};
use crate::floors::KeptFloor;
use crate::health::Health;
use crate::learnt::Learnings;
use crate::schedule::Book;

/// Settings of the core, fixed for its life.
#[derive(Clone, Debug)]
pub struct CoreConfig {
    /// Make of the robot at the other end of the line.
    pub make: Make,
    /// Seed of the brain; each run derives its own from it.
    pub seed: u64,
    /// Strategy when a request names none; `None` = what suits the robot.
    pub strategy: Option<StrategyName>,
    /// Whether clients may send raw packets.
    pub expert: ExpertAccess,
    /// Whether records are made.
    pub recording: Recording,
    /// Whether checkpoints are made.
    pub checkpoints: Checkpoints,
    /// Where the robot's sensors sit; the wire carries only their number.
    pub sensors: SensorLayout,
    /// What a person measures on the robot, as far as something is absent without it.
    pub calibration: Vec<CalibrationValue>,
    /// Longest job in seconds, after which the robot docks (S26).
    pub task_budget_s: u32,
    /// Version of the daemon, for clients and recordings.
    pub version: String,
    /// The floors of the home as they were kept. One is loaded when the robot is on its dock, or when it has found out
    /// while driving on which floor it is.
    pub floors: Vec<KeptFloor>,
    /// Where an interrupted run goes on.
    pub resume: Option<Checkpoint>,
    /// The schedules as they were kept.
    pub schedules: Book,
    /// Whether the newest decisions of theirs may be lost: then nothing that was due before the start is made up for.
    pub schedules_distrusted: bool,
    /// The loads of motors as they were kept.
    pub health: Health,
    /// What robots have learnt of themselves, as it was kept.
    pub learnt: Learnings,
    /// What was wrong with what was kept, one sentence each: the first lines of the log that clients see.
    pub complaints: Vec<String>,
    /// Number of the next run: higher than those of all that are kept.
    pub next_run: u64,
}

impl Default for CoreConfig {
    fn default() -> Self {
        Self {
            make: cordlib::MAKE,
            seed: 1,
            strategy: None,
            expert: ExpertAccess::Denied,
            recording: Recording::Off,
            checkpoints: Checkpoints::Off,
            sensors: SensorLayout::default(),
            calibration: Vec::new(),
            task_budget_s: 120 * 60,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            floors: Vec::new(),
            resume: None,
            schedules: Book::default(),
            schedules_distrusted: false,
            health: Health::default(),
            learnt: Learnings::default(),
            complaints: Vec::new(),
            next_run: 1,
        }
    }
}

/// Whether clients may send raw packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpertAccess {
    /// Refused with `expert-off`.
    Denied,
    /// Passed on, and logged.
    Allowed,
}

/// Whether [`crate::Outputs::records`] is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recording {
    /// No.
    Off,
    /// Yes, while a run lasts.
    On,
}

/// Whether [`crate::Outputs::checkpoint`] is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checkpoints {
    /// No: they would not be written, and each costs a pass over the map.
    Off,
    /// Yes, every second of a job while the map is small, less often when it is large.
    On,
}
