//! Localization: estimates the pose.
//!
//! Frames follow REP-105: *odom* is smooth and drifts, *map* is right on average and may jump; `pose = map_from_odom *
//! odom_from_base`. Odometry gives the second factor. One of three estimators corrects the first one: line SLAM ([`line_slam`]) in
//! a home that is not known yet, Monte Carlo localization ([`tracker`]) in a known map, or radio [`beacons`] where there are some.
//! Monte Carlo localization also calibrates the gyro, notices when the robot is lost, and finds it again. The [`localizer`]
//! combines them.

mod beacons;
mod calibration;
mod candidates;
mod confidence;
mod dead_reckoning;
mod drift;
mod floor_blocks;
mod global_localizer;
mod gyro_estimate;
mod gyro_monitor;
mod gyro_presence;
#[cfg(test)]
mod known_home;
#[cfg(test)]
mod known_storeys;
mod lift;
mod line_slam;
mod localizer;
mod lost_share;
#[cfg(test)]
mod many_runs;
mod map_check;
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

pub(crate) use beacons::BeaconEvent;
pub use localizer::Localization;
pub use map_correction::MapCorrection;
pub use storey_finder::{StoreyFinder, StoreyFinding, StoreyPose};
pub use tracking_checkpoint::TrackingCheckpoint;
