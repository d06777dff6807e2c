//! Navigation: where the body can be, the path to a goal, and the controllers and manoeuvres that follow it.
//!
//! The tasks in the layers above choose the goals. Manoeuvres are short and bounded: each ends by distance, turn or time.

mod arc_beside_edge;
mod bucket_queue;
pub(crate) mod caution;
pub(crate) mod configuration_space;
mod contour_trace;
mod evasion;
mod forbidden_ahead;
mod goal_path;
pub(crate) mod heading;
mod inflation;
pub(crate) mod lane_frame;
mod manoeuvre;
mod manoeuvre_sequence;
mod obstructions;
pub(crate) mod parameters;
mod path_follower;
pub(crate) mod router;
mod situation;
pub(crate) mod smoothing;
mod task;
mod turn_free;
mod wall_follower;

pub(crate) use caution::caution;
pub(crate) use contour_trace::ContourTrace;
pub(crate) use evasion::{Evasion, EvasionStep};
pub(crate) use forbidden_ahead::{enters_forbidden, turn_off_forbidden_rad};
pub(crate) use goal_path::{Goal, plan_path};
pub(crate) use inflation::{Disc, Inflation, reachable};
pub(crate) use manoeuvre::{BackOff, ManoeuvreStep, Turn};
pub(crate) use manoeuvre_sequence::{Manoeuvre, ManoeuvreSequence};
pub(crate) use obstructions::{Obstructions, encounter};
pub(crate) use path_follower::{FollowStep, PathFollower};
pub(crate) use situation::Situation;
pub use smoothing::PathSegment;
pub(crate) use task::{Task, TaskContext, TaskStatus};
pub(crate) use turn_free::{TurnFree, free_side, round_wheel_rad_per_s};
pub(crate) use wall_follower::{WallFollower, WallStep};
