//! Places on the floor and how frames hang together.

use std::f64::consts::{PI, TAU};

use crate::messages::{Pose, Quaternion, Vector3};

/// A pose on the floor: metres, and radians counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Place {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) heading_rad: f64,
}

impl Place {
    /// Where `other`, which is told in the frame of this one, lies in the frame in which this one is told.
    pub(crate) fn then(self, other: Self) -> Self {
        let (sin, cos) = self.heading_rad.sin_cos();
        Self {
            x_m: self.x_m + cos * other.x_m - sin * other.y_m,
            y_m: self.y_m + sin * other.x_m + cos * other.y_m,
            heading_rad: wrapped(self.heading_rad + other.heading_rad),
        }
    }

    /// The frame in which this one is told, seen from this one.
    pub(crate) fn inverse(self) -> Self {
        let (sin, cos) = self.heading_rad.sin_cos();
        Self {
            x_m: -cos * self.x_m - sin * self.y_m,
            y_m: sin * self.x_m - cos * self.y_m,
            heading_rad: -self.heading_rad,
        }
    }

    pub(crate) fn message(self) -> Pose {
        Pose {
            position: Vector3::flat(self.x_m, self.y_m),
            orientation: Quaternion::of_heading(self.heading_rad),
        }
    }
}

impl From<rvac_api::Pose> for Place {
    fn from(pose: rvac_api::Pose) -> Self {
        Self {
            x_m: pose.x,
            y_m: pose.y,
            heading_rad: pose.heading,
        }
    }
}

/// Into -pi..=pi.
pub(crate) fn wrapped(angle_rad: f64) -> f64 {
    let turned = angle_rad.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
