//! How likely contacts, cliffs and the mere presence of the body are at a place of the map.

use super::filter_mode::FilterMode;
use super::infrared::BodyPose;
use super::surroundings::Surroundings;
use crate::model::config::SensorLayout;
use crate::model::geometry::Point2;
use crate::model::observation::{Cliffs, Contacts};

/// The body may be this deep in what the map has as solid before it counts: half a cell and the bumper's travel, metres.
const INSIDE_FREE_M: f64 = 0.015;
/// Over this depth more the body's presence becomes implausible, metres.
const INSIDE_BAND_M: f64 = 0.03;
/// Likelihood of a body deep in a wall: furniture moves, maps err.
const INSIDE: f64 = 0.005;
/// What a closing bumper says of a place: deviation of the gap between rim and wall in metres, and likelihood of a contact with
/// what the map does not have. Where the robot is known to be, they are those of maps that robots draw: wrong by 3 to 4 cm, and
/// without many a leg. Where it looks for itself, a touch must tell places apart.
const HOLDING: ContactModel = ContactModel {
    sigma_m: 0.025,
    unmapped: 0.3,
};
const SEARCHING: ContactModel = ContactModel {
    sigma_m: 0.015,
    unmapped: 0.08,
};
/// How well a contact fits a wall that lies on the other side of the robot.
const CONTACT_ASIDE: f64 = 0.2;
/// The nearest point of a wall is this uncertain in direction, radians: corners, and cells for walls.
const ASIDE_RAD: f64 = 0.35;
/// Deviation of the place of an edge under a cliff sensor, metres.
const EDGE_SIGMA_M: f64 = 0.02;
/// Likelihood of an edge where the map has none, and the reverse.
const EDGE_UNMAPPED: f64 = 0.1;
/// Step for the direction towards the nearest thing, metres.
const SLOPE_STEP_M: f64 = 0.02;

/// How much a closing bumper tells.
#[derive(Clone, Copy, Debug)]
struct ContactModel {
    sigma_m: f64,
    unmapped: f64,
}

/// What the body felt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) mode: FilterMode,
    pub(super) contacts: Contacts,
    /// Cliffs that were seen first now.
    pub(super) edges: Cliffs,
}

/// Likelihood that the body stands where it would touch or overlap this much; 1 at best.
pub(super) fn body_likelihood(rim_gap_m: f64) -> f64 {
    let depth = (-rim_gap_m - INSIDE_FREE_M) / INSIDE_BAND_M;
    if depth <= 0.0 {
        return 1.0;
    }
    let left = 1.0 - depth.min(1.0);
    INSIDE + (1.0 - INSIDE) * left * left
}

impl Touch {
    pub(super) fn tells(&self) -> bool {
        self.contacts.any() || self.edges.any()
    }

    /// Likelihood of contacts and edges at a place; 1 at best.
    pub(super) fn likelihood(
        &self,
        map: &impl Surroundings,
        place: &BodyPose,
        (radius_m, layout): (f64, &SensorLayout),
    ) -> f64 {
        let mut likelihood = 1.0;
        if self.contacts.any() {
            likelihood *= self.contact(map, place, (radius_m, layout));
        }
        if self.edges.any()
            && let Some(mounts) = layout.cliffs
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

    fn contact(
        &self,
        map: &impl Surroundings,
        place: &BodyPose,
        (radius_m, layout): (f64, &SensorLayout),
    ) -> f64 {
        let bump = match self.mode {
            FilterMode::Holding => HOLDING,
            FilterMode::Searching => SEARCHING,
        };
        let off = (place.clearance_m - radius_m) / bump.sigma_m;
        if off.abs() > 5.0 {
            return bump.unmapped;
        }
        let body = 1.0 + 0.25 * off * off;
        let (dx, dy) = towards(map, place.centre);
        let forward = place.cos * dx + place.sin * dy;
        let left = place.cos * dy - place.sin * dx;
        let bearing_rad = libm::atan2(left, forward);
        let bumper = layout.bumper;
        let (low_rad, high_rad) = match (self.contacts.left, self.contacts.right) {
            (true, true) => (-bumper.overlap_rad, bumper.overlap_rad),
            (true, false) => (0.0, bumper.half_arc_rad),
            _ => (-bumper.half_arc_rad, 0.0),
        };
        let beside_rad = (low_rad - bearing_rad).max(bearing_rad - high_rad).max(0.0);
        let side = (1.0 - beside_rad / ASIDE_RAD).max(CONTACT_ASIDE);
        bump.unmapped + (1.0 - bump.unmapped) * side / (body * body)
    }
}

/// Unit vector towards the nearest solid thing; ahead in x where there is none.
fn towards(map: &impl Surroundings, at: Point2) -> (f64, f64) {
    let clear = |x_m: f64, y_m: f64| {
        map.clearance_m(Point2 {
            x_m: at.x_m + x_m,
            y_m: at.y_m + y_m,
        })
    };
    let x = clear(-SLOPE_STEP_M, 0.0) - clear(SLOPE_STEP_M, 0.0);
    let y = clear(0.0, -SLOPE_STEP_M) - clear(0.0, SLOPE_STEP_M);
    let length = libm::sqrt(x * x + y * y);
    if length > 1e-9 {
        (x / length, y / length)
    } else {
        (1.0, 0.0)
    }
}

fn edge(map: &impl Surroundings, sensor: Point2) -> f64 {
    let Some(beyond_m) = map.drop_m(sensor) else {
        return EDGE_UNMAPPED;
    };
    let off = beyond_m / EDGE_SIGMA_M;
    let body = 1.0 + 0.25 * off * off;
    EDGE_UNMAPPED + (1.0 - EDGE_UNMAPPED) / (body * body)
}
