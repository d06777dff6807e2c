//! Error of the estimated path after a rigid alignment with the true path: an error of the map's frame, which the
//! robot's map shares, does not affect the robot.

use home::Pose;

use super::Belief;
use super::honesty::WRONG_M;
use super::nees::of_place;

/// Median of the mean of two squared normal errors: half of a chi-square with two degrees of freedom.
const MEDIAN_OF_TRUE: f64 = core::f64::consts::LN_2;
/// Places are kept once in so long, milliseconds.
const KEEP_MS: u64 = 1_000;

/// Sums over pairs of believed and true places, and some of the pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct Alignment {
    count: f64,
    believed: [f64; 2],
    is: [f64; 2],
    squares: f64,
    /// Of the products along, and of those across.
    dot: f64,
    cross: f64,
    kept: Vec<AlignmentSample>,
}

/// One moment.
#[derive(Clone, Copy, Debug)]
struct AlignmentSample {
    time_ms: u64,
    believed: [f64; 2],
    is: [f64; 2],
    sigma_m: f64,
    says_lost: bool,
    on_dock: bool,
}

/// A distribution of errors, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ErrorSpread {
    pub(super) median: f64,
    pub(super) p90: f64,
}

/// What is left of the error at single moments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LeftOver {
    /// The largest distance, metres.
    pub(super) max_m: f64,
    /// Seconds with a wrong pose that the robot reported as known.
    pub(super) unnoticed_s: f64,
    /// Median and 90th percentile of the distance; `None` without samples.
    pub(super) error: Option<ErrorSpread>,
    /// Mean of the error squared over its reported variance, for each dimension, while the robot claims to know its pose and is off
    /// its dock.
    pub(super) nees: Option<f64>,
    /// Median of the same over that of a true deviation.
    pub(super) nees_median: Option<f64>,
}

impl Alignment {
    pub(super) fn sample(&mut self, (now_ms, on_dock): (u64, bool), belief: &Belief, is: Pose) {
        let ([a, b], [x, y]) = ([belief.pose.x_m, belief.pose.y_m], [is.x_m, is.y_m]);
        self.count += 1.0;
        self.believed = [self.believed[0] + a, self.believed[1] + b];
        self.is = [self.is[0] + x, self.is[1] + y];
        self.squares += a * a + b * b + x * x + y * y;
        self.dot += a * x + b * y;
        self.cross += a * y - b * x;
        let last = self.kept.last();
        if last.is_none_or(|last| now_ms >= last.time_ms + KEEP_MS) {
            self.kept.push(AlignmentSample {
                time_ms: now_ms,
                believed: [a, b],
                is: [x, y],
                sigma_m: belief.sigma.place_m,
                says_lost: belief.lost,
                on_dock,
            });
        }
    }

    /// Root mean square of the distances that are left; `None` without samples.
    pub(super) fn rmse_m(&self) -> Option<f64> {
        if self.count == 0.0 {
            return None;
        }
        let ([a, b], [x, y]) = (self.believed, self.is);
        let squares = self.squares - (a * a + b * b + x * x + y * y) / self.count;
        let (dot, cross) = self.turn();
        Some(((squares - 2.0 * dot.hypot(cross)) / self.count).max(0.0).sqrt())
    }

    /// Cosine and sine of the rotation that aligns the estimated path with the true one, times a common length.
    fn turn(&self) -> (f64, f64) {
        let ([a, b], [x, y]) = (self.believed, self.is);
        (
            self.dot - (a * x + b * y) / self.count,
            self.cross - (a * y - b * x) / self.count,
        )
    }

    /// What is left at single moments.
    pub(super) fn left_over(&self) -> LeftOver {
        let (dot, cross) = self.turn();
        let length = dot.hypot(cross);
        let (cos, sin) = if length > 0.0 {
            (dot / length, cross / length)
        } else {
            (1.0, 0.0)
        };
        let [a, b] = self.believed.map(|sum| sum / self.count);
        let [x, y] = self.is.map(|sum| sum / self.count);
        let mut left = LeftOver::default();
        let mut before_ms = 0;
        let (mut errors_m, mut squares) = (Vec::with_capacity(self.kept.len()), Vec::new());
        for kept in &self.kept {
            let (from_a, from_b) = (kept.believed[0] - a, kept.believed[1] - b);
            let off_x = x + cos * from_a - sin * from_b - kept.is[0];
            let off_y = y + sin * from_a + cos * from_b - kept.is[1];
            let off_m = off_x.hypot(off_y);
            left.max_m = left.max_m.max(off_m);
            if off_m > WRONG_M && !kept.says_lost {
                left.unnoticed_s += (kept.time_ms - before_ms) as f64 / 1000.0;
            }
            before_ms = kept.time_ms;
            errors_m.push(off_m);
            if !kept.says_lost && !kept.on_dock {
                squares.push(of_place(off_m, kept.sigma_m));
            }
        }
        LeftOver {
            error: spread(errors_m),
            nees_median: spread(squares.clone()).map(|squares| squares.median / MEDIAN_OF_TRUE),
            nees: (!squares.is_empty()).then(|| squares.iter().sum::<f64>() / squares.len() as f64),
            ..left
        }
    }

