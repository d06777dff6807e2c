//! A MEMS gyro on the Linux board: the noise of [`crate::Noise`], and a bias that follows the board as it warms up.

use crate::world::{DRIFT_STEPS, SimulatedGyro, WALK_STEPS};
use crate::{GyroModel, Noise, Pcg, wrap_angle};

/// Stream of random numbers, beside those of the world.
const STREAM: u64 = 5;
/// The smallest step of the total: what the daemon's reader sends are microradians.
const PART: GyroModel = GyroModel { resolution_rad: 1e-6 };
/// How much a small Linux board warms up in a closed robot, kelvin, and the time constant in seconds. Placeholders: no robot
/// was measured.
const WARMING_K: f64 = 18.0;
const WARMING_S: f64 = 900.0;

/// The gyro. The same seed and the same poses give the same totals.
#[derive(Clone, Debug)]
pub struct BoardGyro {
    gyro: SimulatedGyro,
    random: Pcg,
    rad_per_s_k: f64,
    warmed_k: f64,
    heading_rad: Option<f64>,
    steps: u64,
}

impl BoardGyro {
    /// A cold gyro.
    #[must_use]
    pub fn new(noise: &Noise, seed: u64) -> Self {
        let mut random = Pcg::new(seed, STREAM);
        Self {
            gyro: SimulatedGyro::new(&PART, noise, &mut random),
            rad_per_s_k: noise.gyro_warming_rad_per_s_k * random.normal(),
            random,
            warmed_k: 0.0,
            heading_rad: None,
            steps: 0,
        }
    }

    /// One millisecond later the robot has this heading.
    pub fn step(&mut self, heading_rad: f64) {
        let before_rad = self.heading_rad.replace(heading_rad).unwrap_or(heading_rad);
        self.gyro.step(wrap_angle(heading_rad - before_rad));
        self.steps += 1;
        if self.steps.is_multiple_of(WALK_STEPS) {
            self.gyro.walk(&mut self.random);
        }
        if self.steps.is_multiple_of(DRIFT_STEPS) {
            self.gyro.drift(&mut self.random);
            let passed_s = DRIFT_STEPS as f64 * 0.001;
            let warmer_k = (WARMING_K - self.warmed_k) * passed_s / WARMING_S;
            self.warmed_k += warmer_k;
            self.gyro.shift_bias(warmer_k * self.rad_per_s_k);
        }
    }

    /// What it has turned since it was switched on, microradians, wrapping.
    #[must_use]
    pub fn total_urad(&self) -> i32 {
        self.gyro.reading().heading.0
    }
}

#[cfg(test)]
mod tests {
    use super::BoardGyro;
    use crate::Noise;

    fn total_rad(noise: &Noise, seconds: u32, rad_per_s: f64) -> f64 {
        let mut gyro = BoardGyro::new(noise, 3);
        let mut heading_rad: f64 = 3.0;
        for _ in 0..seconds * 1000 {
            heading_rad += rad_per_s * 0.001;
            gyro.step(heading_rad);
        }
        f64::from(gyro.total_urad()) * 1e-6
    }

    #[test]
    fn an_ideal_one_counts_what_the_robot_turns() {
        let turned_rad = total_rad(&Noise::ideal(), 60, 0.2);
        assert!((turned_rad - 12.0).abs() < 1e-2, "{turned_rad}");
    }

    #[test]
    fn warmth_bends_the_bias_of_a_real_one() {
        let cold = Noise {
            gyro_warming_rad_per_s_k: 0.0,
            ..Noise::nominal()
        };
        let apart_rad = total_rad(&Noise::nominal(), 600, 0.0) - total_rad(&cold, 600, 0.0);
        assert!(apart_rad.abs() > 0.05, "{apart_rad}");
    }
}
