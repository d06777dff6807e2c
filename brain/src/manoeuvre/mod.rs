//! Short bounded movements that tasks are made of. Each ends by its own measure of way or turn, or by time.

mod evasion;
mod follow;
mod leg;
mod sequence;
mod wall_follow;

pub(crate) use evasion::{Evasion, EvasionStep};
pub(crate) use follow::{Caution, FollowStep, Follower};
pub(crate) use leg::{BACK_AT_CLIFF_M_PER_S, BackOff, Leg, Turn};
pub(crate) use sequence::{Part, Sequence};
pub(crate) use wall_follow::{WallFollower, WallStep};
