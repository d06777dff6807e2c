//! Likelihood of an infrared distance, for a surface whose reflectance a particle has learned.

use super::parameters::{BEAM, SURFACE};
use crate::model::config::PROXIMITY_MAX;

/// A distance, for a surface of usual reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) seen_m: f64,
    /// Error of the distance for each unit of missing reflectance, metres.
    pub(super) by_reflection_m: f64,
    /// Inverse standard deviation of the distance, for an unknown surface.
    pub(super) per_sigma: f64,
}

/// Reflectance of the surfaces that the sensors see, as one particle estimates it. A surface has the same error as long as a sensor
/// sees it. Its first readings give its distance, as well as reflectances allow, and all later ones only the changes of the
/// distance. One Kalman filter of one number for each sensor and particle (a Rao-Blackwellized particle filter).
#[derive(Clone, Copy, Debug)]
pub(super) struct Reflectances {
    pub(super) surfaces: [Reflectance; PROXIMITY_MAX],
}

/// Missing reflectance of a surface, relative, and its variance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reflectance {
    darkness: f32,
    variance: f32,
}

impl Default for Reflectance {
    fn default() -> Self {
        Self {
            darkness: 0.0,
            variance: (SURFACE.reflectance_sigma * SURFACE.reflectance_sigma) as f32,
        }
    }
}

impl Default for Reflectances {
    fn default() -> Self {
        Self {
            surfaces: [Reflectance::default(); PROXIMITY_MAX],
        }
    }
}

impl Reflectances {
    /// Share of the knowledge of a surface that remains after a distance.
    pub(super) fn kept_after(distance_m: f64) -> f32 {
        libm::exp(-distance_m / SURFACE.length_m) as f32
    }

    /// The sensors may see other surfaces now.
    pub(super) fn move_on(&mut self, kept: f32) {
        let usual = Reflectance::default();
        for surface in &mut self.surfaces {
            surface.darkness *= kept;
            surface.variance = usual.variance + kept * (surface.variance - usual.variance);
        }
    }
}

impl Reflectance {
    /// Likelihood of a distance where the map expects another one; 1 at best. Updates the reflectance.
    pub(super) fn likelihood(&mut self, range: Range, expected_m: f64) -> f64 {
        let (slope_m, known) = (range.by_reflection_m, f64::from(self.variance));
        let off_m = range.seen_m - expected_m - slope_m * f64::from(self.darkness);
        let variance_m2 = slope_m * slope_m * (known + SURFACE.level_sigma * SURFACE.level_sigma)
            + SURFACE.distance_sigma_m * SURFACE.distance_sigma_m;
        let off2 = off_m * off_m / variance_m2;
        let floor = if off_m > 0.0 && off2 > 9.0 {
            BEAM.through
        } else {
            BEAM.unmapped
        };
        let explained = (1.0 - floor) * bell(off2);
        if explained >= SURFACE.explained_min {
            let gain = slope_m * known / variance_m2;
            let darkness = f64::from(self.darkness) + gain * off_m;
            self.darkness = darkness.clamp(-SURFACE.reflectance_off_max, SURFACE.reflectance_off_max) as f32;
            self.variance = (known * (1.0 - gain * slope_m)) as f32;
        }
        floor + explained
    }
}

/// A bell of height 1 over a squared deviation, with heavier tails than the normal one and without an exponential function.
pub(super) fn bell(off2: f64) -> f64 {
    let body = 1.0 + off2 * 0.25;
    1.0 / (body * body)
}

#[cfg(test)]
mod tests {
    use super::{Range, Reflectance, Reflectances};

    const EXPECTED_M: f64 = 0.1;

    fn range(off_m: f64) -> Range {
        Range {
            seen_m: EXPECTED_M + off_m,
            by_reflection_m: 0.08,
            per_sigma: 1.0 / 0.022,
        }
    }

    /// Likelihood of an offset of the next reading, after twenty readings along a wall that were all 2 cm too far.
    fn after_dark_wall(off_m: f64) -> f64 {
        let mut surface = Reflectance::default();
        for _ in 0..20 {
            surface.likelihood(range(0.02), EXPECTED_M);
        }
        surface.likelihood(range(off_m), EXPECTED_M)
    }

    #[test]
    fn along_one_wall_only_a_change_of_distance_is_unlikely() {
        let first = Reflectance::default().likelihood(range(0.02), EXPECTED_M);
        assert!(after_dark_wall(0.02) > 0.95 && first < 0.85, "{first}");
        // A wall at the expected distance that was dark until now is as surprising as one that is twice as far off.
        let changes = [0.0, 0.04].map(after_dark_wall);
        assert!((changes[0] - changes[1]).abs() < 0.1, "{changes:?}");
        assert!(changes[0] < 0.75, "{changes:?}");
    }

    #[test]
    fn another_surface_starts_unknown() {
        let mut surfaces = Reflectances::default();
        surfaces.surfaces[0].likelihood(range(0.03), EXPECTED_M);
        let learnt = surfaces.surfaces[0];
        assert!(learnt.darkness > 0.1 && learnt.variance < 0.03, "{learnt:?}");
        surfaces.move_on(Reflectances::kept_after(0.05));
        assert!(surfaces.surfaces[0].darkness > 0.9 * learnt.darkness);
        surfaces.move_on(Reflectances::kept_after(5.0));
        let forgotten = surfaces.surfaces[0];
        assert!(
            forgotten.darkness < 0.01 && forgotten.variance > 0.039,
            "{forgotten:?}"
        );
    }

    #[test]
    fn an_unmapped_obstacle_teaches_nothing_about_the_surface() {
        let mut surface = Reflectance::default();
        let likelihood = surface.likelihood(range(-0.3), EXPECTED_M);
        assert!(likelihood < 0.2, "{likelihood}");
        assert_eq!(surface.darkness, 0.0);
    }
}
