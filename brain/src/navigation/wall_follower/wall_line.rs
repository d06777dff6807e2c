//! The wall on the right as a line, predicted from odometry and corrected by the sensors.
//!
//! One side sensor is enough: the change of its distance while driving gives the angle. A second sensor that faces between
//! ahead and the side gives the angle at once.

use super::parameters::ESTIMATION;
use super::wall_ranges::WallRanges;
use crate::model::advance::Advance;

/// The wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WallLine {
    /// Gap between the rim and the wall, metres.
    pub(super) gap_m: f64,
    /// Heading relative to the wall, radians; positive faces away from it.
    pub(super) slope_rad: f64,
    /// Distance since the wall was last seen on the right; `None` = it was not seen since the line was given up.
    unseen_m: Option<f64>,
}

impl WallLine {
    /// Whether a wall was seen within the last `driven_m`.
    pub(super) fn is_seen_within(&self, driven_m: f64) -> bool {
        self.unseen_m.is_some_and(|unseen_m| unseen_m <= driven_m)
    }

    /// The wall is no longer beside the robot.
    pub(super) fn lose(&mut self) {
        self.unseen_m = None;
    }

    pub(super) fn follow(&mut self, advance: Advance, ranges: &WallRanges) {
        let driven_m = advance.distance_m;
        self.gap_m += driven_m * libm::sin(self.slope_rad + 0.5 * advance.turn_rad);
        self.slope_rad += advance.turn_rad;
        let Some(side_m) = ranges.side_m else {
            self.unseen_m = self.unseen_m.map(|unseen_m| unseen_m + driven_m.abs());
            return;
        };
        let apart_m = side_m - self.gap_m;
        if self.unseen_m.is_none() || apart_m.abs() > ESTIMATION.other_object_m {
            self.gap_m = side_m;
            self.slope_rad = ranges.slope_rad.unwrap_or(0.0);
        } else {
            let driven_m = driven_m.abs();
            self.gap_m += (ESTIMATION.gap_gain_per_m * driven_m).min(1.0) * apart_m;
            match ranges.slope_rad {
                Some(seen_rad) => {
                    self.slope_rad +=
                        (ESTIMATION.slope_gain_per_m * driven_m).min(1.0) * (seen_rad - self.slope_rad);
                }
                None => {
                    self.slope_rad +=
                        ESTIMATION.slope_from_gap_per_m2 * driven_m * apart_m * driven_m.signum()
                }
            }
        }
        self.unseen_m = Some(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::{WallLine, WallRanges};
    use crate::model::advance::Advance;

    #[test]
    fn one_sensor_gives_the_angle_from_the_change_of_its_distance() {
        let mut line = WallLine::default();
        let slope_rad: f64 = 0.2;
        let mut gap_m = 0.04;
        for _ in 0..60 {
            gap_m += 0.005 * slope_rad.sin();
            let advance = Advance {
                time_s: 0.02,
                distance_m: 0.005,
                ..Advance::default()
            };
            let ranges = WallRanges {
                side_m: Some(gap_m),
                ..WallRanges::default()
            };
            line.follow(advance, &ranges);
        }
        assert!((line.slope_rad - slope_rad).abs() < 0.04, "{line:?}");
        assert!((line.gap_m - gap_m).abs() < 0.01, "{line:?}");
    }
}
