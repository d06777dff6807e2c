//! Angles in radians, counter-clockwise positive.

use core::f64::consts::{PI, TAU};

/// The equivalent angle within -pi..=pi.
#[must_use]
pub fn normalize_rad(angle_rad: f64) -> f64 {
    let wrapped = angle_rad - TAU * libm::floor((angle_rad + PI) / TAU);
    if wrapped > PI { PI } else { wrapped }
}

/// A sense of rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnSide {
    /// Counter-clockwise.
    Left,
    /// Clockwise.
    Right,
}

impl TurnSide {
    /// +1 for left, -1 for right.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// The opposite side.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::normalize_rad;
    use core::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn every_angle_is_normalized_to_one_turn() {
        for turns in -5..=5 {
            let angle = FRAC_PI_2 + f64::from(turns) * 2.0 * PI;
            assert!((normalize_rad(angle) - FRAC_PI_2).abs() < 1e-12);
        }
        assert!(normalize_rad(3.0 * PI).abs() <= PI);
        assert!(normalize_rad(-3.0 * PI).abs() <= PI);
    }
}
