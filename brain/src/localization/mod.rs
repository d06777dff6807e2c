//! Where the robot believes to be.
//!
//! Frames follow REP-105: *odom* is smooth and drifts, *map* is right on average and may jump; `pose = map_from_odom *
//! odom_from_base`. Odometry makes the second factor. In a map that is known, a [`tracker`] with a particle filter corrects
//! the first one, learns what is wrong with the gyro, notices when the robot is lost and finds it again. Without a known map
//! radio [`beacons`] do, where there are such.

mod beacons;
mod calibration;
mod confidence;
mod drift;
mod floors;
mod gyro_belief;
#[cfg(test)]
mod known_floors;
#[cfg(test)]
mod known_home;
mod localizer;
mod map_correction;
mod odometry;
mod particles;
mod places;
mod rest;
mod retreat;
mod search;
mod skyline;
mod stand;
mod strengths;
mod survey;
mod terrain;
mod totals;
mod tracker;
mod tracking_checkpoint;
mod trail;

pub use floors::{Finding, FloorFinder, FloorPlace};
pub use localizer::Localization;
pub use map_correction::MapCorrection;
pub use tracking_checkpoint::TrackingCheckpoint;
