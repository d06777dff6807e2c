//! Errors of the gyro in the graph: one scale, and one bias for each epoch, as left by the zero-velocity updates. Both are unknowns
//! of the graph. Comparing headings after the optimization with the counted turns would underestimate the scale and be too sure of
//! it, because walls that are seen rarely hardly move a heading.

use super::parameters::TURN;
use crate::localization::skyline::System;
use crate::model::geometry::{Point2, Pose2, normalize_rad};

/// Calibration of the turns by odometry.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::localization) struct TurnCalibration {
    /// Scale error that odometry already corrects, relative, and its standard deviation.
    pub(in crate::localization) scale: f64,
    pub(in crate::localization) scale_sigma: f64,
    /// Standard deviation of the bias, radians per second.
    pub(in crate::localization) bias_sigma_rad_per_s: f64,
}

/// An estimate of the scale error of the turns.
#[derive(Clone, Copy, Debug)]
pub(in crate::localization) struct ScaleEstimate {
    /// Relative error.
    pub(in crate::localization) scale: f64,
    /// Its standard deviation.
    pub(in crate::localization) sigma: f64,
}

/// The turns of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turns {
    /// Sum of all turns, not wrapped, radians.
    pub(super) sum_rad: f64,
    /// Derivative of the end position by the scale of turns, metres.
    pub(super) d_position_d_scale: Point2,
    /// Scale error that is already corrected, relative.
    pub(super) scale: f64,
    pub(super) time_s: f64,
    /// Derivative of the end position by the bias, metres per radian per second.
    pub(super) d_position_d_bias: Point2,
    /// The bias epoch of the step.
    pub(super) epoch: usize,
}

impl Turns {
    /// Counts the turns of a step with another scale. The first steps were counted before the scale was estimated.
    pub(super) fn recount(&mut self, step: Pose2, scale: f64) -> Pose2 {
        let before = core::mem::replace(&mut self.scale, scale);
        let more = (1.0 + scale) / (1.0 + before) - 1.0;
        let step = Pose2 {
            x_m: step.x_m + more * self.d_position_d_scale.x_m,
            y_m: step.y_m + more * self.d_position_d_scale.y_m,
            heading_rad: normalize_rad(step.heading_rad + more * self.sum_rad),
        };
        self.sum_rad *= 1.0 + more;
        step
    }
}

/// A minute with one gyro bias.
#[derive(Clone, Copy, Debug)]
pub(super) struct BiasEpoch {
    began_us: u64,
    /// Its first node.
    pub(super) first: usize,
    /// Remaining bias, and its standard deviation by zero-velocity updates, radians per second.
    bias_rad_per_s: f64,
    sigma_rad_per_s: f64,
}

impl BiasEpoch {
    fn takes_in(&self, time_us: u64, sigma_rad_per_s: f64) -> bool {
        time_us < self.began_us.saturating_add(TURN.epoch_us)
            && sigma_rad_per_s > TURN.surer_share * self.sigma_rad_per_s
    }
}

/// Errors of all turns.
#[derive(Clone, Debug, Default)]
pub(super) struct TurnErrors {
    pub(super) epochs: Vec<BiasEpoch>,
    /// Scale error that is corrected, relative.
    pub(super) scale: f64,
    /// Its standard deviation; `None` = no optimization has estimated it.
    pub(super) scale_sigma: Option<f64>,
    /// Prior of the scale at the start, and its standard deviation.
    known_scale: f64,
    known_sigma: f64,
}

/// Indices of the unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnUnknowns {
    pub(super) first_epoch: usize,
    /// The last of all.
    pub(super) scale: usize,
}

impl TurnErrors {
    /// Starts with this prior.
    pub(super) fn new(turns: TurnCalibration) -> Self {
        Self {
            epochs: Vec::new(),
            scale: turns.scale,
            scale_sigma: None,
            known_scale: turns.scale,
            known_sigma: turns.scale_sigma,
        }
    }

    /// Corrects the scale by this share before the next optimization. Without it, whole turns with many deviations of error would
    /// look like outliers.
    pub(super) fn correct_scale(&mut self, share: f64) {
        self.scale += share * (1.0 + self.scale);
    }

    /// The estimated scale; `None` before the first optimization.
    pub(super) fn estimated_scale(&self) -> Option<ScaleEstimate> {
        let scale = self.scale;
        self.scale_sigma.map(|sigma| ScaleEstimate { scale, sigma })
    }

    /// The epoch of a new node.
    pub(super) fn epoch(&mut self, node: usize, time_us: u64, sigma_rad_per_s: f64) -> usize {
        let goes_on = self
            .epochs
            .last()
            .is_some_and(|epoch| epoch.takes_in(time_us, sigma_rad_per_s));
        if !goes_on {
            self.epochs.push(BiasEpoch {
                began_us: time_us,
                first: node,
                bias_rad_per_s: 0.0,
                sigma_rad_per_s,
            });
        }
        self.epochs.len().saturating_sub(1)
    }

    /// Adds the priors of scale and biases.
    pub(super) fn add_knowledge(&self, unknowns: TurnUnknowns, system: &mut System) {
        let weight = |sigma: f64, least: f64| {
            let sigma = sigma.max(least);
            1.0 / (sigma * sigma)
        };
        for (number, epoch) in self.epochs.iter().enumerate() {
            let sure = weight(epoch.sigma_rad_per_s, TURN.bias_sigma_min_rad_per_s);
            system.add_residual(
                &[(unknowns.first_epoch + number, 1.0)],
                epoch.bias_rad_per_s,
                sure,
            );
        }
        let off = self.scale - self.known_scale;
        let sure = weight(self.known_sigma, TURN.scale_sigma_min);
        system.add_residual(&[(unknowns.scale, 1.0)], off, sure);
    }

