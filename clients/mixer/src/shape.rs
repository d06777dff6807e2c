//! Curves: from -1..=1 to -1..=1.

/// Bends a straight line: 0 leaves it, towards 1 the middle is gentler and the ends steeper, towards -1 the reverse.
/// Both ends and the middle stay where they are.
#[must_use]
pub fn with_expo(value: f64, expo: f64) -> f64 {
    let bent = if expo >= 0.0 {
        value.powi(3)
    } else {
        value.signum() * (1.0 - (1.0 - value.abs()).powi(3))
    };
    let share = expo.abs().min(1.0);
    ((1.0 - share) * value + share * bent).clamp(-1.0, 1.0)
}

/// The value on straight pieces between points whose first numbers rise from -1 to 1. Without points it is the value.
#[must_use]
pub fn curved(value: f64, points: &[[f64; 2]]) -> f64 {
    for pair in points.windows(2) {
        let [[from, low], [to, high]] = [pair[0], pair[1]];
        if value <= to {
            let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
            return low + share * (high - low);
        }
    }
    points.last().map_or(value, |[_, high]| *high)
}

#[cfg(test)]
mod tests {
    use super::{curved, with_expo};

    #[test]
    fn expo_keeps_ends_and_middle() {
        for expo in [-1.0, -0.3, 0.0, 0.5, 1.0] {
            for fixed in [-1.0, 0.0, 1.0] {
                assert!(
                    (with_expo(fixed, expo) - fixed).abs() < 1e-12,
                    "{expo} at {fixed}"
                );
            }
        }
        assert!(with_expo(0.5, 0.5) < 0.5 && with_expo(0.5, -0.5) > 0.5);
        assert!(
            (with_expo(-0.5, 0.5) + with_expo(0.5, 0.5)).abs() < 1e-12,
            "the same on both sides"
        );
    }

    #[test]
    fn a_curve_goes_through_its_points() {
        let points = [[-1.0, 0.0], [0.0, 0.25], [1.0, 1.0]];
        for [at, height] in points {
            assert!((curved(at, &points) - height).abs() < 1e-12);
        }
        assert!((curved(0.5, &points) - 0.625).abs() < 1e-12);
        assert!((curved(0.3, &[]) - 0.3).abs() < 1e-12);
    }
}