    /// Errors at single moments without any alignment.
    pub(super) fn placed(&self) -> Option<ErrorSpread> {
        let off_m =
            |kept: &AlignmentSample| (kept.believed[0] - kept.is[0]).hypot(kept.believed[1] - kept.is[1]);
        spread(self.kept.iter().map(off_m).collect())
    }

    /// Median of the reported deviation of the position.
    pub(super) fn sigma_median_m(&self) -> Option<f64> {
        spread(self.kept.iter().map(|kept| kept.sigma_m).collect()).map(|spread| spread.median)
    }
}

/// Nearest rank.
fn spread(mut values: Vec<f64>) -> Option<ErrorSpread> {
    values.sort_by(f64::total_cmp);
    let rank = |share: f64| {
        let rank = (share * values.len() as f64).ceil() as usize;
        values.get(rank.checked_sub(1)?).copied()
    };
    Some(ErrorSpread {
        median: rank(0.5)?,
        p90: rank(0.9)?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Belief, Sigma};
    use super::{Alignment, ErrorSpread, LeftOver, spread};
    use home::Pose;

    fn belief(pose: Pose, lost: bool) -> Belief {
        Belief {
            pose,
            state: None,
            lost,
            sigma: Sigma {
                place_m: 0.1,
                heading_rad: 0.1,
            },
            awaits_charge: false,
        }
    }

    fn way(bend: f64, says_lost: impl Fn(u64) -> bool) -> Alignment {
        let mut alignment = Alignment::default();
        for step in 0..100_u32 {
            let (x_m, y_m) = (0.1 * f64::from(step), 3.0 * f64::from(step % 2));
            let (sin, cos) = 0.3_f64.sin_cos();
            let turned = Pose::new(x_m * cos - y_m * sin + 5.0, x_m * sin + y_m * cos - 1.0, 0.0);
            let is = Pose::new(x_m, y_m + bend * x_m * x_m, 0.0);
            let now_ms = 2_000 * u64::from(step + 1);
            alignment.sample((now_ms, false), &belief(turned, says_lost(now_ms)), is);
            // So soon after it is not kept.
            alignment.sample((now_ms + 1, false), &belief(turned, false), is);
        }
        alignment
    }

    #[test]
    fn a_frame_that_is_turned_and_shifted_is_no_error_and_what_bends_is() {
        let straight = way(0.0, |_| false);
        assert!(straight.rmse_m().unwrap() < 1e-5, "{straight:?}");
        let LeftOver {
            max_m,
            unnoticed_s,
            error,
            nees,
            nees_median,
        } = straight.left_over();
        assert!(max_m < 1e-5, "{max_m} m");
        assert_eq!(unnoticed_s, 0.0);
        assert!(error.is_some_and(|error| error.p90 < 1e-5), "{error:?}");
        assert!(nees.is_some_and(|nees| nees < 1e-5), "{nees:?}");
        assert!(nees_median.is_some_and(|nees| nees < 1e-5), "{nees_median:?}");
        assert!(straight.placed().is_some_and(|placed| placed.median > 1.0));
        assert_eq!(straight.sigma_median_m(), Some(0.1));
        let rmse_m = way(0.02, |_| false).rmse_m().unwrap();
        assert!(rmse_m > 0.1, "{rmse_m} m");
        assert_eq!(Alignment::default().rmse_m(), None);
        assert_eq!(Alignment::default().left_over(), LeftOver::default());
    }

    #[test]
    fn half_of_the_errors_are_below_the_median_and_a_tenth_above_the_percentile() {
        let errors = (1..=10).rev().map(f64::from).collect();
        let wanted = ErrorSpread {
            median: 5.0,
            p90: 9.0,
        };
        assert_eq!(spread(errors), Some(wanted));
        assert_eq!(spread(Vec::new()), None);
    }

    #[test]
    fn what_is_left_counts_while_the_robot_does_not_say_that_it_is_lost() {
        let unaware = way(0.1, |_| false).left_over();
        assert!(unaware.max_m > 0.5 && unaware.unnoticed_s > 20.0, "{unaware:?}");
        let aware = way(0.1, |_| true).left_over();
        assert_eq!(aware.max_m, unaware.max_m);
        assert_eq!(aware.unnoticed_s, 0.0);
        let late = way(0.1, |now_ms| now_ms > 100_000).left_over();
        assert!(
            0.0 < late.unnoticed_s && late.unnoticed_s < unaware.unnoticed_s,
            "{late:?}"
        );
    }

    #[test]
    fn the_deviation_of_a_robot_on_its_dock_says_nothing() {
        let mut random = home::Pcg::new(1, 1);
        let mut alignment = Alignment::default();
        for second in 0..4_000_u64 {
            let on_dock = second % 4 == 0;
            let off =
                [random.normal(), random.normal()].map(|draw| if on_dock { 5.0 * draw } else { 0.1 * draw });
            let at = Pose::new(random.symmetric(), random.symmetric(), 0.0);
            let believed = Pose::new(at.x_m + off[0], at.y_m + off[1], 0.0);
            alignment.sample((1_000 * second, on_dock), &belief(believed, false), at);
        }
        let left = alignment.left_over();
        assert!(
            left.nees.is_some_and(|nees| (0.8..3.0).contains(&nees)),
            "{left:?}"
        );
        assert!(
            left.nees_median
                .is_some_and(|median| (0.8..2.0).contains(&median)),
            "{left:?}"
        );
    }
}
