//! Distances between the robot's estimated and true pose.

use crate::report::RootMeanSquare;

/// Moments of the job whose error is reported, seconds.
const MARKS_S: [f64; 4] = [600.0, 1_800.0, 3_600.0, 7_200.0];
/// The error at a moment is that of so many seconds before it.
const WINDOW_S: f64 = 120.0;

/// Errors of the whole run and around each mark.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PoseError {
    whole: RootMeanSquare,
    heading: RootMeanSquare,
    windows: [RootMeanSquare; MARKS_S.len()],
    job_s: f64,
    max_m: f64,
}

impl PoseError {
    pub(super) fn sample(&mut self, job_s: f64, error_m: f64, error_rad: f64) {
        self.whole.add(error_m);
        self.heading.add(error_rad);
        self.max_m = self.max_m.max(error_m);
        self.job_s = job_s;
        for (window, mark_s) in self.windows.iter_mut().zip(MARKS_S) {
            if job_s > mark_s - WINDOW_S && job_s <= mark_s {
                window.add(error_m);
            }
        }
    }

    /// The error at each mark that has been passed.
    pub(super) fn at_marks(&self) -> [Option<f64>; MARKS_S.len()] {
        core::array::from_fn(|number| {
            (self.job_s >= MARKS_S[number])
                .then(|| self.windows[number].value())
                .flatten()
        })
    }

    pub(super) fn rmse_m(&self) -> Option<f64> {
        self.whole.value()
    }

    pub(super) fn heading_rmse_rad(&self) -> Option<f64> {
        self.heading.value()
    }

    pub(super) const fn max_m(&self) -> f64 {
        self.max_m
    }
}

#[cfg(test)]
mod tests {
    use super::PoseError;

    #[test]
    fn the_error_at_a_mark_is_that_of_the_two_minutes_before_it() {
        let mut error = PoseError::default();
        for second in 0..=700 {
            let error_m = if (500..600).contains(&second) { 0.3 } else { 0.1 };
            error.sample(f64::from(second), error_m, 0.0);
        }
        let [at_10, at_30, ..] = error.at_marks();
        let wanted = ((100.0 * 0.09 + 20.0 * 0.01) / 120.0_f64).sqrt();
        assert!((at_10.unwrap() - wanted).abs() < 1e-9);
        assert_eq!(at_30, None);
        assert_eq!(error.max_m(), 0.3);
    }
}
