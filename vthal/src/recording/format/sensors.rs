//! The recorded form of the sensors' places.

use brain::{BumperLayout, Point2, Pose2, ProximityLayout, ProximityResponse, SensorLayout};
use serde::{Deserialize, Serialize};

/// [`SensorLayout`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SensorSettings {
    /// x, y and heading of each proximity sensor.
    proximity: Vec<[f64; 3]>,
    range_m: f64,
    half_angle_rad: f64,
    half_level_m: f64,
    skin_m: f64,
    /// Absent for sensors that report levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    near_m: Option<f64>,
    bumper_half_arc_rad: f64,
    bumper_overlap_rad: f64,
    /// Left, middle, right.
    cliffs: Option<[[f64; 2]; 3]>,
}

impl Default for SensorSettings {
    /// The meaning of recordings made before sensors had positions.
    fn default() -> Self {
        Self::from(&SensorLayout::default())
    }
}

impl From<&SensorLayout> for SensorSettings {
    fn from(layout: &SensorLayout) -> Self {
        let response = layout.proximity.response;
        Self {
            proximity: layout
                .proximity
                .sensors()
                .iter()
                .map(|pose| [pose.x_m, pose.y_m, pose.heading_rad])
                .collect(),
            range_m: response.range_m,
            half_angle_rad: response.half_angle_rad,
            half_level_m: response.half_level_m,
            skin_m: response.skin_m,
            near_m: response.near_m,
            bumper_half_arc_rad: layout.bumper.half_arc_rad,
            bumper_overlap_rad: layout.bumper.overlap_rad,
            cliffs: layout
                .cliffs
                .map(|places| places.map(|place| [place.x_m, place.y_m])),
        }
    }
}

impl SensorSettings {
    /// Back to the brain's own type.
    pub(super) fn to_brain(&self) -> SensorLayout {
        let poses: Vec<Pose2> = self
            .proximity
            .iter()
            .map(|&[x_m, y_m, heading_rad]| Pose2 {
                x_m,
                y_m,
                heading_rad,
            })
            .collect();
        let response = ProximityResponse {
            range_m: self.range_m,
            half_angle_rad: self.half_angle_rad,
            half_level_m: self.half_level_m,
            skin_m: self.skin_m,
            near_m: self.near_m,
        };
        SensorLayout {
            proximity: ProximityLayout::new(&poses, response),
            bumper: BumperLayout {
                half_arc_rad: self.bumper_half_arc_rad,
                overlap_rad: self.bumper_overlap_rad,
            },
            cliffs: self
                .cliffs
                .map(|places| places.map(|[x_m, y_m]| Point2 { x_m, y_m })),
        }
    }
}
