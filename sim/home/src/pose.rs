//! Poses in the plane.

/// A place and a direction: metres, radians counter-clockwise from x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Metres along x.
    pub x_m: f64,
    /// Metres along y.
    pub y_m: f64,
    /// Radians, counter-clockwise, 0 along x; any range.
    pub heading_rad: f64,
}

impl Pose {
    /// A pose from its parts.
    #[must_use]
    pub const fn new(x_m: f64, y_m: f64, heading_rad: f64) -> Self {
        Self {
            x_m,
            y_m,
            heading_rad,
        }
    }

    /// `a_from_c = a_from_b.then(b_from_c)`.
    #[must_use]
    pub fn then(self, inner: Self) -> Self {
        let (x_m, y_m) = self.point(inner.x_m, inner.y_m);
        Self {
            x_m,
            y_m,
            heading_rad: self.heading_rad + inner.heading_rad,
        }
    }

    /// `b_from_a` of an `a_from_b`.
    #[must_use]
    pub fn inverse(self) -> Self {
        let (sin, cos) = libm::sincos(self.heading_rad);
        Self {
            x_m: -cos * self.x_m - sin * self.y_m,
            y_m: sin * self.x_m - cos * self.y_m,
            heading_rad: -self.heading_rad,
        }
    }

    /// A point of the inner frame in the outer frame, metres.
    #[must_use]
    pub fn point(self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(self.heading_rad);
        (self.x_m + cos * x_m - sin * y_m, self.y_m + sin * x_m + cos * y_m)
    }

    /// Metres between the two places.
    #[must_use]
    pub fn distance_m(self, other: Self) -> f64 {
        libm::hypot(self.x_m - other.x_m, self.y_m - other.y_m)
    }
}

/// An angle brought into -pi..=pi.
#[must_use]
pub fn wrap_angle(angle_rad: f64) -> f64 {
    let turn = core::f64::consts::TAU;
    let wrapped = libm::fmod(angle_rad, turn);
    if wrapped > core::f64::consts::PI {
        wrapped - turn
    } else if wrapped < -core::f64::consts::PI {
        wrapped + turn
    } else {
        wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::{Pose, wrap_angle};

    #[test]
    fn inverse_undoes_then() {
        let a = Pose::new(1.0, -2.0, 0.7);
        let back = a.inverse().then(a);
        assert!(back.x_m.abs() < 1e-12 && back.y_m.abs() < 1e-12 && back.heading_rad.abs() < 1e-12);
    }

    #[test]
    fn angles_wrap_into_half_turns() {
        assert!((wrap_angle(7.0) - (7.0 - core::f64::consts::TAU)).abs() < 1e-12);
        assert!((wrap_angle(-7.0) + (7.0 - core::f64::consts::TAU)).abs() < 1e-12);
    }
}
