//! Manhattan alignment: detects whether the walls are at right angles, and aligns them.

use super::graph::{Graph, LineLandmark};
use super::parameters::MANHATTAN;
use crate::model::geometry::normalize_rad;
use core::f64::consts::{FRAC_PI_2, TAU};

/// Bins of a quarter turn: 2 degrees each.
const BINS: usize = 45;

/// Detects the four directions from the present observations and aligns the landmarks with them.
pub(super) fn align_to_manhattan(graph: &mut Graph) {
    graph.manhattan_rad = detected(graph);
    for landmark in &mut graph.landmarks {
        align(landmark, graph.manhattan_rad);
    }
}

/// Aligns a landmark with its quarter, if the home has right angles and the landmark is close to one.
pub(super) fn align(landmark: &mut LineLandmark, manhattan_rad: Option<f64>) {
    landmark.quarter =
        manhattan_rad.and_then(|manhattan_rad| quarter(manhattan_rad, landmark.normal_rad, 0.0));
    if let (Some(quarter), Some(manhattan_rad)) = (landmark.quarter, manhattan_rad) {
        turn_to(landmark, manhattan_rad + f64::from(quarter) * FRAC_PI_2);
    }
}

/// Rotates a landmark about the middle of what was seen of it.
fn turn_to(landmark: &mut LineLandmark, normal_rad: f64) {
    let turn_rad = normalize_rad(normal_rad - landmark.normal_rad);
    landmark.offset_m += 0.5 * (landmark.low_m + landmark.high_m) * libm::sin(turn_rad);
    landmark.normal_rad = normalize_rad(normal_rad);
}

/// The quarter of a landmark with this normal, give or take `sigma_rad`.
pub(super) fn quarter(manhattan_rad: f64, normal_rad: f64, sigma_rad: f64) -> Option<u8> {
    let turns = (normal_rad - manhattan_rad) / FRAC_PI_2;
    let nearest = libm::round(turns);
    let off_rad = (turns - nearest) * FRAC_PI_2;
    (off_rad.abs() <= MANHATTAN.near_rad + sigma_rad.min(MANHATTAN.near_rad))
        .then(|| (nearest as i64).rem_euclid(4) as u8)
}

fn detected(graph: &Graph) -> Option<f64> {
    if graph.observations.len() < MANHATTAN.observations_min {
        return None;
    }
    // Directions of all segments, modulo a quarter turn, and their lengths.
    let directions: Vec<(f64, f64)> = graph
        .observations
        .iter()
        .filter_map(|observation| {
            let node = graph.nodes.get(observation.node)?;
            let rad = node.pose.heading_rad + observation.segment.normal_rad;
            Some((rad.rem_euclid(FRAC_PI_2), observation.segment.half_m))
        })
        .collect();
    let mut bins = [0.0; BINS];
    let mut sum = 0.0;
    for (rad, weight) in &directions {
        let bin = (rad / FRAC_PI_2 * BINS as f64) as usize;
        if let Some(entry) = bins.get_mut(bin.min(BINS - 1)) {
            *entry += weight;
        }
        sum += weight;
    }
    let around = |bin: usize| -> f64 {
        (0..=2 * MANHATTAN.peak_bins)
            .filter_map(|offset| bins.get((bin + BINS + offset - MANHATTAN.peak_bins) % BINS))
            .sum()
    };
    let peak = (0..BINS).max_by(|one, other| around(*one).total_cmp(&around(*other)))?;
    let least = match graph.manhattan_rad {
        Some(_) => MANHATTAN.lost_share,
        None => MANHATTAN.gained_share,
    };
    if around(peak) < least * sum {
        return None;
    }
    let middle_rad = (peak as f64 + 0.5) / BINS as f64 * FRAC_PI_2;
    // Circular mean over a quarter turn of the directions near the peak.
    let (mut weighed, mut weights) = (0.0, 0.0);
    for (rad, weight) in &directions {
        let off_rad = normalize_rad((rad - middle_rad) * TAU / FRAC_PI_2) * FRAC_PI_2 / TAU;
        if off_rad.abs() <= MANHATTAN.near_rad {
            weighed += weight * off_rad;
            weights += weight;
        }
    }
    let mean_rad = middle_rad + weighed / f64::max(weights, 1e-9);
    // The quarter turn closest to the previous direction, so that quarters keep their numbers.
    let before_rad = graph.manhattan_rad.unwrap_or(0.0);
    let turns = libm::round((before_rad - mean_rad) / FRAC_PI_2);
    Some(graph.manhattan_rad.unwrap_or(mean_rad + turns * FRAC_PI_2))
}

#[cfg(test)]
mod tests {
    use super::super::graph::{Graph, LineLandmark, LineObservation, Node};
    use super::super::kalman::StepVariance;
    use super::super::line_segment::LineSegment;
    use super::super::turns::Turns;
    use super::align_to_manhattan;
    use crate::model::geometry::{Point2, Pose2, normalize_rad};
    use crate::model::random::Random;
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

