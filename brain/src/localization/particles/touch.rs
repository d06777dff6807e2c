//! Likelihood of contacts, cliffs and the body itself at a pose in the map.

use super::filter_mode::FilterMode;
use super::infrared::BodyPose;
use super::parameters::TOUCH;
use super::surroundings::Surroundings;
use crate::model::config::SensorLayout;
use crate::model::geometry::Point2;
use crate::model::observation::{Cliffs, Contacts};

/// How likely a contact is.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactModel {
    /// Standard deviation of the gap between rim and wall, metres.
    pub(super) sigma_m: f64,
    /// Likelihood of a contact with something that is not in the map.
    pub(super) unmapped: f64,
}

/// The body and its sensors.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyModel<'layout> {
    pub(super) radius_m: f64,
    pub(super) layout: &'layout SensorLayout,
}

/// What the body felt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) mode: FilterMode,
    pub(super) contacts: Contacts,
    /// Cliffs that begin now.
    pub(super) edges: Cliffs,
}

/// Likelihood of a body with this gap between its rim and the nearest obstacle; 1 at best.
pub(super) fn body_likelihood(rim_gap_m: f64) -> f64 {
    let depth = (-rim_gap_m - TOUCH.overlap_free_m) / TOUCH.overlap_band_m;
    if depth <= 0.0 {
        return 1.0;
    }
    let left = 1.0 - depth.min(1.0);
    TOUCH.inside + (1.0 - TOUCH.inside) * left * left
}

impl Touch {
    pub(super) fn is_informative(&self) -> bool {
        self.contacts.any() || self.edges.any()
    }

    /// Likelihood of contacts and cliffs at a pose; 1 at best.
    pub(super) fn likelihood(&self, map: &impl Surroundings, place: &BodyPose, body: BodyModel<'_>) -> f64 {
        let mut likelihood = 1.0;
        if self.contacts.any() {
            likelihood *= self.contact(map, place, body);
        }
        if self.edges.any()
            && let Some(mounts) = body.layout.cliffs
        {
            let seen = [self.edges.left, self.edges.middle, self.edges.right];
            for (mount, seen) in mounts.into_iter().zip(seen) {
                if seen {
                    likelihood *= edge(map, place.point(mount.x_m, mount.y_m));
                }
            }
        }
        likelihood
    }

    fn contact(&self, map: &impl Surroundings, place: &BodyPose, body: BodyModel<'_>) -> f64 {
        let bump = match self.mode {
            FilterMode::Holding => TOUCH.holding,
            FilterMode::Searching => TOUCH.searching,
        };
        let off = (place.clearance_m - body.radius_m) / bump.sigma_m;
        if off.abs() > 5.0 {
            return bump.unmapped;
        }
        let tail = 1.0 + 0.25 * off * off;
        let (dx, dy) = towards(map, place.centre);
        let forward = place.cos * dx + place.sin * dy;
        let left = place.cos * dy - place.sin * dx;
        let bearing_rad = libm::atan2(left, forward);
        let bumper = body.layout.bumper;
        let (low_rad, high_rad) = match (self.contacts.left, self.contacts.right) {
            (true, true) => (-bumper.overlap_rad, bumper.overlap_rad),
            (true, false) => (0.0, bumper.half_arc_rad),
            _ => (-bumper.half_arc_rad, 0.0),
        };
        let beside_rad = (low_rad - bearing_rad).max(bearing_rad - high_rad).max(0.0);
        let side = (1.0 - beside_rad / TOUCH.aside_rad).max(TOUCH.aside);
        bump.unmapped + (1.0 - bump.unmapped) * side / (tail * tail)
    }
}

/// Unit vector towards the nearest obstacle; along x where there is none.
fn towards(map: &impl Surroundings, at: Point2) -> (f64, f64) {
    let clear = |x_m: f64, y_m: f64| {
        map.clearance_m(Point2 {
            x_m: at.x_m + x_m,
            y_m: at.y_m + y_m,
        })
    };
    let x = clear(-TOUCH.slope_step_m, 0.0) - clear(TOUCH.slope_step_m, 0.0);
    let y = clear(0.0, -TOUCH.slope_step_m) - clear(0.0, TOUCH.slope_step_m);
    let length = libm::sqrt(x * x + y * y);
    if length > 1e-9 {
        (x / length, y / length)
    } else {
        (1.0, 0.0)
    }
}

fn edge(map: &impl Surroundings, sensor: Point2) -> f64 {
    let Some(beyond_m) = map.drop_m(sensor) else {
        return TOUCH.edge_unmapped;
    };
    let off = beyond_m / TOUCH.edge_sigma_m;
    let body = 1.0 + 0.25 * off * off;
    TOUCH.edge_unmapped + (1.0 - TOUCH.edge_unmapped) / (body * body)
}
