//! A robot description as it is in the file; `robots/README.md` is its reference.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::figure::{Figure, FigureList};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawModel {
    pub(super) name: String,
    pub(super) title: String,
    pub(super) body: RawBody,
    pub(super) drive: RawDrive,
    pub(super) wheel_motor: RawWheelMotor,
    pub(super) cleaners: RawCleaners,
    pub(super) bumper: RawBumper,
    pub(super) cliffs: RawPlaces,
    pub(super) wheel_drops: RawCount,
    pub(super) proximity: Option<RawProximity>,
    pub(super) gyro: Option<RawGyro>,
    pub(super) dock_receivers: Option<RawReceivers>,
    pub(super) battery: RawBattery,
    pub(super) buttons: RawCount,
    pub(super) lidar: Option<RawLidar>,
    /// Calibration values for the firmware; the world does not use them.
    #[serde(rename = "calibration")]
    pub(super) _calibration: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawBody {
    pub(super) radius: Figure,
    pub(super) swath: Figure,
    pub(super) climb: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawDrive {
    pub(super) track: Figure,
    #[serde(alias = "count-way")]
    pub(super) distance_per_count: Figure,
    pub(super) encoder_lines: Figure,
    pub(super) cruise: Figure,
    pub(super) speed_max: Figure,
    pub(super) turn_max: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawWheelMotor {
    pub(super) free_speed: Figure,
    pub(super) stall_force: Figure,
    pub(super) stall_current: Figure,
    pub(super) idle_current: Figure,
    pub(super) dead_band_brake: Figure,
    pub(super) dead_band_coast: Figure,
    pub(super) lag: Figure,
    pub(super) traction: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawCleaners {
    pub(super) main: Figure,
    pub(super) sides: Figure,
    pub(super) vacuum: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawBumper {
    pub(super) half_arc: Figure,
    pub(super) overlap: Figure,
    pub(super) travel: Figure,
    pub(super) switch: Figure,
    pub(super) force: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawPlaces {
    pub(super) x: FigureList,
    pub(super) y: FigureList,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawCount {
    pub(super) count: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawProximity {
    pub(super) headings: FigureList,
    pub(super) mount_radius: Figure,
    pub(super) range: Figure,
    pub(super) half_angle: Figure,
    pub(super) half_level: Figure,
    pub(super) near: Option<Figure>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawGyro {
    pub(super) resolution: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawReceivers {
    pub(super) headings: FigureList,
    pub(super) half_angle: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawBattery {
    pub(super) cells: Figure,
    pub(super) capacity: Figure,
    pub(super) resistance: Figure,
    pub(super) electronics: Figure,
    pub(super) charge: Figure,
    pub(super) trickle: Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawLidar {
    pub(super) range: Figure,
    pub(super) beams: Figure,
    pub(super) turns: Figure,
    pub(super) noise: Figure,
}
