//! Pure thinking: it takes what the robot perceived and what people asked, and says what the robot should do.
//!
//! No I/O, no clock, no randomness of its own: time comes with each [`observation::Observation`], the seed with
//! [`Brain::new`]. The same calls give the same decisions, bit for bit, which is what replay rests on.
#![forbid(unsafe_code)]

pub mod action;
pub mod behavior;
mod brain;
pub mod checkpoint;
pub mod command;
pub mod config;
pub mod coverage;
mod docking;
pub mod energy;
pub mod geometry;
mod gradual;
mod kept_place;
pub mod learnt;
pub mod localization;
mod manoeuvre;
pub mod mapping;
pub mod no_go;
pub mod observation;
pub mod order;
mod random;
mod recovery;
pub mod room_settings;
mod spot;
mod task;

pub use action::{Actions, Motion};
pub use behavior::{BehaviorState, JobFigures, JobKind, Reason, Status};
pub use brain::Brain;
pub use checkpoint::{Checkpoint, CheckpointWork, JobCheckpoint, TrackingCheckpoint};
pub use command::{Command, StrategyName};
pub use config::{Body, BrainConfig, BumperLayout, ProximityLayout, ProximityResponse, SensorLayout, Speeds};
pub use coverage::{JobEstimate, SweptShare};
pub use energy::EnergyModel;
pub use geometry::{Point2, Pose2};
pub use kept_place::{KeptPlace, PlaceShape};
pub use learnt::{GyroLearnt, Learnt, LearntPart};
pub use localization::{Finding, FloorFinder, FloorPlace, PoseEstimate};
pub use mapping::{
    CELL_M, Cell, CellKnowledge, DistanceField, FloorKind, Keyframe, Map, MapCursor, MapPart, Mark, MarkKind,
    PathPoint, Raster, ReadyHome, StoredMap, StoredMapError, Sweeping, SweptRun, TakingUp,
};
pub use no_go::{NoGo, NoGoShape, RoomName};
pub use observation::Observation;
pub use order::{CleaningOrder, HomePart, Zone};
pub use room_settings::{Pattern, RoomPower, RoomSettings};
pub use spot::DISC_M as SPOT_RADIUS_M;
