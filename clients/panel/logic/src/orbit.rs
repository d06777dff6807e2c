//! The view of the map from an orbit: how points of the home get to the screen and back.
//!
//! The camera faces the middle of the picture from a distance that makes the floor there as large as the flat map has it, so
//! that a change between the two changes no size.

use crate::camera::View;
use crate::decimal::read_decimal;
use crate::point::{MapPoint, Pixel};

/// Half of the angle that the picture spans from top to bottom: as a lens that does not distort much.
const HALF_ANGLE_RAD: f64 = 0.3;
/// Lowest and highest view: the horizon stays out of the picture, and up stays up.
const PITCH_MIN_RAD: f64 = 0.45;
const PITCH_MAX_RAD: f64 = 1.5;
/// A hand that crosses this many pixels turns the home by a radian.
const PIXELS_PER_RAD: f64 = 170.0;
/// Nearest thing that is drawn, and farthest, in distances to the middle.
const NEAR: f64 = 0.04;
const FAR: f64 = 8.0;
/// A point beside or behind the eye is on no screen; it is given as one this far outside, pixels.
const NOWHERE_PX: f64 = -100_000.0;

/// From where the middle of the map is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    yaw_rad: f64,
    pitch_rad: f64,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            yaw_rad: -0.5,
            pitch_rad: 0.95,
        }
    }
}

impl Orbit {
    /// As a hand turns it that moves by these pixels.
    #[must_use]
    pub fn turned(self, dx: f64, dy: f64) -> Self {
        Self {
            yaw_rad: (self.yaw_rad - dx / PIXELS_PER_RAD).rem_euclid(core::f64::consts::TAU),
            pitch_rad: (self.pitch_rad + dy / PIXELS_PER_RAD).clamp(PITCH_MIN_RAD, PITCH_MAX_RAD),
        }
    }

    /// Two numbers, to be kept as text.
    #[must_use]
    pub fn to_text(self) -> String {
        format!("{:.3} {:.3}", self.yaw_rad, self.pitch_rad)
    }

    /// What [`Self::to_text`] made; none for anything else.
    #[must_use]
    pub fn from_text(text: &str) -> Option<Self> {
        let (yaw, pitch) = text.split_once(' ')?;
        let (yaw, pitch) = (read_decimal(yaw)?, read_decimal(pitch)?);
        let kept = Self {
            yaw_rad: yaw,
            pitch_rad: pitch,
        };
        Some(kept.turned(0.0, 0.0))
    }
}

/// How a place of the home becomes a place on the screen. Places are given by their distance from the middle of the picture to
/// the right and up, as the eye sees the floor.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    view: View,
    middle: MapPoint,
    /// On the floor, towards the right of the screen.
    right: [f64; 2],
    /// Sine and cosine of the pitch.
    tilt: [f64; 2],
    /// Pixels that a metre has at the distance of a metre, and the distance of the middle; the distance is 0 straight above,
    /// where a metre has the same number of pixels everywhere.
    focal_px: f64,
    distance_m: f64,
}

impl Projection {
    pub(crate) fn of(view: View, middle: MapPoint, scale: f64, orbit: Option<Orbit>) -> Self {
        let Some(orbit) = orbit else {
            return Self {
                view,
                middle,
                right: [1.0, 0.0],
                tilt: [1.0, 0.0],
                focal_px: scale,
                distance_m: 0.0,
            };
        };
        let (sin_yaw, cos_yaw) = orbit.yaw_rad.sin_cos();
        let (sin, cos) = orbit.pitch_rad.sin_cos();
        let focal_px = view.height / 2.0 / HALF_ANGLE_RAD.tan();
        Self {
            view,
            middle,
            right: [cos_yaw, sin_yaw],
            tilt: [sin, cos],
            focal_px,
            distance_m: focal_px / scale,
        }
    }

    fn is_flat(&self) -> bool {
        self.distance_m == 0.0
    }

