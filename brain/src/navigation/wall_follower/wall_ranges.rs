//! What the proximity sensors show of a wall on the right and of obstacles ahead.

use core::f64::consts::FRAC_PI_2;

use crate::model::geometry::Point2;
use crate::navigation::Situation;

/// Lower levels are noise.
const LEVEL_MIN: f64 = 0.045;
/// A sensor faces sideways when its direction is nearer to the right than this, radians.
const SIDE_RAD: f64 = 0.4;
/// A sensor between this and the side sees the wall before the robot passes it, radians from the right.
const DIAGONAL_RAD: f64 = 0.8;
/// Largest angle of a wall between the two hits; otherwise they are two objects.
const SLOPE_MAX_RAD: f64 = 0.6;
/// An obstacle that overlaps the robot's corridor by less than this is passed without a touch, metres.
const GRAZE_M: f64 = 0.008;

/// The distances of one reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WallRanges {
    /// Gap between the rim and the obstacle on the right, metres.
    pub(super) side_m: Option<f64>,
    /// Gap between the rim and the obstacle diagonally ahead on the right, metres.
    pub(super) diagonal_m: Option<f64>,
    /// Heading relative to the wall, radians; positive faces away from a wall on the right.
    pub(super) slope_rad: Option<f64>,
    /// Straight distance until a contact, metres.
    pub(super) ahead_m: Option<f64>,
}

impl WallRanges {
    pub(super) fn read(situation: &Situation<'_>) -> Self {
        let radius_m = situation.config.body.radius_m;
        let layout = &situation.config.sensors.proximity;
        let mut ranges = Self::default();
        let (mut side, mut diagonal) = (None, None);
        for (sensor, level) in layout.sensors().iter().zip(&situation.observation.proximity) {
            let level = f64::from(*level);
            let Some(distance_m) = layout.response.distance_m(level).filter(|_| level >= LEVEL_MIN) else {
                continue;
            };
            let hit = sensor.transform(Point2 {
                x_m: distance_m,
                y_m: 0.0,
            });
            let gap_m = (libm::sqrt(hit.x_m * hit.x_m + hit.y_m * hit.y_m) - radius_m).max(0.0);
            let from_right_rad = sensor.heading_rad + FRAC_PI_2;
            if from_right_rad.abs() < SIDE_RAD {
                ranges.side_m = Some(gap_m);
                side = Some(hit);
            } else if (0.0..DIAGONAL_RAD).contains(&from_right_rad) {
                ranges.diagonal_m = Some(gap_m);
                diagonal = Some(hit);
            }
            if let Some(clear_m) = distance_to_contact_m(hit, radius_m) {
                ranges.ahead_m = Some(ranges.ahead_m.map_or(clear_m, |least: f64| least.min(clear_m)));
            }
        }
        if let (Some(side), Some(diagonal)) = (side, diagonal) {
            let slope_rad = -libm::atan2(diagonal.y_m - side.y_m, diagonal.x_m - side.x_m);
            ranges.slope_rad = Some(slope_rad).filter(|slope_rad| slope_rad.abs() < SLOPE_MAX_RAD);
        }
        ranges
    }
}

/// Straight distance until the rim touches a point; `None` when it passes beside the point.
fn distance_to_contact_m(point: Point2, radius_m: f64) -> Option<f64> {
    let half_m = radius_m - GRAZE_M;
    (point.x_m > 0.0 && point.y_m.abs() < half_m)
        .then(|| (point.x_m - libm::sqrt(radius_m * radius_m - point.y_m * point.y_m)).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::distance_to_contact_m;
    use crate::model::geometry::Point2;

    #[test]
    fn the_clearance_ends_where_the_rim_touches() {
        let ahead = Point2 { x_m: 0.3, y_m: 0.0 };
        assert!((distance_to_contact_m(ahead, 0.175).unwrap() - 0.125).abs() < 1e-9);
        let beside = Point2 { x_m: 0.1, y_m: -0.2 };
        assert_eq!(distance_to_contact_m(beside, 0.175), None);
        let behind = Point2 { x_m: -0.2, y_m: 0.0 };
        assert_eq!(distance_to_contact_m(behind, 0.175), None);
    }
}
