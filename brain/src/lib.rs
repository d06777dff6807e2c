//! Pure thinking: it takes what the robot perceived and what people asked, and says what the robot should do.
//!
//! No I/O, no clock, no randomness of its own: time comes with each [`observation::Observation`], the seed with
//! [`Brain::new`]. The same calls give the same decisions, bit for bit, which is what replay rests on.
#![forbid(unsafe_code)]

pub mod behavior;
mod brain;
pub mod coverage;
mod docking;
pub mod localization;
pub mod mapping;
mod model;
mod navigation;
mod recovery;
mod travel;

pub use behavior::{BehaviorState, JobCheckpoint, JobFigures, JobKind, Status};
pub use brain::checkpoint::{Checkpoint, CheckpointWork};
pub use brain::estimating::EstimateWork;
pub use brain::{Brain, PlannedPath, checkpoint};
pub use coverage::{JobEstimate, OrderRefusal};
pub use localization::{StoreyFinder, StoreyFinding, StoreyPose, TrackingCheckpoint};
pub use mapping::{
    CELL_M, Cell, CellKnowledge, CellPasses, DistanceField, Hazard, HazardKind, Keyframe, LoadedHome, Map,
    MapCursor, MapLoader, MapPart, MapWriter, NextNumbers, PathPoint, Raster, StoredMap, StoredMapError,
    SurfaceKind, SweptRun,
};
pub use model::action::{Actions, Motion};
pub use model::advance::Advance;
pub use model::command::{Command, JobCommand, StrategyName};
pub use model::config::{
    Body, BrainConfig, BumperLayout, ProximityLayout, ProximityResponse, SensorLayout, Speeds,
};
pub use model::cut_line::CutLine;
pub use model::decision::{Decision, DecisionCause, DecisionKind};
pub use model::edit_error::EditError;
pub use model::energy::EnergyModel;
pub use model::fault::Fault;
pub use model::geometry::{Point2, Pose2};
pub use model::gyro_fault::GyroFault;
pub use model::inhibit::{Inhibit, Inhibits};
pub use model::job_refusal::JobRefusal;
pub use model::kept_place::{KeptPlace, PlaceShape};
pub use model::known_beacon::{KNOWN_BEACONS_MAX, KnownBeacon};
pub use model::learnt::{GyroLearnt, Learnt, LearntPart};
pub use model::link_fault::LinkFault;
pub use model::map_doubt::MapDoubt;
pub use model::map_edit::{MapEdit, NoGoEdit, PlaceEdit, RoomEdit};
pub use model::map_trial::MapTrial;
pub use model::no_go::{NoGo, NoGoShape, RoomName};
pub use model::observation::Observation;
pub use model::onsets::{DockOnset, Onsets};
pub use model::order::{CleaningOrder, HomePart, SPOT_RADIUS_M};
pub use model::pose_estimate::PoseEstimate;
pub use model::reason::Reason;
pub use model::room_settings::{Pattern, RoomPower, RoomSettings};
pub use model::swept_share::SweptShare;
pub use model::zone::Zone;
pub use model::{
    action, command, config, energy, geometry, learnt, no_go, observation, order, room_settings, zone,
};
