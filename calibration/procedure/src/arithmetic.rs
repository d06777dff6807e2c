//! From raw readings to values. Whole numbers in, whole numbers out, in the units of the catalog.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Distances in mm that suit the calibration of a count: on a shorter one the start and the end, which a person reads to some
/// millimetres, are more than a hundredth of it; a robot is hard to push farther in a straight line.
const PUSHED_MM: RangeInclusive<i64> = 500..=20_000;

/// Why readings give no value.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum NoValue {
    /// Nothing moved.
    #[error("the readings did not change: {0}")]
    Still(&'static str),
    /// The counts of the two wheels contradict each other.
    #[error("the wheels went {left} and {right} counts, which differ too much: {advice}")]
    Unequal {
        /// Counts of the left wheel.
        left: i64,
        /// Counts of the right wheel.
        right: i64,
        /// What to do.
        advice: &'static str,
    },
    /// A distance outside the range for a push along a measure.
    #[error(
        "{0} mm is no way to measure by: push it {least} to {most} mm, and type those",
        least = PUSHED_MM.start(), most = PUSHED_MM.end()
    )]
    Distance(i64),
    /// Some sensors answered and some did not.
    #[error(
        "the levels rose by {least} to {greatest}, which is neither yes nor no: keep it still over a light floor"
    )]
    Unclear {
        /// Rise of the one that rose least.
        least: i64,
        /// Rise of the one that rose most.
        greatest: i64,
    },
    /// The readings differ more than noise does.
    #[error(
        "the readings lie between {least} and {greatest}, too far apart: keep everything still meanwhile"
    )]
    Unsteady {
        /// Least reading.
        least: i64,
        /// Greatest reading.
        greatest: i64,
    },
    /// A floor that reads like a drop.
    #[error(
        "the levels rose by {0} counts only, so this floor can hardly be told from a drop: clean the sensors, or hold \
         the robot higher"
    )]
    Faint(i64),
    /// No reading came.
    #[error("no reading came")]
    Empty,
}

impl NoValue {
    /// Its name for clients, which have their own words for it.
    #[must_use]
    pub const fn reason(&self) -> &'static str {
        match self {
            Self::Still(_) => "calibration-still",
            Self::Unequal { .. } => "calibration-unequal",
            Self::Distance(_) => "calibration-distance",
            Self::Unclear { .. } => "calibration-unclear",
            Self::Unsteady { .. } => "calibration-unsteady",
            Self::Faint(_) => "calibration-faint",
            Self::Empty => "calibration-no-answer",
        }
    }
}

/// A figure of each driven wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wheels<T> {
    pub(crate) left: T,
    pub(crate) right: T,
}

/// Change of both totals, across their wrap.
pub(crate) fn travelled(before: Wheels<i32>, after: Wheels<i32>) -> Wheels<i64> {
    Wheels {
        left: i64::from(after.left.wrapping_sub(before.left)),
        right: i64::from(after.right.wrapping_sub(before.right)),
    }
}

/// Distance of one count in nm after a push of `distance_mm`. Signs of the wheels do not matter yet.
pub(crate) fn distance_per_count_nm(counts: Wheels<i64>, distance_mm: i64) -> Result<i64, NoValue> {
    if !PUSHED_MM.contains(&distance_mm) {
        return Err(NoValue::Distance(distance_mm));
    }
    let (left, right) = (counts.left.abs(), counts.right.abs());
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
    Ok((distance_mm * 2_000_000 + sum / 2) / sum)
}

/// Track in µm after `turns` on the spot: the rims go in opposite directions on a circle of the track's diameter.
pub(crate) fn track_um(counts: Wheels<i64>, turns: i64, distance_per_count_nm: i64) -> Result<i64, NoValue> {
    let (left, right) = (counts.left.abs(), counts.right.abs());
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
    let rim_nm = (left + right) as f64 * distance_per_count_nm as f64;
    Ok((rim_nm / (TAU * turns as f64) / 1e3).round() as i64)
}

/// 0 when the total grew by a turn forward, 1 when the lines must be swapped.
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

/// Mean of readings that differ by no more than noise, rounded to a whole count.
pub(crate) fn steady_mean(readings: &[i64]) -> Result<i64, NoValue> {
    /// A person who lets go, or a motor that runs on, moves a line by far more.
    const SPREAD_MAX: i64 = 24;
    let least = *readings.iter().min().ok_or(NoValue::Empty)?;
    let greatest = *readings.iter().max().ok_or(NoValue::Empty)?;
    if greatest - least > SPREAD_MAX {
        return Err(NoValue::Unsteady { least, greatest });
    }
    mean(readings)
}

/// The level that separates floor from drop when a floor lifts the least of the sensors by `rise`: as far from the one as from
/// the other.
pub(crate) fn between(rise: i64) -> Result<i64, NoValue> {
    /// A tenth of the converter's range on either side would be good; this is ten times its noise.
    const RISE_MIN: i64 = 60;
    if rise < RISE_MIN {
        return Err(NoValue::Faint(rise));
    }
    Ok(rise / 2)
}

