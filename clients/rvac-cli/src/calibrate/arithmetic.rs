//! From raw readings to values. Whole numbers in, whole numbers out, in the units of the catalog.

use std::f64::consts::TAU;

/// Why readings give no value.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub(crate) enum NoValue {
    /// Nothing moved.
    #[error("the readings did not change: {0}")]
    Still(&'static str),
    /// The two wheels tell different stories.
    #[error("the wheels went {left} and {right} counts, which differ too much: {advice}")]
    Unequal {
        /// Counts of the left wheel.
        left: i64,
        /// Counts of the right wheel.
        right: i64,
        /// What to do.
        advice: &'static str,
    },
    /// No reading came.
    #[error("no reading came")]
    Empty,
}

/// Change of both totals, across their wrap.
pub(crate) fn travelled(before: (i32, i32), after: (i32, i32)) -> (i64, i64) {
    (
        i64::from(after.0.wrapping_sub(before.0)),
        i64::from(after.1.wrapping_sub(before.1)),
    )
}

/// Way of one count in nm after a push of `way_mm`. Signs of the wheels do not matter yet.
pub(crate) fn count_way_nm((left, right): (i64, i64), way_mm: i64) -> Result<i64, NoValue> {
    let (left, right) = (left.abs(), right.abs());
    let sum = left + right;
    if left.min(right) < 10 {
        return Err(NoValue::Still(
            "push the robot the whole way, and check the encoders' plug",
        ));
    }
    if (left - right).abs() * 10 > sum {
        return Err(NoValue::Unequal {
            left,
            right,
            advice: "push straight ahead and press no wheel off the floor",
        });
    }
    Ok((way_mm * 2_000_000 + sum / 2) / sum)
}

/// Track in µm after `turns` on the spot: the rims go opposite ways round a circle of the track's diameter.
pub(crate) fn track_um((left, right): (i64, i64), turns: i64, count_way_nm: i64) -> Result<i64, NoValue> {
    let (left, right) = (left.abs(), right.abs());
    if left.min(right) < 10 {
        return Err(NoValue::Still(
            "turn the robot about its middle, with both wheels on the floor",
        ));
    }
    if (left - right).abs() * 5 > left + right {
        return Err(NoValue::Unequal {
            left,
            right,
            advice: "turn it about the point between its wheels",
        });
    }
    let rim_nm = (left + right) as f64 * count_way_nm as f64;
    Ok((rim_nm / (TAU * turns as f64) / 1e3).round() as i64)
}

/// 0 when the total grew by a turn forward, 1 when the lines must be taken the other way round.
pub(crate) fn line_order(count: i64) -> Result<i64, NoValue> {
    match count {
        -9..=9 => Err(NoValue::Still("turn this wheel forward, at least a quarter")),
        10.. => Ok(0),
        _ => Ok(1),
    }
}

/// Mean in thousandths of a count.
pub(crate) fn mean_milli(readings: &[i64]) -> Result<i64, NoValue> {
    let count = i64::try_from(readings.len()).unwrap_or(i64::MAX);
    if count == 0 {
        return Err(NoValue::Empty);
    }
    let sum: i64 = readings.iter().sum();
    Ok((sum * 1000 + count.signum() * count / 2).div_euclid(count))
}

/// Mean, rounded to a whole count.
pub(crate) fn mean(readings: &[i64]) -> Result<i64, NoValue> {
    mean_milli(readings).map(|milli| (milli + 500).div_euclid(1000))
}

/// Spread between the least and the greatest reading.
pub(crate) fn spread(readings: &[i64]) -> Result<i64, NoValue> {
    let (least, greatest) = (readings.iter().min(), readings.iter().max());
    least
        .zip(greatest)
        .map(|(least, greatest)| greatest - least)
        .ok_or(NoValue::Empty)
}

/// µV of a count when a pack of `pack_mv` gives this mean.
pub(crate) fn scale_uv(pack_mv: i64, mean_milli: i64) -> Result<i64, NoValue> {
    if mean_milli < 1000 {
        return Err(NoValue::Still("the converter sees no pack: is it plugged in?"));
    }
    Ok((pack_mv * 1_000_000 + mean_milli / 2) / mean_milli)
}

/// mm/s of a way in nm; nm per ms are µm/s.
pub(crate) fn speed_mm_per_s(way_nm: i64, elapsed_ms: i64) -> Result<i64, NoValue> {
    if elapsed_ms < 100 || way_nm == 0 {
        return Err(NoValue::Still("the wheels did not run"));
    }
    Ok((way_nm / elapsed_ms + 500) / 1000)
}

#[cfg(test)]
mod tests {
    use super::{
        NoValue, count_way_nm, line_order, mean, mean_milli, scale_uv, speed_mm_per_s, spread, track_um,
        travelled,
    };

    #[test]
    fn a_metre_of_pushing_gives_the_way_of_a_count() {
        assert_eq!(count_way_nm((2000, -2000), 1000), Ok(500_000));
        assert_eq!(count_way_nm((1990, 2010), 1000), Ok(500_000));
        assert!(matches!(count_way_nm((0, 2000), 1000), Err(NoValue::Still(_))));
        assert!(matches!(
            count_way_nm((1000, 2000), 1000),
            Err(NoValue::Unequal {
                left: 1000,
                right: 2000,
                ..
            })
        ));
    }

    #[test]
    fn ten_turns_give_the_track() {
        // 0.23 m between the wheels: each rim goes 10 pi 0.23 m = 7.2257 m, which is 14,451 counts of 0.5 mm.
        let track = track_um((-14_451, 14_451), 10, 500_000).expect("turned");
        assert!((track - 230_000).abs() < 20, "{track}");
        assert!(matches!(track_um((3, 4), 10, 500_000), Err(NoValue::Still(_))));
    }

    #[test]
    fn totals_may_wrap_while_a_wheel_turns() {
        let moved = travelled((i32::MAX - 1, i32::MIN + 1), (i32::MIN + 8, i32::MAX - 9));
        assert_eq!(moved, (10, -11));
        assert_eq!(line_order(moved.0), Ok(0));
        assert_eq!(line_order(moved.1), Ok(1));
        assert!(line_order(3).is_err());
    }

    #[test]
    fn means_are_rounded_and_need_readings() {
        assert_eq!(mean(&[1, 2, 2]), Ok(2));
        assert_eq!(mean_milli(&[1, 2]), Ok(1500));
        assert_eq!(mean_milli(&[-1, -2]), Ok(-1500));
        assert_eq!(mean(&[]), Err(NoValue::Empty));
        assert_eq!(spread(&[5, 9, 7]), Ok(4));
    }

    #[test]
    fn a_way_in_a_time_is_a_speed() {
        assert_eq!(speed_mm_per_s(240_000_000, 500), Ok(480));
        assert!(speed_mm_per_s(240_000_000, 20).is_err());
    }

    #[test]
    fn a_multimeter_gives_the_scale_of_the_pack() {
        assert_eq!(scale_uv(16_275, 500_000), Ok(32_550));
        assert!(scale_uv(16_000, 0).is_err());
    }
}
