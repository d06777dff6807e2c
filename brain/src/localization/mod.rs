//! Where the robot believes to be.
//!
//! Frames follow REP-105: *odom* is smooth and drifts, *map* is right on average and may jump; `pose = map_from_odom *
//! odom_from_base`. Odometry makes the second factor. In a map that is known, a [`tracker`] with a particle filter corrects
//! the first one, learns what is wrong with the gyro, notices when the robot is lost and finds it again. Without a known map
//! radio [`beacons`] do, where there are such.

mod beacons;
mod calibration;
mod candidates;
mod confidence;
mod drift;
mod global_localizer;
mod gyro_estimate;
#[cfg(test)]
mod known_home;
#[cfg(test)]
mod known_storeys;
mod line_slam;
mod localizer;
mod map_correction;
mod odometry;
mod particles;
mod reference_map;
mod reverse_budget;
mod rssi_fingerprint;
mod scan_history;
mod skyline;
mod standstill;
mod stationary;
mod storey_finder;
mod totals;
mod tracker;
mod tracking_checkpoint;

pub use localizer::Localization;
pub use map_correction::MapCorrection;
pub use storey_finder::{StoreyFinder, StoreyFinding, StoreyPose};
pub use tracking_checkpoint::TrackingCheckpoint;