/// How far the brightest sensor is above the dark, in readings of a line that a multiplexer switches through all
/// sensors, dark and lit: half of the readings are dark, and the brightest lie in the upper half of what is above them.
pub(crate) fn brightest(readings: &[i64]) -> Result<i64, NoValue> {
    let mut sorted = readings.to_vec();
    sorted.sort_unstable();
    let dark = *sorted.get(sorted.len() / 4).ok_or(NoValue::Empty)?;
    let most = *sorted.last().ok_or(NoValue::Empty)?;
    let bright = sorted.partition_point(|reading| 2 * reading < dark + most);
    let top = sorted.get(bright..).unwrap_or_default();
    Ok(top.get(top.len() / 2).ok_or(NoValue::Empty)? - dark)
}

/// How much levels rose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rises {
    pub(crate) least: i64,
    pub(crate) greatest: i64,
}

/// How much three levels rose between two moments.
pub(crate) fn rises(before: [i64; 3], after: [i64; 3]) -> Rises {
    let [left, middle, right] = [0, 1, 2].map(|sensor: usize| after[sensor] - before[sensor]);
    Rises {
        least: left.min(middle).min(right),
        greatest: left.max(middle).max(right),
    }
}

/// Whether a line lights three sensors: 1 if all of them see it, 0 if none does.
pub(crate) fn follows(Rises { least, greatest }: Rises) -> Result<i64, NoValue> {
    /// A lit floor is far above this, noise far below.
    const SEEN: i64 = 30;
    if least >= SEEN {
        Ok(1)
    } else if greatest.abs().max(least.abs()) < SEEN / 2 {
        Ok(0)
    } else {
        Err(NoValue::Unclear { least, greatest })
    }
}

/// µA of a count when a current rose by so much and the mean of the readings by so much.
pub(crate) fn current_scale_ua(rise_ma: i64, rise_milli: i64) -> Result<i64, NoValue> {
    if rise_ma.abs() < 50 || rise_milli.abs() < 2_000 {
        return Err(NoValue::Still(
            "hold the wheel fast, so that its motor draws a current that can be seen",
        ));
    }
    Ok((rise_ma * 1_000_000 + rise_milli.abs() / 2 * rise_ma.signum()) / rise_milli)
}

/// mA of a held wheel at full duty when its reading rose by so much at `permille` of it.
pub(crate) fn stall_ma(rise_milli: i64, scale_ua: i64, permille: i64) -> Result<i64, NoValue> {
    let held_ma = rise_milli * scale_ua / 1_000_000;
    if held_ma < 50 {
        return Err(NoValue::Still(
            "hold the wheel fast, so that its motor draws a current that can be seen",
        ));
    }
    Ok(held_ma * 1_000 / permille)
}

/// Events a second.
pub(crate) fn rate_per_s(events: i64, elapsed_ms: i64) -> Result<i64, NoValue> {
    if elapsed_ms < 100 || events == 0 {
        return Err(NoValue::Still("nothing turned, or its encoder is not plugged in"));
    }
    Ok((events * 1000 + elapsed_ms / 2) / elapsed_ms)
}

/// A speed at this voltage of the pack as it is at the nominal one of twelve cells: motors turn in proportion.
pub(crate) fn at_nominal(speed_mm_per_s: i64, pack_mv: i64) -> Result<i64, NoValue> {
    const NOMINAL_MV: i64 = 14_400;
    if pack_mv < NOMINAL_MV / 2 {
        return Err(NoValue::Still("the converter sees no pack: is it plugged in?"));
    }
    Ok((speed_mm_per_s * NOMINAL_MV + pack_mv / 2) / pack_mv)
}

/// µV of a count when a pack of `pack_mv` gives this mean.
pub(crate) fn scale_uv(pack_mv: i64, mean_milli: i64) -> Result<i64, NoValue> {
    if mean_milli < 1000 {
        return Err(NoValue::Still("the converter sees no pack: is it plugged in?"));
    }
    Ok((pack_mv * 1_000_000 + mean_milli / 2) / mean_milli)
}

/// mm/s of a distance in nm; nm per ms are µm/s.
pub(crate) fn speed_mm_per_s(distance_nm: i64, elapsed_ms: i64) -> Result<i64, NoValue> {
    if elapsed_ms < 100 || distance_nm == 0 {
        return Err(NoValue::Still("the wheels did not run"));
    }
    Ok((distance_nm / elapsed_ms + 500) / 1000)
}

#[cfg(test)]
mod tests {
    use super::{
        NoValue, Wheels, at_nominal, between, brightest, current_scale_ua, distance_per_count_nm, follows,
        line_order, mean, mean_milli, rate_per_s, rises, scale_uv, speed_mm_per_s, stall_ma, steady_mean,
        track_um, travelled,
    };

    fn wheels<T>(left: T, right: T) -> Wheels<T> {
        Wheels { left, right }
    }

