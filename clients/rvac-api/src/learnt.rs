//! What robots have learnt of themselves, as it is kept between runs.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// What is kept of a robot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LearntView {
    /// Its name, as in [`crate::RobotDescription::device`].
    pub device: String,
    /// It is the one that is attached.
    #[serde(default)]
    pub here: bool,
    /// Absent while nothing worth keeping is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gyro: Option<GyroLearnt>,
    /// Absent while the figures of the data sheet are used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyLearnt>,
    /// When it learnt that last, seconds since 1970; absent if its clock was not set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub learnt_s: Option<i64>,
}

/// What is wrong with its gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GyroLearnt {
    /// Error of its scale, relative: at 0.01 it counts 1 % too little.
    pub scale: f64,
    /// Standard deviation of that.
    pub scale_sigma: f64,
    /// Its bias, rad/s.
    pub bias_rad_per_s: f64,
}

/// What driving takes from its pack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyLearnt {
    /// Share of a full charge that an hour of cleaning takes.
    pub cleaning_per_h: f64,
    /// Share of a full charge that an hour of driving takes.
    pub driving_per_h: f64,
    /// Seconds from which that was learnt.
    pub seen_s: f64,
}

/// A part of what was learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LearntPart {
    /// What is wrong with the gyro.
    Gyro,
    /// What driving takes from the pack.
    Energy,
}
