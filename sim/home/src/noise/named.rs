//! Noise by its name: a class, and parts of it that are larger or smaller than in that class. `nominal,gyro=0` is a nominal robot whose
//! gyro is perfect: it shows what the gyro's errors cost.

use std::str::FromStr;

use super::Noise;

/// Why a text names no noise.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoiseError {
    /// The first word is no class.
    #[error("there is no noise class `{0}`; known are ideal, good, nominal and bad")]
    Class(String),
    /// What comes after the class is no part with a factor.
    #[error(
        "`{0}` is no part of noise; give wheel-scale, wheels, gyro, infrared, rugs or analog and a factor, as in `nominal,gyro=0`"
    )]
    Part(String),
    /// A factor is no number from 0 on.
    #[error("`{0}` is no factor of noise: give a number from 0 to 10")]
    Factor(String),
}

/// Largest factor: beyond it no robot is meant any more.
const FACTOR_MAX: f64 = 10.0;

impl FromStr for Noise {
    type Err = NoiseError;

    fn from_str(text: &str) -> Result<Self, NoiseError> {
        let mut words = text.split(',').map(str::trim);
        let class = words.next().unwrap_or_default();
        let mut noise = match class {
            "ideal" => Self::ideal(),
            "good" => Self::good(),
            "nominal" => Self::nominal(),
            "bad" => Self::bad(),
            other => return Err(NoiseError::Class(other.to_owned())),
        };
        for word in words {
            let (part, factor) = word
                .split_once('=')
                .ok_or_else(|| NoiseError::Part(word.to_owned()))?;
            let factor = factor
                .parse()
                .ok()
                .filter(|factor| (0.0..=FACTOR_MAX).contains(factor))
                .ok_or_else(|| NoiseError::Factor(factor.to_owned()))?;
            noise = noise
                .with(part, factor)
                .ok_or_else(|| NoiseError::Part(word.to_owned()))?;
        }
        Ok(noise)
    }
}

impl Noise {
    /// One part of it times a factor; `None` = there is no such part.
    fn with(self, part: &str, factor: f64) -> Option<Self> {
        let all = self.scaled(factor);
        Some(match part {
            "wheel-scale" => Self {
                encoder_scale: all.encoder_scale,
                ..self
            },
            "wheels" => Self {
                asymmetry_rad_per_m: all.asymmetry_rad_per_m,
                turn_scale: all.turn_scale,
                slip_m_per_sqrt_m: all.slip_m_per_sqrt_m,
                slip_rad_per_sqrt_m: all.slip_rad_per_sqrt_m,
                backlash_m: all.backlash_m,
                ..self
            },
            "gyro" => Self {
                gyro_walk_rad_per_sqrt_s: all.gyro_walk_rad_per_sqrt_s,
                gyro_scale: all.gyro_scale,
                gyro_bias_rad_per_s: all.gyro_bias_rad_per_s,
                gyro_drift_rad_per_s_sqrt_s: all.gyro_drift_rad_per_s_sqrt_s,
                gyro_warming_rad_per_s_k: all.gyro_warming_rad_per_s_k,
                ..self
            },
            "infrared" => Self {
                infrared_noise: all.infrared_noise,
                infrared_albedo: all.infrared_albedo,
                infrared_dropout: all.infrared_dropout,
                ..self
            },
            "rugs" => Self {
                rug_drift: self.rug_drift * factor,
                ..self
            },
            "analog" => Self {
                analog: all.analog,
                ..self
            },
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Noise, NoiseError};

    #[test]
    fn a_class_is_named_alone_or_with_parts_that_differ_from_it() -> Result<(), NoiseError> {
        assert_eq!("bad".parse(), Ok(Noise::bad()));
        let noise: Noise = "nominal,gyro=0, wheel-scale=2".parse()?;
        let nominal = Noise::nominal();
        assert_eq!(noise.gyro_scale, 0.0);
        assert_eq!(noise.gyro_walk_rad_per_sqrt_s, 0.0);
        assert_eq!(noise.encoder_scale, 2.0 * nominal.encoder_scale);
        assert_eq!(noise.slip_m_per_sqrt_m, nominal.slip_m_per_sqrt_m);
        assert_eq!(noise.infrared_noise, nominal.infrared_noise);
        assert_eq!("bad,rugs=0".parse::<Noise>()?.rug_drift, 0.0);
        Ok(())
    }

    #[test]
    fn each_part_changes_what_no_other_does_and_all_together_are_the_class() {
        let all = "nominal,wheel-scale=0.5,wheels=0.5,gyro=0.5,infrared=0.5,analog=0.5";
        assert_eq!(all.parse(), Ok(Noise::good()));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |text: &str| text.parse::<Noise>().unwrap_err();
        assert_eq!(error("loud"), NoiseError::Class("loud".to_owned()));
        assert_eq!(error(""), NoiseError::Class(String::new()));
        assert_eq!(error("nominal,gyro"), NoiseError::Part("gyro".to_owned()));
        assert_eq!(error("nominal,lidar=0"), NoiseError::Part("lidar=0".to_owned()));
        for factor in ["-1", "NaN", "inf", "eleven", "11", ""] {
            let text = format!("nominal,gyro={factor}");
            assert_eq!(error(&text), NoiseError::Factor(factor.to_owned()));
        }
    }
}
