//! Infrared eyes for the paper world: the ring of the SR8730, or part of it.

use brain::{Point2, Pose2, ProximityLayout, ProximityResponse, SensorLayout};

use super::{BODY, CLIFF_LEAD_M, Rectangle};

const MOUNT_M: f64 = 0.165;
/// The seven eyes of the SR8730, degrees.
pub(crate) const RING_DEG: [f64; 7] = [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0];

/// Sensors on the rim that look in these directions, from the right counter-clockwise.
pub(crate) fn sensors_at(headings_deg: &[f64]) -> SensorLayout {
    let poses: Vec<Pose2> = headings_deg
        .iter()
        .map(|degrees| {
            let heading_rad = degrees.to_radians();
            Pose2 {
                x_m: MOUNT_M * heading_rad.cos(),
                y_m: MOUNT_M * heading_rad.sin(),
                heading_rad,
            }
        })
        .collect();
    let response = ProximityResponse {
        range_m: 0.25,
        half_angle_rad: 0.09,
        half_level_m: 0.06,
        skin_m: BODY.radius_m - MOUNT_M,
        near_m: None,
    };
    let cliff = |y_m| Point2 {
        x_m: CLIFF_LEAD_M,
        y_m,
    };
    SensorLayout {
        proximity: ProximityLayout::new(&poses, response),
        cliffs: Some([cliff(0.1), cliff(0.0), cliff(-0.1)]),
        ..SensorLayout::default()
    }
}

/// How well the eyes see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    pub(crate) layout: SensorLayout,
    /// Brightness of all things; 1 = as the brain believes.
    pub(crate) albedo: f64,
    /// Largest relative error of a level.
    pub(crate) noise: f64,
}

impl Sight {
    pub(crate) fn of(layout: SensorLayout) -> Self {
        Self {
            layout,
            albedo: 1.0,
            noise: 0.0,
        }
    }

    /// Levels that the sensors show. `moment` makes the noise, the same for equal moments.
    pub(crate) fn look(&self, pose: Pose2, things: &[Rectangle], moment: u64) -> Vec<f32> {
        let response = self.layout.proximity.response;
        let sensors = self.layout.proximity.sensors().iter();
        let mut dice = moment.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        sensors
            .map(|sensor| {
                let eye = pose * *sensor;
                let nearest = things
                    .iter()
                    .filter_map(|thing| distance_m(eye, thing))
                    .fold(f64::INFINITY, f64::min);
                dice ^= dice << 13;
                dice ^= dice >> 7;
                dice ^= dice << 17;
                let error = self.noise * (2.0 * (dice % 1000) as f64 / 999.0 - 1.0);
                (self.albedo * (1.0 + error) * response.level(nearest)).min(1.0) as f32
            })
            .collect()
    }
}

/// Way of a beam until it meets a rectangle.
fn distance_m(eye: Pose2, thing: &Rectangle) -> Option<f64> {
    let ahead = eye.transform(Point2 { x_m: 1.0, y_m: 0.0 });
    let (dx, dy) = (ahead.x_m - eye.x_m, ahead.y_m - eye.y_m);
    let slab = |from: f64, step: f64, low: f64, high: f64| {
        if step.abs() < 1e-12 {
            let inside = (low..=high).contains(&from);
            return if inside {
                (f64::NEG_INFINITY, f64::INFINITY)
            } else {
                (f64::INFINITY, f64::NEG_INFINITY)
            };
        }
        let (one, other) = ((low - from) / step, (high - from) / step);
        (one.min(other), one.max(other))
    };
    let (x_in, x_out) = slab(eye.x_m, dx, thing.low.0, thing.high.0);
    let (y_in, y_out) = slab(eye.y_m, dy, thing.low.1, thing.high.1);
    let (enter, leave) = (x_in.max(y_in), x_out.min(y_out));
    (enter <= leave && leave > 0.0).then(|| enter.max(0.0))
}
