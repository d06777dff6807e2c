//! How much the robot turned between moments at which walls told its heading: what the gyro's calibration learns from.
//!
//! The headings are those of the fit, after it has weighed all walls. What a single wall corrects at once is no measure: the
//! pose is pulled only part of the way, and a fit that turns the past turns the present with it.

use super::graph::Graph;
use crate::geometry::normalize_rad;
use crate::localization::calibration::Gain;

/// Time between the two moments at least, seconds.
const WINDOW_S: f64 = 20.0;
/// Where no wall was seen for longer than this a wrong wall may stand at the end, seconds.
const WINDOW_MAX_S: f64 = 60.0;
/// Deviation of a heading that walls have told, radians: strokes are bent by what reflects differently along them.
const HEADING_SIGMA_RAD: f64 = 0.03;
/// The gyro is never wrong by more than this over such a time, radians: the wall is.
const OFF_MAX_RAD: f64 = 0.1;
/// In a home without right angles a wall tells the heading when so many marks lie on it.
const MARKS_MIN: u32 = 4;

/// Where the next gain begins.
#[derive(Clone, Debug)]
pub(super) struct GainLog {
    /// Node from which on nothing was told yet.
    next: usize,
}

impl Default for GainLog {
    /// From the second node on: no wall was seen from the first one.
    fn default() -> Self {
        Self { next: 1 }
    }
}

impl GainLog {
    /// What the nodes tell that a fit knew, up to `known`.
    pub(super) fn take(&mut self, graph: &Graph, known: usize) -> Vec<Gain> {
        let mut gains = Vec::new();
        let first = graph.marks.partition_point(|mark| mark.node < self.next);
        for mark in graph.marks.iter().skip(first) {
            if mark.node >= known {
                break;
            }
            let wall = graph.walls.get(mark.wall);
            let is_square = graph.square_rad.is_some();
            let tells =
                wall.is_some_and(|wall| wall.quarter.is_some() || !is_square && wall.marks >= MARKS_MIN);
            if !tells {
                continue;
            }
            match self.gain_up_to(mark.node, graph) {
                Some(gain) if gain.time_s >= WINDOW_S => {
                    let is_sound = gain.time_s <= WINDOW_MAX_S
                        && (gain.gained_rad - gain.counted_rad).abs() <= OFF_MAX_RAD;
                    gains.extend(is_sound.then_some(gain));
                    self.next = mark.node;
                }
                Some(_) => {}
                None => self.next = mark.node,
            }
        }
        gains
    }

    fn gain_up_to(&self, node: usize, graph: &Graph) -> Option<Gain> {
        let between = graph.nodes.get(self.next..=node)?;
        let ([began, ..], [.., ended]) = (between, between) else {
            return None;
        };
        let counted_rad: f64 = between.iter().skip(1).map(|node| node.turns.sum_rad).sum();
        let turned_rad = ended.pose.heading_rad - began.pose.heading_rad;
        Some(Gain {
            time_s: ended.time_us.saturating_sub(began.time_us) as f64 * 1e-6,
            counted_rad,
            gained_rad: counted_rad + normalize_rad(turned_rad - counted_rad),
            variance_rad2: 2.0 * HEADING_SIGMA_RAD * HEADING_SIGMA_RAD,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::GainLog;
    use crate::geometry::{Pose2, normalize_rad};
    use crate::localization::survey::graph::tests::laps;

    const FULL_RAD: f64 = core::f64::consts::TAU;
    /// What the gyro counts of a turn.
    const SCALE: f64 = 1.005;

    #[test]
    fn a_gain_is_what_the_walls_say_of_a_turn_that_was_counted_wrongly() {
        let (mut graph, _) = laps(0.0, 3);
        for wall in &mut graph.walls {
            wall.quarter = Some(0);
        }
        let mut heading_rad = 0.0;
        for (index, node) in graph.nodes.iter_mut().enumerate() {
            // A full turn and some more between two nodes.
            heading_rad += FULL_RAD + 0.1;
            node.turns.sum_rad = SCALE * (FULL_RAD + 0.1);
            node.pose.heading_rad = normalize_rad(heading_rad);
            node.time_us = 15_000_000 * index as u64;
        }
        let mut log = GainLog::default();
        assert_eq!(log.take(&graph, 1).len(), 0);
        let half = graph.nodes.len() / 2;
        let mut gains = log.take(&graph, half);
        // A fit that turns all of the past afterwards tells no turn.
        for node in &mut graph.nodes {
            node.pose = Pose2 {
                heading_rad: normalize_rad(node.pose.heading_rad + 0.3),
                ..node.pose
            };
        }
        gains.extend(log.take(&graph, graph.nodes.len()));
        assert!(gains.len() >= graph.nodes.len() / 2 - 2, "{gains:?}");
        for gain in gains {
            assert!(
                (gain.counted_rad - SCALE * gain.gained_rad).abs() < 1e-6,
                "{gain:?}"
            );
            assert!((gain.time_s - 30.0).abs() < 1e-9, "{gain:?}");
        }
    }
}