    /// Right, up and depth of a point as the eye sees it.
    fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (dx, dy) = (x - self.middle.x, y - self.middle.y);
        let ([right_x, right_y], [sin, cos]) = (self.right, self.tilt);
        let (aside, ahead) = (dx * right_x + dy * right_y, dy * right_x - dx * right_y);
        let depth = if self.is_flat() {
            1.0
        } else {
            self.distance_m + ahead * cos - z * sin
        };
        [aside, ahead * sin + z * cos, depth]
    }

    /// The pixel that shows a point.
    #[must_use]
    pub fn pixel_of(&self, point: [f64; 3]) -> Pixel {
        let [aside, up, depth] = self.seen(point);
        if depth <= NEAR * self.distance_m {
            return Pixel::new(NOWHERE_PX, NOWHERE_PX);
        }
        let size = self.focal_px / depth;
        Pixel::new(
            self.view.width / 2.0 + aside * size,
            self.view.height / 2.0 - up * size,
        )
    }

    /// The point of the floor under a pixel.
    #[must_use]
    pub fn floor_under(&self, pixel: Pixel) -> MapPoint {
        let (aside, up) = (
            (pixel.x - self.view.width / 2.0) / self.focal_px,
            (self.view.height / 2.0 - pixel.y) / self.focal_px,
        );
        let [sin, cos] = self.tilt;
        if self.is_flat() {
            return self.floor_at(aside, up);
        }
        // Above the horizon there is no floor: the last of it is meant.
        let fall = (sin - up * cos).max(1e-3);
        self.floor_at(aside * self.distance_m * sin / fall, up * self.distance_m / fall)
    }

    fn floor_at(&self, aside: f64, ahead: f64) -> MapPoint {
        let [right_x, right_y] = self.right;
        MapPoint::new(
            self.middle.x + aside * right_x - ahead * right_y,
            self.middle.y + aside * right_y + ahead * right_x,
        )
    }

    /// How far the floor in the middle moves when the picture moves by these pixels.
    pub(crate) fn floor_shift(&self, dx: f64, dy: f64) -> (f64, f64) {
        let scale = if self.is_flat() {
            self.focal_px
        } else {
            self.focal_px / self.distance_m
        };
        let [sin, _] = self.tilt;
        let MapPoint { x, y } = self.floor_at(dx / scale, -dy / scale / sin);
        (x - self.middle.x, y - self.middle.y)
    }

    /// The matrix that makes clip coordinates of points, column by column.
    #[must_use]
    pub fn clip_matrix(&self) -> [f32; 16] {
        let column = |point: [f64; 3], origin: [f64; 3]| {
            let [aside, up, depth] = self.seen(point);
            let column = self.clip([aside - origin[0], up - origin[1], depth - origin[2]]);
            [column[0], column[1], column[2], depth - origin[2]]
        };
        let origin = self.seen([0.0; 3]);
        let unit = |axis: usize| {
            let mut point = [0.0; 3];
            if let Some(number) = point.get_mut(axis) {
                *number = 1.0;
            }
            column(point, origin)
        };
        let [x, y, z, w] = self.clip_at(origin);
        let mut matrix = [0.0; 16];
        let columns = [unit(0), unit(1), unit(2), [x, y, z, w]];
        for (number, value) in matrix.iter_mut().zip(columns.into_iter().flatten()) {
            *number = value as f32;
        }
        matrix
    }

    /// The linear part of clip coordinates.
    fn clip(&self, [aside, up, depth]: [f64; 3]) -> [f64; 3] {
        let (near, far) = (NEAR * self.distance_m, FAR * self.distance_m);
        let deep = if self.is_flat() {
            0.0
        } else {
            depth * (far + near) / (far - near)
        };
        [
            aside * 2.0 * self.focal_px / self.view.width,
            up * 2.0 * self.focal_px / self.view.height,
            deep,
        ]
    }

    fn clip_at(&self, seen: [f64; 3]) -> [f64; 4] {
        let (near, far) = (NEAR * self.distance_m, FAR * self.distance_m);
        let [x, y, deep] = self.clip(seen);
        let shift = if self.is_flat() {
            0.0
        } else {
            2.0 * far * near / (far - near)
        };
        [x, y, deep - shift, seen[2]]
    }

    /// The matrix that makes places of the floor, times a third number, of clip coordinates `x, y, 1`, column by column.
    #[must_use]
    pub fn floor_matrix(&self) -> [f32; 9] {
        let (half_width, half_height) = (
            self.view.width / 2.0 / self.focal_px,
            self.view.height / 2.0 / self.focal_px,
        );
        let ([right_x, right_y], [sin, cos]) = (self.right, self.tilt);
        let MapPoint { x, y } = self.middle;
        let (reach, fall, slope) = if self.is_flat() {
            (1.0, 1.0, 0.0)
        } else {
            (self.distance_m, sin, cos * half_height)
        };
        let aside = half_width * reach * fall;
        let ahead = half_height * reach;
        let columns = [
            [aside * right_x, aside * right_y, 0.0],
            [-ahead * right_y - x * slope, ahead * right_x - y * slope, -slope],
            [x * fall, y * fall, fall],
        ];
        let mut matrix = [0.0; 9];
        for (number, value) in matrix.iter_mut().zip(columns.into_iter().flatten()) {
            *number = value as f32;
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::{Orbit, Projection};
    use crate::{MapPoint, Pixel, View};

    const VIEW: View = View {
        width: 900.0,
        height: 600.0,
    };

    fn views() -> impl Iterator<Item = Projection> {
        let orbits = [
            None,
            Some(Orbit::default()),
            Some(Orbit::default().turned(321.0, -900.0)),
            Some(Orbit::default().turned(-80.0, 900.0)),
        ];
        orbits
            .into_iter()
            .map(|orbit| Projection::of(VIEW, MapPoint::new(3.0, -2.0), 70.0, orbit))
    }

    fn by_matrix(projection: &Projection, [x, y, z]: [f64; 3]) -> [f64; 4] {
        let matrix = projection.clip_matrix();
        core::array::from_fn(|row| {
            let part = |column: usize| f64::from(matrix[4 * column + row]);
            x * part(0) + y * part(1) + z * part(2) + part(3)
        })
    }

    #[test]
    fn the_floor_under_the_pixel_of_a_place_is_that_place() {
        for projection in views() {
            for (x, y) in [(3.0, -2.0), (4.5, -1.0), (1.0, -3.5), (6.0, 0.0)] {
                let back = projection.floor_under(projection.pixel_of([x, y, 0.0]));
                assert!((back.x - x).abs() < 1e-9 && (back.y - y).abs() < 1e-9);
            }
            assert_eq!(projection.pixel_of([3.0, -2.0, 0.0]), Pixel::new(450.0, 300.0));
        }
    }

    #[test]
    fn the_matrices_say_the_same_as_the_words() {
        for projection in views() {
            for point in [[3.5, -2.2, 0.0], [1.0, 0.5, 0.4], [5.0, -4.0, 0.1]] {
                let [x, y, _, w] = by_matrix(&projection, point);
                let Pixel { x: px, y: py } = projection.pixel_of(point);
                let clip_x = px / VIEW.width * 2.0 - 1.0;
                let clip_y = 1.0 - py / VIEW.height * 2.0;
                assert!((x / w - clip_x).abs() < 1e-5, "{x} {w} {clip_x}");
                assert!((y / w - clip_y).abs() < 1e-5, "{y} {w} {clip_y}");
            }
            let floor = projection.floor_matrix();
            let (clip_x, clip_y) = (0.4, -0.7);
            let [x, y, w] = core::array::from_fn(|row| {
                clip_x * f64::from(floor[row])
                    + clip_y * f64::from(floor[3 + row])
                    + f64::from(floor[6 + row])
            });
            let pixel = Pixel::new(
                (clip_x + 1.0) / 2.0 * VIEW.width,
                (1.0 - clip_y) / 2.0 * VIEW.height,
            );
            let floor = projection.floor_under(pixel);
            assert!((x / w - floor.x).abs() < 1e-4 && (y / w - floor.y).abs() < 1e-4);
        }
    }

    #[test]
    fn what_is_nearer_hides_what_is_farther() {
        for projection in views().skip(1) {
            let deep = |point| {
                let [_, _, z, w] = by_matrix(&projection, point);
                z / w
            };
            let (low, high) = (deep([3.0, -2.0, 0.0]), deep([3.0, -2.0, 0.4]));
            assert!(-1.0 < high && high < low && low < 1.0, "{high} {low}");
        }
    }

    #[test]
    fn what_is_kept_as_text_comes_back_within_its_limits() {
        let turned = Orbit::default().turned(40.0, -10.0);
        let back = Orbit::from_text(&turned.to_text()).unwrap();
        assert!((back.yaw_rad - turned.yaw_rad).abs() < 1e-3);
        assert_eq!(
            Orbit::from_text("0.1 99").unwrap().pitch_rad,
            super::PITCH_MAX_RAD
        );
        for wrong in ["", "1", "a b", "NaN 1", "flat"] {
            assert_eq!(Orbit::from_text(wrong), None);
        }
    }
}