    #[test]
    fn a_push_along_a_measure_gives_the_way_of_a_count() {
        assert_eq!(distance_per_count_nm(wheels(2000, -2000), 1000), Ok(500_000));
        assert_eq!(distance_per_count_nm(wheels(1990, 2010), 1000), Ok(500_000));
        assert_eq!(distance_per_count_nm(wheels(6100, 6100), 3050), Ok(500_000));
        for distance_mm in [-1000, 0, 3, 499, 20_001, 999_999_999] {
            assert_eq!(
                distance_per_count_nm(wheels(2000, 2000), distance_mm),
                Err(NoValue::Distance(distance_mm))
            );
        }
        assert!(matches!(
            distance_per_count_nm(wheels(0, 2000), 1000),
            Err(NoValue::Still(_))
        ));
        assert!(matches!(
            distance_per_count_nm(wheels(1000, 2000), 1000),
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
        let track = track_um(wheels(-14_451, 14_451), 10, 500_000).expect("turned");
        assert!((track - 230_000).abs() < 20, "{track}");
        assert!(matches!(
            track_um(wheels(3, 4), 10, 500_000),
            Err(NoValue::Still(_))
        ));
    }

    #[test]
    fn totals_may_wrap_while_a_wheel_turns() {
        let moved = travelled(
            wheels(i32::MAX - 1, i32::MIN + 1),
            wheels(i32::MIN + 8, i32::MAX - 9),
        );
        assert_eq!(moved, wheels(10, -11));
        assert_eq!(line_order(moved.left), Ok(0));
        assert_eq!(line_order(moved.right), Ok(1));
        assert!(line_order(3).is_err());
    }

    #[test]
    fn means_are_rounded_and_need_readings() {
        assert_eq!(mean(&[1, 2, 2]), Ok(2));
        assert_eq!(mean_milli(&[1, 2]), Ok(1500));
        assert_eq!(mean_milli(&[-1, -2]), Ok(-1500));
        assert_eq!(mean(&[]), Err(NoValue::Empty));
    }

    #[test]
    fn a_level_that_moves_is_no_level() {
        assert_eq!(steady_mean(&[500, 512, 488]), Ok(500));
        assert_eq!(
            steady_mean(&[500, 500, 250]),
            Err(NoValue::Unsteady {
                least: 250,
                greatest: 500
            })
        );
        assert_eq!(steady_mean(&[]), Err(NoValue::Empty));
    }

    #[test]
    fn a_floor_must_stand_out_from_a_drop() {
        assert_eq!(between(633), Ok(316));
        assert_eq!(between(59), Err(NoValue::Faint(59)));
    }

    #[test]
    fn the_brightest_of_seven_sensors_stands_out_of_dark_and_lit_readings() {
        let looks = |lit: [i64; 7]| -> Vec<i64> {
            let round = lit.into_iter().flat_map(|level| [60, 60 + level]);
            round
                .cycle()
                .zip([-1, 0, 1, 0, 0].into_iter().cycle())
                .map(|(level, noise)| level + noise)
                .take(140)
                .collect()
        };
        assert_eq!(brightest(&looks([6; 7])), Ok(6));
        assert_eq!(brightest(&looks([6, 6, 700, 6, 6, 6, 6])), Ok(700));
        assert_eq!(brightest(&looks([6, 6, 6, 40, 6, 6, 6])), Ok(40));
        assert_eq!(brightest(&[]), Err(NoValue::Empty));
    }

    #[test]
    fn a_line_lights_all_three_sensors_or_none() {
        assert_eq!(follows(rises([40, 41, 39], [720, 680, 700])), Ok(1));
        assert_eq!(follows(rises([40, 41, 39], [42, 40, 38])), Ok(0));
        let one = follows(rises([40, 41, 39], [720, 41, 40]));
        assert_eq!(
            one,
            Err(NoValue::Unclear {
                least: 0,
                greatest: 680
            })
        );
        assert!(follows(rises([700; 3], [40; 3])).is_err(), "darker is no light");
    }

    #[test]
    fn currents_and_rates_are_rises_over_rises() {
        assert_eq!(current_scale_ua(1_600, 400_000), Ok(4_000));
        assert_eq!(current_scale_ua(1_600, -400_000), Ok(-4_000));
        assert!(current_scale_ua(10, 400_000).is_err());
        assert!(current_scale_ua(1_600, 500).is_err());
        assert_eq!(stall_ma(120_000, 4_000, 300), Ok(1_600));
        assert_eq!(stall_ma(-120_000, -4_000, 300), Ok(1_600));
        assert!(stall_ma(1_000, 4_000, 300).is_err());
        assert_eq!(rate_per_s(100, 1_000), Ok(100));
        assert!(rate_per_s(0, 1_000).is_err());
    }

    #[test]
    fn a_way_in_a_time_is_a_speed() {
        assert_eq!(speed_mm_per_s(240_000_000, 500), Ok(480));
        assert!(speed_mm_per_s(240_000_000, 20).is_err());
        assert_eq!(at_nominal(567, 17_000), Ok(480));
        assert!(at_nominal(567, 0).is_err());
    }

    #[test]
    fn a_multimeter_gives_the_scale_of_the_pack() {
        assert_eq!(scale_uv(16_275, 500_000), Ok(32_550));
        assert!(scale_uv(16_000, 0).is_err());
    }
}
