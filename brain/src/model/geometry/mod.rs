//! Plane geometry: points, angles, rigid transforms.
//!
//! Sines and cosines come from a portable implementation, so that a recording from the robot replays bit-identically on any other
//! machine.

mod angle;
mod pose2;

pub use angle::{TurnSide, normalize_rad};
pub use pose2::{Point2, Pose2};
