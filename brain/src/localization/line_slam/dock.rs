//! Loop closure at the dock: the robot has the same pose whenever it is docked.

use super::LineSlam;
use super::graph::Graph;
use super::local_submap::LocalSubmap;
use super::parameters::DOCKING;
use super::turns::TurnCalibration;
use crate::localization::skyline::System;
use crate::model::geometry::{Pose2, normalize_rad};

/// Detects when the robot comes back to its dock.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DockWatch {
    /// Distance driven since the last docking, metres; `None` = the robot was never docked.
    away_m: Option<f64>,
}

impl DockWatch {
    /// Takes a distance and whether the robot is docked at its end. Returns whether it has just arrived.
    pub(super) fn arrives(&mut self, distance_m: f64, docked: bool) -> bool {
        let away_m = self.away_m.map(|away_m| away_m + distance_m.abs());
        if !docked {
            self.away_m = away_m;
            return false;
        }
        self.away_m = Some(0.0);
        away_m.is_none_or(|away_m| away_m >= DOCKING.away_min_m)
    }
}

impl LineSlam {
    /// The robot has just docked at `odom`. The first docking gives the dock's pose, each later one the robot's.
    pub(super) fn arrive_at_dock(&mut self, time_us: u64, odom: Pose2, turns: TurnCalibration) {
        let docking = LocalSubmap {
            time_us,
            odom,
            segments: Vec::new(),
        };
        self.step_to(&docking, turns);
        let first = self.graph.docked.first().copied();
        if let Some(dock) = first.and_then(|first| self.graph.nodes.get(first)) {
            let dock = dock.pose;
            self.correct_at_dock(dock);
        }
        if let Some(node) = self.graph.nodes.get_mut(self.here) {
            node.pose = self.belief.pose;
            self.drawn.push(node.pose);
            self.graph.docked.push(self.here);
            self.has_urgent_constraint |= first.is_some();
        }
    }

    /// Corrects the belief with the dock's pose, if that pose is plausible.
    fn correct_at_dock(&mut self, dock: Pose2) {
        let [[xx, _, _], [_, yy, _], [_, _, turns]] = self.belief.covariance;
        let is_possible = off(self.belief.pose, dock)
            .into_iter()
            .zip(DOCKING.sigmas)
            .zip([xx, yy, turns])
            .all(|((off, sigma), variance)| {
                off * off <= DOCKING.gate_sigmas * DOCKING.gate_sigmas * (variance + sigma * sigma)
            });
        if !is_possible {
            return;
        }
        for (row, slopes) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .into_iter()
            .enumerate()
        {
            let offs = off(self.belief.pose, dock);
            if let (Some(off), Some(sigma)) = (offs.get(row), DOCKING.sigmas.get(row)) {
                self.belief.measure(slopes, *off, sigma * sigma);
            }
        }
    }
}

/// Difference between a pose and the pose at the dock: x, y, heading.
fn off(pose: Pose2, dock: Pose2) -> [f64; 3] {
    [
        pose.x_m - dock.x_m,
        pose.y_m - dock.y_m,
        normalize_rad(pose.heading_rad - dock.heading_rad),
    ]
}

