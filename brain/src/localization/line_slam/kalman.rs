//! A Kalman filter for the pose between two optimizations. It treats landmarks as fixed.

use crate::model::geometry::{Point2, Pose2, normalize_rad};

/// A pose and its covariance in the map: x, y, heading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Belief {
    pub(super) pose: Pose2,
    pub(super) covariance: [[f64; 3]; 3],
}

/// Variances of a step in the frame of its start, square metres and square radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StepVariance {
    pub(super) along_m2: f64,
    pub(super) across_m2: f64,
    pub(super) turn_rad2: f64,
}

/// No measurement reduces a variance below this: landmarks are not exact to the last centimetre.
const LEAST: [f64; 3] = [1.5e-4, 1.5e-4, 2.5e-5];

impl Belief {
    /// Predicts: moves by a step with this variance.
    pub(super) fn step(&mut self, step: Pose2, variance: StepVariance) {
        let before = self.pose;
        self.pose = before * step;
        let (dx_m, dy_m) = (self.pose.x_m - before.x_m, self.pose.y_m - before.y_m);
        let p = self.covariance;
        // The heading's error rotates the step.
        let tilt = [-dy_m, dx_m, 0.0];
        let mut next = p;
        for row in 0..3 {
            for column in 0..3 {
                next[row][column] +=
                    tilt[row] * p[2][column] + p[row][2] * tilt[column] + tilt[row] * tilt[column] * p[2][2];
            }
        }
        let (sin, cos) = libm::sincos(before.heading_rad);
        let StepVariance {
            along_m2,
            across_m2,
            turn_rad2,
        } = variance;
        next[0][0] += cos * cos * along_m2 + sin * sin * across_m2;
        next[1][1] += sin * sin * along_m2 + cos * cos * across_m2;
        let both = sin * cos * (along_m2 - across_m2);
        next[0][1] += both;
        next[1][0] += both;
        next[2][2] += turn_rad2;
        self.covariance = next;
    }

    /// Updates with a measurement of this variance: `slopes * (pose - true pose)` is `off`.
    pub(super) fn measure(&mut self, slopes: [f64; 3], off: f64, variance: f64) {
        let p = self.covariance;
        let mut gain = [0.0; 3];
        for (row, gain) in p.iter().zip(&mut gain) {
            *gain = row.iter().zip(slopes).map(|(entry, slope)| entry * slope).sum();
        }
        let total: f64 = variance
            + gain
                .iter()
                .zip(slopes)
                .map(|(one, slope)| one * slope)
                .sum::<f64>();
        // Written so that NaN is rejected.
        let is_sound = total > 0.0 && off.is_finite();
        if !is_sound {
            return;
        }
        let [x_m, y_m, turn_rad] = gain.map(|gain| -gain / total * off);
        self.pose = Pose2 {
            x_m: self.pose.x_m + x_m,
            y_m: self.pose.y_m + y_m,
            heading_rad: normalize_rad(self.pose.heading_rad + turn_rad),
        };
        for row in 0..3 {
            for column in 0..3 {
                self.covariance[row][column] -= gain[row] * gain[column] / total;
            }
            self.covariance[row][row] = self.covariance[row][row].max(LEAST[row]);
        }
    }

    /// Variance of the position along a direction, square metres.
    pub(super) fn variance_along_m2(&self, direction: Point2) -> f64 {
        let Point2 { x_m: x, y_m: y } = direction;
        let p = self.covariance;
        x * x * p[0][0] + 2.0 * x * y * p[0][1] + y * y * p[1][1]
    }

    /// Standard deviations of the position along its worst direction, metres, and of the heading, radians.
    pub(super) fn sigmas(&self) -> (f64, f64) {
        let p = self.covariance;
        let half = 0.5 * (p[0][0] - p[1][1]);
        let greatest = 0.5 * (p[0][0] + p[1][1]) + libm::sqrt(half * half + p[0][1] * p[0][1]);
        (libm::sqrt(greatest.max(0.0)), libm::sqrt(p[2][2].max(0.0)))
    }
}
