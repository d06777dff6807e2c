//! Calibration of the gyro by the particles. Each particle has its own scale and bias. A wrong heading after a turn comes from the
//! scale, and after a long path from the bias. Particles with the right values fit the walls turn after turn, so the filter
//! estimates both with the pose.

use super::ParticleFilter;
use super::parameters::GYRO;
use crate::localization::calibration::CALIBRATION;
use crate::localization::gyro_estimate::{BiasMeasurement, GyroEstimate};
use crate::model::advance::Advance;
use crate::model::random::Random;

/// What the gyro measured during a motion.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::localization) struct GyroCount {
    shown_rad: f64,
    time_s: f64,
    /// The same as odometry counted it.
    counted_rad: f64,
}

impl GyroCount {
    /// Adds a motion that odometry counted with this calibration. Odometry ignores the gyro while the robot is at rest.
    pub(in crate::localization) fn add(&mut self, advance: Advance, belief: GyroEstimate) {
        let Some(turn_rad) = advance.gyro_turn_rad.filter(|_| !advance.is_stationary()) else {
            return;
        };
        self.shown_rad += turn_rad / (1.0 + belief.scale) + belief.bias_rad_per_s * advance.time_s;
        self.time_s += advance.time_s;
        self.counted_rad += turn_rad;
    }
}

/// The gyro as one particle models it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ParticleGyro {
    scale: f64,
    bias_rad_per_s: f64,
}

impl ParticleGyro {
    /// Draws a particle's gyro from the estimate.
    pub(super) fn drawn(belief: GyroEstimate, random: &mut Random) -> Self {
        let bias_sigma_max = GYRO.bias_sigma_drawn_max_rad_per_s;
        let bias_sigma_rad_per_s = belief.bias_sigma_rad_per_s.min(bias_sigma_max);
        Self {
            scale: belief.scale + belief.scale_sigma * random.normal(),
            bias_rad_per_s: belief.bias_rad_per_s + bias_sigma_rad_per_s * random.normal(),
        }
    }

    /// Turn in addition to what odometry counted, if this particle is right. Bias and scale do a random walk meanwhile.
    pub(super) fn turned_more_rad(&mut self, count: GyroCount, random: &mut Random) -> f64 {
        if count.time_s <= 0.0 {
            return 0.0;
        }
        self.bias_rad_per_s +=
            libm::sqrt(CALIBRATION.bias_drift_rad2_per_s3 * count.time_s) * random.normal();
        self.scale += GYRO.scale_walk * libm::sqrt(count.counted_rad.abs()) * random.normal();
        (count.shown_rad - self.bias_rad_per_s * count.time_s) * (1.0 + self.scale) - count.counted_rad
    }

    /// Likelihood of a zero-velocity update; 1 at best.
    pub(super) fn likelihood(&self, measured: BiasMeasurement) -> f64 {
        let off = measured.rad_per_s - self.bias_rad_per_s;
        let least = GYRO.measured_variance_min_rad2_per_s2;
        libm::exp(-0.5 * off * off / measured.variance_rad2_per_s2.max(least))
    }

    /// A variation of it for resampling.
    pub(super) fn redrawn(self, belief: GyroEstimate, random: &mut Random) -> Self {
        let kept = libm::sqrt(1.0 - GYRO.redrawn_share * GYRO.redrawn_share);
        let about = |value: f64, mean: f64, sigma: f64, chance: f64| {
            mean + kept * (value - mean) + GYRO.redrawn_share * sigma * chance
        };
        Self {
            scale: about(
                self.scale,
                belief.scale,
                belief.scale_sigma.max(GYRO.scale_sigma_min),
                random.normal(),
            ),
            bias_rad_per_s: about(
                self.bias_rad_per_s,
                belief.bias_rad_per_s,
                belief.bias_sigma_rad_per_s.max(GYRO.bias_sigma_min_rad_per_s),
                random.normal(),
            ),
        }
    }
}

impl ParticleFilter {
    /// All particles draw a bias from this estimate and keep their scales.
    pub(in crate::localization) fn draw_bias(&mut self, belief: GyroEstimate) {
        for particle in &mut self.particles {
            particle.gyro = ParticleGyro {
                scale: particle.gyro.scale,
                ..ParticleGyro::drawn(belief, &mut self.random)
            };
        }
    }
}

/// Weighted mean and deviation of the particles' values.
pub(super) fn belief(gyros: impl Iterator<Item = (f64, ParticleGyro)> + Clone) -> GyroEstimate {
    let sum: f64 = gyros.clone().map(|(weight, _)| weight).sum();
    let mean = |of: &dyn Fn(ParticleGyro) -> f64| {
        let weighted = gyros.clone().map(|(weight, gyro)| weight * of(gyro));
        weighted.sum::<f64>() / sum.max(1e-300)
    };
    let scale = mean(&|gyro| gyro.scale);
    let bias_rad_per_s = mean(&|gyro| gyro.bias_rad_per_s);
    let scale_variance = mean(&|gyro| (gyro.scale - scale) * (gyro.scale - scale));
    let bias_variance = mean(&|gyro| {
        let off = gyro.bias_rad_per_s - bias_rad_per_s;
        off * off
    });
    GyroEstimate {
        scale,
        scale_sigma: libm::sqrt(scale_variance),
        bias_rad_per_s,
        bias_sigma_rad_per_s: libm::sqrt(bias_variance),
    }
}

