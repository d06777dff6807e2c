//! Noise and errors of the simulated parts.

mod named;

pub use named::NoiseError;

/// Size of every imperfection. The four named classes are the ones every benchmark names; all sizes are one standard
/// deviation unless a field says otherwise.
///
/// `nominal` holds the figures that the navigation experiments of the project used for a robot of this class: encoder
/// scale 1 %, asymmetry 0.3 degrees per metre, slip 1 cm and 0.5 degrees per square root of a metre, gyro random walk
/// 0.02 degrees per square root of a second with 0.5 % scale error, infrared 5 % noise, 20 % albedo, 1 % drop-outs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Error of the distance per encoder count, both wheels alike, relative.
    pub encoder_scale: f64,
    /// Heading that unequal wheels add, radians per metre.
    pub asymmetry_rad_per_m: f64,
    /// Error of the effective track, relative.
    pub turn_scale: f64,
    /// Slip along the path, metres per square root of a metre.
    pub slip_m_per_sqrt_m: f64,
    /// Slip in heading, radians per square root of a metre.
    pub slip_rad_per_sqrt_m: f64,
    /// Play of each gear at the rim, metres, not random.
    pub backlash_m: f64,
    /// Gyro angle random walk, radians per square root of a second.
    pub gyro_walk_rad_per_sqrt_s: f64,
    /// Gyro scale error, relative.
    pub gyro_scale: f64,
    /// Gyro bias at switch-on, radians per second.
    pub gyro_bias_rad_per_s: f64,
    /// How fast the gyro bias wanders, radians per second per square root of a second.
    pub gyro_drift_rad_per_s_sqrt_s: f64,
    /// How the bias of a gyro on the Linux board follows the board's temperature, radians per second and kelvin.
    pub gyro_warming_rad_per_s_k: f64,
    /// Noise of infrared levels, relative.
    pub infrared_noise: f64,
    /// Largest deviation of a wall's albedo from the mean, relative, uniform.
    pub infrared_albedo: f64,
    /// Share of infrared samples that read nothing.
    pub infrared_dropout: f64,
    /// Factor on the turn that a rug's nap causes.
    pub rug_drift: f64,
    /// Noise of analog battery and current readings, relative.
    pub analog: f64,
}

const DEGREE: f64 = core::f64::consts::PI / 180.0;

impl Noise {
    /// The class called `nominal`.
    pub const NOMINAL: Self = Self {
        encoder_scale: 0.01,
        asymmetry_rad_per_m: 0.3 * DEGREE,
        turn_scale: 0.015,
        slip_m_per_sqrt_m: 0.01,
        slip_rad_per_sqrt_m: 0.5 * DEGREE,
        backlash_m: 0.0005,
        gyro_walk_rad_per_sqrt_s: 0.02 * DEGREE,
        gyro_scale: 0.005,
        gyro_bias_rad_per_s: 0.05 * DEGREE,
        gyro_drift_rad_per_s_sqrt_s: 0.001 * DEGREE,
        gyro_warming_rad_per_s_k: 0.01 * DEGREE,
        infrared_noise: 0.05,
        infrared_albedo: 0.2,
        infrared_dropout: 0.01,
        rug_drift: 1.0,
        analog: 0.01,
    };

    /// No imperfection.
    #[must_use]
    pub const fn ideal() -> Self {
        Self::NOMINAL.scaled(0.0)
    }

    /// Half of nominal: a new, well calibrated robot.
    #[must_use]
    pub const fn good() -> Self {
        Self::NOMINAL.scaled(0.5)
    }

    /// What the project's navigation experiments call nominal.
    #[must_use]
    pub const fn nominal() -> Self {
        Self::NOMINAL
    }

    /// Twice nominal, with three times the infrared noise and rugs that turn the robot three times as much: worn
    /// wheels, dark and bright furniture (40 % albedo), thick carpets.
    #[must_use]
    pub const fn bad() -> Self {
        Self {
            infrared_noise: 3.0 * Self::NOMINAL.infrared_noise,
            rug_drift: 3.0,
            ..Self::NOMINAL.scaled(2.0)
        }
    }

    /// Every imperfection times `factor`; rugs belong to the home and stay as they are.
    #[must_use]
    pub const fn scaled(self, factor: f64) -> Self {
        Self {
            encoder_scale: self.encoder_scale * factor,
            asymmetry_rad_per_m: self.asymmetry_rad_per_m * factor,
            turn_scale: self.turn_scale * factor,
            slip_m_per_sqrt_m: self.slip_m_per_sqrt_m * factor,
            slip_rad_per_sqrt_m: self.slip_rad_per_sqrt_m * factor,
            backlash_m: self.backlash_m * factor,
            gyro_walk_rad_per_sqrt_s: self.gyro_walk_rad_per_sqrt_s * factor,
            gyro_scale: self.gyro_scale * factor,
            gyro_bias_rad_per_s: self.gyro_bias_rad_per_s * factor,
            gyro_drift_rad_per_s_sqrt_s: self.gyro_drift_rad_per_s_sqrt_s * factor,
            gyro_warming_rad_per_s_k: self.gyro_warming_rad_per_s_k * factor,
            infrared_noise: self.infrared_noise * factor,
            infrared_albedo: self.infrared_albedo * factor,
            infrared_dropout: self.infrared_dropout * factor,
            rug_drift: self.rug_drift,
            analog: self.analog * factor,
        }
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self::NOMINAL
    }
}
