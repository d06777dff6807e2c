//! Getting from place to place: where the body can be, the way there, and the movements that take the robot along it.
//!
//! What to drive for is the business of the tasks in the layers above. The movements are short and bounded: each ends by its own
//! measure of way or turn, or by time.

mod bucket_queue;
pub(crate) mod caution;
pub(crate) mod configuration_space;
mod contour_trace;
mod evasion;
mod goal_path;
pub(crate) mod heading;
mod inflation;
pub(crate) mod lane_frame;
mod leg;
mod obstructions;
mod path_follower;
pub(crate) mod router;
mod sequence;
mod situation;
pub(crate) mod smoothing;
mod task;
mod wall_follower;

pub(crate) use caution::caution;
pub(crate) use contour_trace::EdgeTrace;
pub(crate) use evasion::{Evasion, EvasionStep};
pub(crate) use goal_path::{Goal, plan_way};
pub(crate) use inflation::{Disc, reachable};
pub(crate) use leg::{BACK_AT_CLIFF_M_PER_S, BackOff, Leg, Turn};
pub(crate) use obstructions::{Obstructions, encounter};
pub(crate) use path_follower::{FollowStep, Follower};
pub(crate) use sequence::{Part, Sequence};
pub(crate) use situation::Situation;
pub use smoothing::Piece;
pub(crate) use task::{Mind, Plan, Task};
pub(crate) use wall_follower::{WallFollower, WallStep};
