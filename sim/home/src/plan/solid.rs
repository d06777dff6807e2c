//! Solid cells at this moment: the plan, and the feet of walkers.

use super::DistanceField;

/// A foot on the floor, or a pet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Foot {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) radius_m: f64,
}

impl Foot {
    /// Distance from its rim, negative inside.
    pub(crate) fn distance_m(&self, x_m: f64, y_m: f64) -> f64 {
        libm::hypot(x_m - self.x_m, y_m - self.y_m) - self.radius_m
    }
}

/// Everything that stops bumpers and beams.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solid<'a> {
    pub(crate) plan: &'a DistanceField,
    pub(crate) feet: &'a [Foot],
}

impl Solid<'_> {
    /// Distance from a place to the nearest solid thing, negative inside of one.
    #[inline]
    pub(crate) fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let plan_m = self.plan.at(x_m, y_m);
        self.feet
            .iter()
            .fold(plan_m, |nearest_m, foot| nearest_m.min(foot.distance_m(x_m, y_m)))
    }

    /// Unit vector away from the nearest solid thing.
    pub(crate) fn away(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let Some(foot) = self.nearest_foot(x_m, y_m) else {
            return self.plan.away(x_m, y_m);
        };
        let (dx, dy) = (x_m - foot.x_m, y_m - foot.y_m);
        let length = libm::hypot(dx, dy);
        if length > 1e-9 {
            (dx / length, dy / length)
        } else {
            (1.0, 0.0)
        }
    }

    /// The foot that is nearer than anything of the plan.
    pub(crate) fn nearest_foot(&self, x_m: f64, y_m: f64) -> Option<&Foot> {
        let mut nearest = (self.plan.at(x_m, y_m), None);
        for foot in self.feet {
            let distance_m = foot.distance_m(x_m, y_m);
            if distance_m < nearest.0 {
                nearest = (distance_m, Some(foot));
            }
        }
        nearest.1
    }
}
