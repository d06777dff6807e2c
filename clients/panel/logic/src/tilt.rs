//! From the angles of a device in the hand to an input of the mixer.

/// A quarter turn in the browser's degrees.
const QUARTER_DEG: f64 = 90.0;

/// A device that is tilted. Its first position counts as level, because people hold a screen at an angle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tilt {
    level_deg: Option<[f64; 2]>,
}

impl Tilt {
    /// Forward and left, a quarter turn is 1. `beta_deg` is the top edge raised, `gamma_deg` the right edge lowered, as browsers
    /// say them; `screen_deg` is how far the picture is turned against the device.
    pub fn reading(&mut self, [beta_deg, gamma_deg]: [f64; 2], screen_deg: f64) -> Option<[f64; 2]> {
        if !(beta_deg.is_finite() && gamma_deg.is_finite() && screen_deg.is_finite()) {
            return None;
        }
        let level = *self.level_deg.get_or_insert([beta_deg, gamma_deg]);
        let forward = -wrapped(beta_deg - level[0]) / QUARTER_DEG;
        let left = -wrapped(gamma_deg - level[1]) / QUARTER_DEG;
        let (sin, cos) = screen_deg.to_radians().sin_cos();
        let limit = |value: f64| value.clamp(-1.0, 1.0);
        Some([
            limit(forward * cos - left * sin),
            limit(forward * sin + left * cos),
        ])
    }
}

/// The same angle within half a turn.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::Tilt;

    fn close(found: Option<[f64; 2]>, expected: [f64; 2]) -> bool {
        found.is_some_and(|found| (found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-9)
    }

    #[test]
    fn how_it_is_held_first_is_level() {
        let mut tilt = Tilt::default();
        assert_eq!(tilt.reading([f64::NAN, 0.0], 0.0), None);
        assert!(close(tilt.reading([40.0, 5.0], 0.0), [0.0, 0.0]));
        assert!(close(tilt.reading([-5.0, 5.0], 0.0), [0.5, 0.0]), "top edge down");
        assert!(
            close(tilt.reading([40.0, -40.0], 0.0), [0.0, 0.5]),
            "left edge down"
        );
        assert!(close(tilt.reading([179.0, 5.0], 0.0), [-1.0, 0.0]));
    }

    /// The picture is turned by a quarter to the left: the right edge of the device is the top of the picture.
    #[test]
    fn forward_is_where_the_top_of_the_picture_is() {
        let mut tilt = Tilt::default();
        tilt.reading([0.0, 0.0], 90.0);
        assert!(
            close(tilt.reading([0.0, 45.0], 90.0), [0.5, 0.0]),
            "right edge of the device down"
        );
        assert!(
            close(tilt.reading([-45.0, 0.0], 90.0), [0.0, 0.5]),
            "its top is the left of the picture"
        );
    }
}
