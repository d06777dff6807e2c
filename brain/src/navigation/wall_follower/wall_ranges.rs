//! What the proximity sensors show of a wall on the right and of obstacles ahead.

use core::f64::consts::FRAC_PI_2;

use super::parameters::SENSING;
use crate::model::geometry::Point2;
use crate::navigation::Situation;
use crate::navigation::caution::distance_to_contact_m;

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
            let Some(distance_m) = layout
                .response
                .distance_m(level)
                .filter(|_| level >= SENSING.level_min)
            else {
                continue;
            };
            let hit = sensor.transform(Point2 {
                x_m: distance_m,
                y_m: 0.0,
            });
            let gap_m = (libm::sqrt(hit.x_m * hit.x_m + hit.y_m * hit.y_m) - radius_m).max(0.0);
            let from_right_rad = sensor.heading_rad + FRAC_PI_2;
            if from_right_rad.abs() < SENSING.side_rad {
                ranges.side_m = Some(gap_m);
                side = Some(hit);
            } else if (0.0..SENSING.diagonal_rad).contains(&from_right_rad) {
                ranges.diagonal_m = Some(gap_m);
                diagonal = Some(hit);
            }
            if let Some(clear_m) = distance_to_contact_m(hit, radius_m) {
                ranges.ahead_m = Some(ranges.ahead_m.map_or(clear_m, |least: f64| least.min(clear_m)));
            }
        }
        if let (Some(side), Some(diagonal)) = (side, diagonal) {
            let slope_rad = -libm::atan2(diagonal.y_m - side.y_m, diagonal.x_m - side.x_m);
            ranges.slope_rad = Some(slope_rad).filter(|slope_rad| slope_rad.abs() < SENSING.slope_max_rad);
        }
        ranges
    }
}
