//! Points and rigid transforms of the plane.

use core::ops::Mul;

use super::normalize_rad;

/// A point in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point2 {
    /// Forward (or east) in metres.
    pub x_m: f64,
    /// Left (or north) in metres.
    pub y_m: f64,
}

impl Point2 {
    /// The origin.
    pub const ORIGIN: Self = Self { x_m: 0.0, y_m: 0.0 };

    /// The point at this distance from the origin, in a direction counter-clockwise from the x axis.
    #[must_use]
    pub fn in_direction(bearing_rad: f64, distance_m: f64) -> Self {
        let (sin, cos) = libm::sincos(bearing_rad);
        Self {
            x_m: distance_m * cos,
            y_m: distance_m * sin,
        }
    }

    /// Distance to `other` in metres.
    #[must_use]
    pub fn distance_m(self, other: Self) -> f64 {
        libm::sqrt(
            (self.x_m - other.x_m) * (self.x_m - other.x_m) + (self.y_m - other.y_m) * (self.y_m - other.y_m),
        )
    }
}

/// A pose, and also the rigid transform from the posed frame into its parent frame: a value named `map_from_odom` maps odom
/// coordinates to map coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose2 {
    /// Metres.
    pub x_m: f64,
    /// Metres.
    pub y_m: f64,
    /// Radians, -pi..=pi, counter-clockwise from the parent's x axis.
    pub heading_rad: f64,
}

impl Pose2 {
    /// The identity transform.
    pub const IDENTITY: Self = Self {
        x_m: 0.0,
        y_m: 0.0,
        heading_rad: 0.0,
    };

    /// The origin of the posed frame in its parent.
    #[must_use]
    pub fn position(self) -> Point2 {
        Point2 {
            x_m: self.x_m,
            y_m: self.y_m,
        }
    }

    /// Transforms a point of the posed frame into the parent frame.
    #[must_use]
    pub fn transform(self, local: Point2) -> Point2 {
        let (sin, cos) = libm::sincos(self.heading_rad);
        Point2 {
            x_m: self.x_m + cos * local.x_m - sin * local.y_m,
            y_m: self.y_m + sin * local.x_m + cos * local.y_m,
        }
    }

    /// The inverse transform: of `a_from_b` it is `b_from_a`.
    #[must_use]
    pub fn inverse(self) -> Self {
        let (sin, cos) = libm::sincos(self.heading_rad);
        Self {
            x_m: -cos * self.x_m - sin * self.y_m,
            y_m: sin * self.x_m - cos * self.y_m,
            heading_rad: normalize_rad(-self.heading_rad),
        }
    }

    /// The pose after an arc of constant curvature: `distance_m` along it (backwards negative) while turning `turn_rad`.
    #[must_use]
    pub fn after_arc(self, distance_m: f64, turn_rad: f64) -> Self {
        // The chord of the arc has the direction of the mean heading; its length tends to the arc's for small turns.
        let half = 0.5 * turn_rad;
        let chord_m = if half.abs() < 1e-3 {
            distance_m * (1.0 - half * half / 6.0)
        } else {
            distance_m * libm::sin(half) / half
        };
        let (sin, cos) = libm::sincos(self.heading_rad + half);
        Self {
            x_m: self.x_m + chord_m * cos,
            y_m: self.y_m + chord_m * sin,
            heading_rad: normalize_rad(self.heading_rad + turn_rad),
        }
    }

    /// Linear interpolation towards `other`, turning the shorter way round.
    #[must_use]
    pub fn towards(self, other: Self, share: f64) -> Self {
        let turn_rad = normalize_rad(other.heading_rad - self.heading_rad);
        Self {
            x_m: self.x_m + share * (other.x_m - self.x_m),
            y_m: self.y_m + share * (other.y_m - self.y_m),
            heading_rad: normalize_rad(self.heading_rad + share * turn_rad),
        }
    }
}

impl Mul for Pose2 {
    type Output = Self;

    #[allow(
        clippy::suspicious_arithmetic_impl,
        reason = "composing rotations adds their angles"
    )]
    /// Composition: `a_from_b * b_from_c` is `a_from_c`.
    fn mul(self, other: Self) -> Self {
        let origin = self.transform(other.position());
        Self {
            x_m: origin.x_m,
            y_m: origin.y_m,
            heading_rad: normalize_rad(self.heading_rad + other.heading_rad),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Point2, Pose2};
    use core::f64::consts::{FRAC_PI_2, PI};

    fn assert_close(left: Pose2, right: Pose2) {
        let gap = left.position().distance_m(right.position()) + (left.heading_rad - right.heading_rad).abs();
        assert!(gap < 1e-9, "{left:?} is not {right:?}");
    }

    #[test]
    fn a_transform_and_its_inverse_cancel() {
        let pose = Pose2 {
            x_m: 1.5,
            y_m: -0.7,
            heading_rad: 2.1,
        };
        assert_close(pose * pose.inverse(), Pose2::IDENTITY);
        assert_close(pose.inverse() * pose, Pose2::IDENTITY);
    }

    #[test]
    fn left_is_positive_y() {
        let pose = Pose2 {
            x_m: 1.0,
            y_m: 2.0,
            heading_rad: FRAC_PI_2,
        };
        let left = pose.transform(Point2 { x_m: 0.0, y_m: 1.0 });
        assert!(left.distance_m(Point2 { x_m: 0.0, y_m: 2.0 }) < 1e-12);
    }

    #[test]
    fn a_half_circle_ends_one_diameter_to_the_left() {
        let end = Pose2::IDENTITY.after_arc(PI * 0.5, PI);
        assert!(end.position().distance_m(Point2 { x_m: 0.0, y_m: 1.0 }) < 1e-12);
        assert_close(
            Pose2::IDENTITY.after_arc(2.0, 0.0),
            Pose2 {
                x_m: 2.0,
                ..Pose2::IDENTITY
            },
        );
    }
}