    /// A step without the estimated bias.
    pub(super) fn unbiased(&self, step: Pose2, turns: &Turns) -> Pose2 {
        let bias = self
            .epochs
            .get(turns.epoch)
            .map_or(0.0, |epoch| epoch.bias_rad_per_s);
        Pose2 {
            x_m: step.x_m - bias * turns.d_position_d_bias.x_m,
            y_m: step.y_m - bias * turns.d_position_d_bias.y_m,
            heading_rad: normalize_rad(step.heading_rad - bias * turns.time_s),
        }
    }

    /// Derivatives of a step's residuals in x, y and heading by scale and bias.
    pub(super) fn slopes(turns: &Turns, unknowns: TurnUnknowns) -> [[(usize, f64); 2]; 3] {
        let counted = 1.0 / (1.0 + turns.scale);
        let epoch = unknowns.first_epoch + turns.epoch;
        [
            (turns.d_position_d_scale.x_m, turns.d_position_d_bias.x_m),
            (turns.d_position_d_scale.y_m, turns.d_position_d_bias.y_m),
            (turns.sum_rad, turns.time_s),
        ]
        .map(|(by_scale, by_bias)| [(epoch, by_bias), (unknowns.scale, -by_scale * counted)])
    }

    /// Applies the step of an iteration.
    pub(super) fn apply(&mut self, unknowns: TurnUnknowns, step: impl Fn(usize) -> f64) {
        for (number, epoch) in self.epochs.iter_mut().enumerate() {
            epoch.bias_rad_per_s += step(unknowns.first_epoch + number);
        }
        self.scale += step(unknowns.scale);
    }
}

#[cfg(test)]
mod tests {
    use super::{BiasEpoch, ScaleEstimate, TurnCalibration, TurnErrors};
    use crate::localization::line_slam::graph::Graph;
    use crate::localization::line_slam::graph::tests::laps;
    use crate::localization::line_slam::optimization::optimized;
    use crate::model::geometry::{Pose2, normalize_rad};
    use core::f64::consts::FRAC_PI_2;

    const COUNTING: TurnCalibration = TurnCalibration {
        scale: 0.0,
        scale_sigma: 0.01,
        bias_sigma_rad_per_s: 1e-3,
    };

    /// Two laps of a robot that counts each turn by `scale` too much, and whose gyro adds `bias_rad_per_s` in each of the ten
    /// seconds of a step.
    fn miscounted(scale: f64, bias_rad_per_s: f64, seed: u64) -> Graph {
        let (mut graph, truth) = laps(0.3, seed);
        graph.turn_errors = TurnErrors::new(COUNTING);
        let mut believed: Option<Pose2> = None;
        for (index, node) in graph.nodes.iter_mut().enumerate() {
            let turned_rad = match index.checked_sub(1).and_then(|before| truth.get(before)) {
                Some(before) => normalize_rad(truth[index].heading_rad - before.heading_rad),
                None => 0.0,
            };
            node.turns.sum_rad = turned_rad * (1.0 + scale);
            node.turns.time_s = 10.0;
            node.time_us = 10_000_000 * index as u64;
            node.turns.epoch = graph
                .turn_errors
                .epoch(index, node.time_us, COUNTING.bias_sigma_rad_per_s);
            node.step.heading_rad += turned_rad * scale + 10.0 * bias_rad_per_s;
            node.pose = believed.map_or(node.pose, |before| before * node.step);
            believed = Some(node.pose);
        }
        graph
    }

    #[test]
    fn the_scale_of_turns_is_estimated_within_its_deviation() {
        let (mut sum, mut squares) = (0.0, 0.0);
        for seed in 1..40 {
            let mut graph = miscounted(0.02, 0.0, seed);
            assert!(optimized(&mut graph));
            let ScaleEstimate { scale, sigma } = graph.turn_errors.estimated_scale().unwrap();
            assert!((0.001..0.008).contains(&sigma), "{sigma}");
            sum += scale / 39.0;
            let off = (scale - (1.0 / 1.02 - 1.0)) / sigma;
            squares += off * off / 39.0;
            let counted_rad: f64 = graph.nodes.iter().map(|node| node.turns.sum_rad).sum();
            let turned_rad = 7.0 * FRAC_PI_2 * 1.02 * (1.0 + scale);
            assert!((counted_rad - turned_rad).abs() < 1e-9, "turns are counted anew");
        }
        assert!((-0.022..-0.014).contains(&sum), "{sum}");
        assert!(squares < 3.0, "{squares}");
    }

    #[test]
    fn a_remaining_bias_is_estimated_for_each_epoch() {
        let mut biases = Vec::new();
        for seed in 1..40 {
            let mut graph = miscounted(0.0, 2e-3, seed);
            assert!(optimized(&mut graph));
            let epochs = &graph.turn_errors.epochs;
            assert_eq!(epochs.len(), 11);
            biases.extend(epochs.iter().map(|epoch: &BiasEpoch| epoch.bias_rad_per_s));
        }
        let mean = biases.iter().sum::<f64>() / biases.len() as f64;
        // The prior says that there is hardly any bias.
        assert!((1e-3..2.1e-3).contains(&mean), "{mean}");
    }
}
