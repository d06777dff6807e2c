//! What the brain must know of a simulated robot's sensors: the wire tells only how many there are.

use brain::{BumperLayout, Point2, Pose2, ProximityLayout, ProximityResponse, SensorLayout};
use home::RobotModel;

/// The sensors of a robot as the brain knows them.
#[must_use]
pub fn sensor_layout(model: &RobotModel) -> SensorLayout {
    let proximity = model.proximity.as_ref().map(|part| {
        let poses: Vec<Pose2> = part
            .headings_rad
            .iter()
            .map(|&heading_rad| {
                let outward = Pose2 {
                    heading_rad,
                    ..Pose2::IDENTITY
                };
                let place = outward.transform(Point2 {
                    x_m: part.mount_radius_m,
                    y_m: 0.0,
                });
                Pose2 {
                    x_m: place.x_m,
                    y_m: place.y_m,
                    heading_rad,
                }
            })
            .collect();
        let response = ProximityResponse {
            range_m: part.range_m,
            half_angle_rad: part.half_angle_rad,
            half_level_m: part.half_level_m,
            skin_m: model.body.radius_m - part.mount_radius_m,
        };
        ProximityLayout::new(&poses, response)
    });
    let nothing = SensorLayout::default();
    let place = |index: usize| {
        model.cliffs.get(index).map(|mount| Point2 {
            x_m: mount.x_m,
            y_m: mount.y_m,
        })
    };
    let cliffs = match (place(0), place(1), place(2)) {
        (Some(left), Some(middle), Some(right)) => Some([left, middle, right]),
        _ => None,
    };
    SensorLayout {
        proximity: proximity.unwrap_or(nothing.proximity),
        bumper: BumperLayout {
            half_arc_rad: model.bumper.half_arc_rad,
            overlap_rad: model.bumper.overlap_rad,
        },
        cliffs,
    }
}