impl Graph {
    /// Adds the residual between a later docking and the first one.
    pub(super) fn add_dock_residual(&self, number: usize, system: &mut System) {
        let (Some(first), Some(later)) = (self.docked.first(), self.docked.get(number)) else {
            return;
        };
        let (Some(dock), Some(node)) = (self.nodes.get(*first), self.nodes.get(*later)) else {
            return;
        };
        let offs = off(node.pose, dock.pose);
        let weights = DOCKING.sigmas.map(|sigma| 1.0 / (sigma * sigma));
        let misfit: f64 = offs
            .iter()
            .zip(weights)
            .map(|(off, weight)| off * off * weight)
            .sum();
        let trust = 1.0 / ((1.0 + misfit / DOCKING.kernel) * (1.0 + misfit / DOCKING.kernel));
        for (row, (off, weight)) in offs.into_iter().zip(weights).enumerate() {
            let slopes = [(3 * first + row, -1.0), (3 * later + row, 1.0)];
            system.add_residual(&slopes, off, trust * weight);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DockWatch;
    use crate::localization::line_slam::graph::tests::{laps, rmse_m};
    use crate::localization::line_slam::optimization::optimized;
    use crate::localization::line_slam::{LineSlam, OdometryStep, TurnCalibration};
    use crate::model::advance::Advance;
    use crate::model::config::SensorLayout;
    use crate::model::geometry::Pose2;
    use crate::model::observation::Observation;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn contacts_that_open_and_close_again_are_one_docking() {
        let mut watch = DockWatch::default();
        let motions = [
            (0.0, true),
            (-0.02, false),
            (0.02, true),
            (0.3, false),
            (0.3, true),
            (0.0, true),
        ];
        let arrivals = motions.map(|(distance_m, docked)| watch.arrives(distance_m, docked));
        assert_eq!(arrivals, [true, false, false, false, true, false]);
    }

    /// One lap with drift, with and without dockings at both ends.
    #[test]
    fn a_lap_that_ends_on_the_dock_closes_the_loop() {
        let mut sums_m = [0.0; 2];
        for seed in 1..60 {
            for (sum_m, docked) in sums_m.iter_mut().zip([vec![], vec![0, 32]]) {
                let (mut graph, truth) = laps(0.1 * seed as f64, seed);
                graph.nodes.truncate(33);
                graph.observations.truncate(32);
                graph.docked = docked;
                assert!(optimized(&mut graph));
                *sum_m += rmse_m(&graph, &truth[..33]);
            }
        }
        assert!(sums_m[1] < 0.7 * sums_m[0], "{sums_m:?} m in all");
    }

    /// One lap that seems to end this far off, because a step in its middle was longer than counted. Returns the error of the nodes
    /// after the optimization with these dockings.
    fn off_after_a_lap(off_m: f64, docked: Vec<usize>, seed: u64) -> f64 {
        let (mut graph, truth) = laps(0.0, seed);
        graph.nodes.truncate(33);
        graph.observations.truncate(32);
        let long = &mut graph.nodes[17];
        long.step.x_m += off_m;
        long.variance.along_m2 = 0.015;
        for node in 17..33 {
            graph.nodes[node].pose = graph.nodes[node - 1].pose * graph.nodes[node].step;
        }
        graph.docked = docked;
        assert!(optimized(&mut graph));
        rmse_m(&graph, &truth[..33])
    }

    #[test]
    fn a_loop_that_is_almost_a_metre_open_is_closed_at_the_dock() {
        for seed in 1..20 {
            let (open_m, closed_m) = (
                off_after_a_lap(0.8, vec![], seed),
                off_after_a_lap(0.8, vec![0, 32], seed),
            );
            assert!(closed_m < 0.3 * open_m, "{closed_m} of {open_m} m, seed {seed}");
        }
    }

    #[test]
    fn a_moved_dock_bends_the_map_little() {
        for (later, most_m) in [(4, 0.1), (16, 0.05)] {
            let mut mean_m = 0.0;
            for seed in 1..60 {
                let (mut graph, truth) = laps(0.0, seed);
                assert!(optimized(&mut graph));
                let right_m = rmse_m(&graph, &truth);
                graph.docked = vec![0, later];
                assert!(optimized(&mut graph));
                mean_m += (rmse_m(&graph, &truth) - right_m) / 59.0;
            }
            assert!(mean_m < most_m, "{mean_m} m more with node {later}");
        }
    }

    /// A lap of 4 by 3 m without any wall in sight, with a gyro that counts too much, from the dock to the dock.
    #[test]
    fn docking_again_corrects_the_pose_and_the_scale() {
        let turns = TurnCalibration {
            scale: 0.0,
            scale_sigma: 0.01,
            bias_sigma_rad_per_s: 1e-4,
        };
        let mut slam = LineSlam::new(
            SensorLayout::default().proximity,
            Pose2::IDENTITY,
            Pose2::IDENTITY,
        );
        let (mut odom, mut view) = (
            Pose2::IDENTITY,
            Observation {
                docked: true,
                ..Observation::default()
            },
        );
        let mut pose = odom;
        let mut step = |distance_m: f64, turn_rad: f64, docked: bool| {
            view.time_us += 20_000;
            view.docked = docked;
            odom = odom.after_arc(distance_m, turn_rad);
            let advance = Advance {
                time_s: 0.02,
                distance_m,
                turn_rad,
                wheel_turn_rad: turn_rad,
                gyro_turn_rad: Some(turn_rad),
                ..Advance::default()
            };
            if let Some(fix) = slam.follow(OdometryStep { odom, advance }, turns, &view) {
                pose = fix.map_from_odom * odom;
            } else {
                pose = pose.after_arc(distance_m, turn_rad);
            }
            pose
        };
        step(0.0, 0.0, true);
        for distance_m in [4.0, 3.0, 4.0, 3.0] {
            for _ in 0..400 {
                step(distance_m / 400.0, 0.0, false);
            }
            for _ in 0..50 {
                step(0.0, 1.01 * FRAC_PI_2 / 50.0, false);
            }
        }
        let before = step(0.0, 0.0, false);
        assert!(
            before.position().distance_m(Pose2::IDENTITY.position()) > 0.1,
            "{before:?}"
        );
        let after = (0..200).map(|_| step(0.0, 0.0, true)).last().unwrap();
        assert!(
            after.position().distance_m(Pose2::IDENTITY.position()) < 0.04,
            "{after:?}"
        );
        assert!(after.heading_rad.abs() < 0.03, "{after:?}");
        let scale = slam.graph.turn_errors.estimated_scale().unwrap().scale;
        assert!(
            (scale + 0.01).abs() < 0.004,
            "docking gives the scale, too: {scale}"
        );
    }
}