    /// Scatter of the segments' directions, radians: 2 degrees.
    const SCATTER_RAD: f64 = 0.035;

    /// The robot passes a piece of wall with this normal, with the wall to its right.
    fn see(graph: &mut Graph, normal_rad: f64, random: &mut Random) {
        let (node, landmark) = (graph.nodes.len(), graph.landmarks.len());
        let pose = Pose2 {
            heading_rad: normal_rad - FRAC_PI_2 + SCATTER_RAD * random.normal(),
            ..Pose2::IDENTITY
        };
        graph.nodes.push(Node {
            time_us: node as u64,
            odom: pose,
            pose,
            step: Pose2::IDENTITY,
            variance: StepVariance::default(),
            turns: Turns::default(),
        });
        let middle = Point2 { x_m: 0.0, y_m: -0.3 };
        graph.landmarks.push(LineLandmark {
            quarter: None,
            normal_rad: normalize_rad(normal_rad),
            anchor: pose.transform(middle),
            offset_m: 0.0,
            low_m: -0.25,
            high_m: 0.25,
            first: node,
            observation_count: 1,
            is_distinct: false,
        });
        graph.observations.push(LineObservation {
            node,
            landmark,
            segment: LineSegment {
                middle,
                normal_rad: FRAC_PI_2,
                half_m: 0.25,
                sigma_rad: 0.02,
                sigma_m: 0.012,
            },
        });
        align_to_manhattan(graph);
    }

    /// Laps in a home whose walls have these directions. Returns after each segment whether the home has right angles.
    fn laps(directions_rad: &[f64], graph: &mut Graph, laps: usize, seed: u64) -> Vec<bool> {
        let mut random = Random::new(seed);
        let mut is_manhattan = Vec::new();
        for _ in 0..laps {
            for normal_rad in directions_rad {
                see(graph, *normal_rad, &mut random);
                is_manhattan.push(graph.manhattan_rad.is_some());
            }
        }
        is_manhattan
    }

    fn four(turned_rad: f64) -> [f64; 4] {
        [0.0, 1.0, 2.0, 3.0].map(|quarter| turned_rad + quarter * FRAC_PI_2)
    }

    fn six(turned_rad: f64) -> [f64; 6] {
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|sixth| turned_rad + sixth * FRAC_PI_3)
    }

    #[test]
    fn walls_at_60_degrees_are_never_aligned() {
        for seed in 1..40 {
            let mut graph = Graph::default();
            let is_manhattan = laps(&six(0.1 * seed as f64), &mut graph, 20, seed);
            assert!(!is_manhattan.contains(&true), "seed {seed}");
            assert!(graph.landmarks.iter().all(|landmark| landmark.quarter.is_none()));
        }
    }

    #[test]
    fn walls_at_right_angles_share_directions_at_any_rotation() {
        for seed in 1..40 {
            let turned_rad = 0.1 * seed as f64;
            let mut graph = Graph::default();
            let is_manhattan = laps(&four(turned_rad), &mut graph, 5, seed);
            assert_eq!(
                is_manhattan.iter().position(|is| *is),
                Some(5),
                "the sixth segment decides"
            );
            let manhattan_rad = graph.manhattan_rad.expect("is square");
            let quarters = (manhattan_rad - turned_rad) / FRAC_PI_2;
            let off_rad = (quarters - quarters.round()).abs() * FRAC_PI_2;
            assert!(off_rad < 0.06, "{off_rad} with seed {seed}");
            for (landmark, quarter) in graph.landmarks.iter().zip((0..4).cycle()) {
                let found = landmark.quarter.expect("has a direction of the four");
                assert_eq!(found, (graph.landmarks[0].quarter.unwrap() + quarter) % 4);
                let shared_rad = manhattan_rad + f64::from(found) * FRAC_PI_2;
                assert!(normalize_rad(landmark.normal_rad - shared_rad).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn many_slanted_walls_end_the_alignment_and_a_few_do_not() {
        for seed in 1..40 {
            let mut graph = Graph::default();
            laps(&four(0.3), &mut graph, 10, seed);
            let slanted = |turned_rad: f64| [turned_rad, turned_rad + PI];
            let few = laps(&slanted(0.3 + 0.7), &mut graph, 10, seed);
            assert!(!few.contains(&false), "seed {seed}");
            assert!(
                graph
                    .landmarks
                    .last()
                    .is_some_and(|landmark| landmark.quarter.is_none())
            );
            for turned_rad in [0.3, 0.6, 0.9, 1.2] {
                laps(&slanted(0.3 + turned_rad), &mut graph, 15, seed);
            }
            assert_eq!(graph.manhattan_rad, None, "seed {seed}");
            assert!(graph.landmarks.iter().all(|landmark| landmark.quarter.is_none()));
            // Between both thresholds the decision stays as it was, so it takes more evidence to align again.
            let later = laps(&four(0.3), &mut graph, 10, seed);
            assert!(!later.contains(&true), "seed {seed}");
        }
    }
}
