//! Two poses over time, the believed and the true one, and how far they are apart.

use std::time::Instant;

/// Longest gap between two believed poses that is bridged by a straight line, in seconds on the wall.
const GAP_S: f64 = 0.5;

/// A place at a moment.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Instant,
    x_m: f64,
    y_m: f64,
}

/// Collects both poses by their time of arrival.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    believed: Vec<Sample>,
    real: Vec<Sample>,
}

impl Trace {
    /// Notes where the robot believes to be.
    pub(crate) fn believe(&mut self, at: Instant, pose: &rvac_api::Pose) {
        self.believed.push(Sample {
            at,
            x_m: pose.x,
            y_m: pose.y,
        });
    }

    /// Notes where it really is.
    pub(crate) fn reveal(&mut self, at: Instant, pose: &rvac_api::Pose) {
        self.real.push(Sample {
            at,
            x_m: pose.x,
            y_m: pose.y,
        });
    }

    /// Root of the mean squared distance over all true poses that lie between two believed ones; `None` without any.
    pub(crate) fn rmse_m(&self) -> Option<f64> {
        let mut sum = 0.0;
        let mut count = 0_u32;
        for real in &self.real {
            if let Some((x_m, y_m)) = self.believed_at(real.at) {
                sum += (real.x_m - x_m).powi(2) + (real.y_m - y_m).powi(2);
                count += 1;
            }
        }
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    }

    fn believed_at(&self, at: Instant) -> Option<(f64, f64)> {
        let next = self.believed.partition_point(|sample| sample.at < at);
        let (before, after) = (self.believed.get(next.checked_sub(1)?)?, self.believed.get(next)?);
        let gap_s = after.at.duration_since(before.at).as_secs_f64();
        if gap_s > GAP_S {
            return None;
        }
        let share = if gap_s > 0.0 {
            at.duration_since(before.at).as_secs_f64() / gap_s
        } else {
            0.0
        };
        Some((
            before.x_m + share * (after.x_m - before.x_m),
            before.y_m + share * (after.y_m - before.y_m),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::Trace;
    use rvac_api::Pose;
    use std::time::{Duration, Instant};

    fn pose(x: f64) -> Pose {
        Pose { x, ..Pose::default() }
    }

    #[test]
    fn a_true_pose_is_compared_with_the_line_between_two_believed_ones() {
        let start = Instant::now();
        let mut trace = Trace::default();
        trace.believe(start, &pose(0.0));
        trace.believe(start + Duration::from_millis(100), &pose(1.0));
        trace.reveal(start + Duration::from_millis(50), &pose(0.8));
        let rmse_m = trace.rmse_m().expect("one pair");
        assert!((rmse_m - 0.3).abs() < 1e-9, "{rmse_m}");
    }

    #[test]
    fn poses_without_neighbours_do_not_count() {
        let start = Instant::now();
        let mut trace = Trace::default();
        trace.believe(start, &pose(0.0));
        trace.believe(start + Duration::from_secs(9), &pose(1.0));
        trace.reveal(start + Duration::from_secs(1), &pose(5.0));
        trace.reveal(start + Duration::from_secs(10), &pose(5.0));
        assert_eq!(trace.rmse_m(), None);
    }
}
