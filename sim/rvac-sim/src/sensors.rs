//! Positions of a simulated robot's sensors for the brain: the wire reports only their numbers.

use brain::{BumperLayout, Point2, ProximityLayout, ProximityResponse, SensorLayout};
use home::RobotModel;

/// The sensors of a robot in the brain's types.
#[must_use]
pub fn sensor_layout(model: &RobotModel) -> SensorLayout {
    let proximity = model.proximity.as_ref().map(|part| {
        let response = ProximityResponse {
            range_m: part.range_m,
            half_angle_rad: part.half_angle_rad,
            half_level_m: part.half_level_m,
            skin_m: model.body.radius_m - part.mount_radius_m,
            near_m: part.near_m,
        };
        ProximityLayout::ring(&part.headings_rad, part.mount_radius_m, response)
    });
    let nothing = SensorLayout::default();
    let cliffs = SensorLayout::three_cliffs(model.cliffs.iter().map(|mount| Point2 {
        x_m: mount.x_m,
        y_m: mount.y_m,
    }));
    SensorLayout {
        proximity: proximity.unwrap_or(nothing.proximity),
        bumper: BumperLayout {
            half_arc_rad: model.bumper.half_arc_rad,
            overlap_rad: model.bumper.overlap_rad,
        },
        cliffs,
    }
}