#[cfg(test)]
mod tests {
    use super::{BiasMeasurement, GyroCount, ParticleGyro, belief};
    use crate::localization::gyro_estimate::GyroEstimate;
    use crate::model::advance::Advance;
    use crate::model::random::Random;

    const BELIEF: GyroEstimate = GyroEstimate {
        scale: 0.01,
        scale_sigma: 0.004,
        bias_rad_per_s: 0.002,
        bias_sigma_rad_per_s: 5.0e-4,
    };

    /// What odometry counts with this estimate when the gyro measures a turn.
    fn counted(shown_rad: f64, time_s: f64, belief: GyroEstimate) -> Advance {
        let turn_rad = (shown_rad - belief.bias_rad_per_s * time_s) * (1.0 + belief.scale);
        Advance {
            time_s,
            distance_m: 0.1,
            turn_rad,
            gyro_turn_rad: Some(turn_rad),
            ..Advance::default()
        }
    }

    #[test]
    fn a_particle_turns_by_the_raw_gyro_and_its_own_calibration() {
        let mut count = GyroCount::default();
        let mut other = BELIEF;
        for _ in 0..5 {
            count.add(counted(0.5, 2.0, other), other);
            // A zero-velocity update has changed the bias meanwhile.
            other.bias_rad_per_s += 0.001;
        }
        let mut gyro = ParticleGyro {
            scale: -0.02,
            bias_rad_per_s: -0.003,
        };
        let more_rad = gyro.turned_more_rad(count, &mut Random::new(1));
        let turned_rad = (2.5 + 0.003 * 10.0) * 0.98;
        assert!(
            (count.counted_rad + more_rad - turned_rad).abs() < 5e-3,
            "{more_rad}"
        );
    }

    #[test]
    fn without_gyro_or_motion_there_is_no_gyro_error() {
        let mut count = GyroCount::default();
        let standing = Advance {
            time_s: 5.0,
            gyro_turn_rad: Some(0.0),
            ..Advance::default()
        };
        let by_wheels = Advance {
            gyro_turn_rad: None,
            ..counted(1.0, 1.0, BELIEF)
        };
        count.add(standing, BELIEF);
        count.add(by_wheels, BELIEF);
        let mut random = Random::new(1);
        let mut gyro = ParticleGyro::drawn(BELIEF, &mut random);
        assert_eq!(gyro.turned_more_rad(count, &mut random), 0.0);
    }

    fn gyros(random: &mut Random) -> Vec<(f64, ParticleGyro)> {
        (0..20_000)
            .map(|_| (1.0, ParticleGyro::drawn(BELIEF, random)))
            .collect()
    }

    fn about(value: f64, wanted: f64) -> bool {
        (value / wanted - 1.0).abs() < 0.05
    }

    #[test]
    fn repeated_resampling_keeps_mean_and_deviation() {
        let mut random = Random::new(3);
        let mut gyros = gyros(&mut random);
        for _ in 0..50 {
            let before = belief(gyros.iter().copied());
            for (_, gyro) in &mut gyros {
                *gyro = gyro.redrawn(before, &mut random);
            }
        }
        let after = belief(gyros.iter().copied());
        assert!(
            about(after.scale, BELIEF.scale) && about(after.scale_sigma, BELIEF.scale_sigma),
            "{after:?}"
        );
        assert!(about(after.bias_rad_per_s, BELIEF.bias_rad_per_s), "{after:?}");
        assert!(
            about(after.bias_sigma_rad_per_s, BELIEF.bias_sigma_rad_per_s),
            "{after:?}"
        );
    }

    #[test]
    fn a_zero_velocity_update_counts_by_its_variance() {
        let mut gyros = gyros(&mut Random::new(4));
        let measured = BiasMeasurement {
            rad_per_s: 0.003,
            variance_rad2_per_s2: 2.5e-7,
        };
        for (weight, gyro) in &mut gyros {
            *weight *= gyro.likelihood(measured);
        }
        let after = belief(gyros.iter().copied());
        // The measurement and the estimate are equally sure.
        assert!(about(after.bias_rad_per_s, 0.0025), "{after:?}");
        assert!(
            about(after.bias_sigma_rad_per_s, 5.0e-4 / 2.0_f64.sqrt()),
            "{after:?}"
        );
        assert!(about(after.scale, BELIEF.scale), "{after:?}");
    }
}
