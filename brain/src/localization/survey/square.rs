//! Whether the home's walls stand at right angles, and in which directions.

use super::graph::{Graph, Wall};
use crate::model::geometry::normalize_rad;
use core::f64::consts::{FRAC_PI_2, TAU};

/// Bins of a quarter turn: 2 degrees each.
const BINS: usize = 45;
/// Bins to each side that belong to a peak: 7 degrees with the middle one.
const PEAK_BINS: usize = 3;
/// Strokes that are needed to tell.
const MARKS_MIN: usize = 6;
/// A home counts as square when this share of its walls' length has the four directions: by chance it were 0.16.
const SQUARE_FROM: f64 = 0.6;
/// Below this share it does not any more.
const SQUARE_TO: f64 = 0.45;
/// Walls this near to one of the four directions have it, radians: 7 degrees.
const NEAR_RAD: f64 = 0.12;

/// Looks at the strokes as they lie now, and lets the walls share directions or not.
pub(super) fn square(graph: &mut Graph) {
    graph.square_rad = found(graph);
    for wall in &mut graph.walls {
        directed(wall, graph.square_rad);
    }
}

/// The wall gets the direction of its quarter, if it is near to one of a home with right angles.
pub(super) fn directed(wall: &mut Wall, square_rad: Option<f64>) {
    wall.quarter = square_rad.and_then(|square_rad| quarter(square_rad, wall.normal_rad, 0.0));
    if let (Some(quarter), Some(square_rad)) = (wall.quarter, square_rad) {
        turn_to(wall, square_rad + f64::from(quarter) * FRAC_PI_2);
    }
}

/// The wall in another direction, about the middle of what was seen of it.
fn turn_to(wall: &mut Wall, normal_rad: f64) {
    let turn_rad = normalize_rad(normal_rad - wall.normal_rad);
    wall.offset_m += 0.5 * (wall.low_m + wall.high_m) * libm::sin(turn_rad);
    wall.normal_rad = normalize_rad(normal_rad);
}

/// The quarter whose direction a wall has that looks this way, give or take `sigma_rad`.
pub(super) fn quarter(square_rad: f64, normal_rad: f64, sigma_rad: f64) -> Option<u8> {
    let turns = (normal_rad - square_rad) / FRAC_PI_2;
    let nearest = libm::round(turns);
    let off_rad = (turns - nearest) * FRAC_PI_2;
    (off_rad.abs() <= NEAR_RAD + sigma_rad.min(NEAR_RAD)).then(|| (nearest as i64).rem_euclid(4) as u8)
}

fn found(graph: &Graph) -> Option<f64> {
    if graph.marks.len() < MARKS_MIN {
        return None;
    }
    // Directions of all strokes, folded into a quarter turn, and their lengths.
    let directions: Vec<(f64, f64)> = graph
        .marks
        .iter()
        .filter_map(|mark| {
            let node = graph.nodes.get(mark.node)?;
            let rad = node.pose.heading_rad + mark.stroke.normal_rad;
            Some((rad.rem_euclid(FRAC_PI_2), mark.stroke.half_m))
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
        (0..=2 * PEAK_BINS)
            .filter_map(|offset| bins.get((bin + BINS + offset - PEAK_BINS) % BINS))
            .sum()
    };
    let peak = (0..BINS).max_by(|one, other| around(*one).total_cmp(&around(*other)))?;
    let least = match graph.square_rad {
        Some(_) => SQUARE_TO,
        None => SQUARE_FROM,
    };
    if around(peak) < least * sum {
        return None;
    }
    let middle_rad = (peak as f64 + 0.5) / BINS as f64 * FRAC_PI_2;
    // The mean of what lies near, on a circle of a quarter turn.
    let (mut weighed, mut weights) = (0.0, 0.0);
    for (rad, weight) in &directions {
        let off_rad = normalize_rad((rad - middle_rad) * TAU / FRAC_PI_2) * FRAC_PI_2 / TAU;
        if off_rad.abs() <= NEAR_RAD {
            weighed += weight * off_rad;
            weights += weight;
        }
    }
    let mean_rad = middle_rad + weighed / f64::max(weights, 1e-9);
    // The quarter turn next to the direction so far, so that quarters keep their numbers.
    let before_rad = graph.square_rad.unwrap_or(0.0);
    let turns = libm::round((before_rad - mean_rad) / FRAC_PI_2);
    Some(graph.square_rad.unwrap_or(mean_rad + turns * FRAC_PI_2))
}

#[cfg(test)]
mod tests {
    use super::super::graph::{Graph, Mark, Node, Wall};
    use super::super::kalman::StepVariance;
    use super::super::stroke::Stroke;
    use super::super::turns::Turns;
    use super::square;
    use crate::model::geometry::{Point2, Pose2, normalize_rad};
    use crate::model::random::Random;
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

    /// Directions of strokes scatter by so much, radians: 2 degrees.
    const SCATTER_RAD: f64 = 0.035;

    /// The robot passes a piece of a wall that looks this way, with the wall to its right.
    fn see(graph: &mut Graph, normal_rad: f64, random: &mut Random) {
        let (node, wall) = (graph.nodes.len(), graph.walls.len());
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
        graph.walls.push(Wall {
            quarter: None,
            normal_rad: normalize_rad(normal_rad),
            anchor: pose.transform(middle),
            offset_m: 0.0,
            low_m: -0.25,
            high_m: 0.25,
            first: node,
            marks: 1,
            is_apart: false,
        });
        graph.marks.push(Mark {
            node,
            wall,
            stroke: Stroke {
                middle,
                normal_rad: FRAC_PI_2,
                half_m: 0.25,
                sigma_rad: 0.02,
                sigma_m: 0.012,
            },
        });
        square(graph);
    }

    /// Laps in a home whose walls have these directions; after each stroke, whether it counts as square.
    fn laps(directions_rad: &[f64], graph: &mut Graph, (laps, seed): (usize, u64)) -> Vec<bool> {
        let mut random = Random::new(seed);
        let mut is_square = Vec::new();
        for _ in 0..laps {
            for normal_rad in directions_rad {
                see(graph, *normal_rad, &mut random);
                is_square.push(graph.square_rad.is_some());
            }
        }
        is_square
    }

    fn four(turned_rad: f64) -> [f64; 4] {
        [0.0, 1.0, 2.0, 3.0].map(|quarter| turned_rad + quarter * FRAC_PI_2)
    }

    fn six(turned_rad: f64) -> [f64; 6] {
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|sixth| turned_rad + sixth * FRAC_PI_3)
    }

    #[test]
    fn walls_at_60_degrees_never_count_as_square() {
        for seed in 1..40 {
            let mut graph = Graph::default();
            let is_square = laps(&six(0.1 * seed as f64), &mut graph, (20, seed));
            assert!(!is_square.contains(&true), "seed {seed}");
            assert!(graph.walls.iter().all(|wall| wall.quarter.is_none()));
        }
    }

    #[test]
    fn walls_at_right_angles_share_their_directions_however_the_home_is_turned() {
        for seed in 1..40 {
            let turned_rad = 0.1 * seed as f64;
            let mut graph = Graph::default();
            let is_square = laps(&four(turned_rad), &mut graph, (5, seed));
            assert_eq!(
                is_square.iter().position(|is| *is),
                Some(5),
                "the sixth stroke tells"
            );
            let square_rad = graph.square_rad.expect("is square");
            let quarters = (square_rad - turned_rad) / FRAC_PI_2;
            let off_rad = (quarters - quarters.round()).abs() * FRAC_PI_2;
            assert!(off_rad < 0.06, "{off_rad} with seed {seed}");
            for (wall, quarter) in graph.walls.iter().zip((0..4).cycle()) {
                let found = wall.quarter.expect("has a direction of the four");
                assert_eq!(found, (graph.walls[0].quarter.unwrap() + quarter) % 4);
                let shared_rad = square_rad + f64::from(found) * FRAC_PI_2;
                assert!(normalize_rad(wall.normal_rad - shared_rad).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn slanted_walls_that_are_found_later_end_it_and_a_few_do_not() {
        for seed in 1..40 {
            let mut graph = Graph::default();
            laps(&four(0.3), &mut graph, (10, seed));
            let slanted = |turned_rad: f64| [turned_rad, turned_rad + PI];
            let few = laps(&slanted(0.3 + 0.7), &mut graph, (10, seed));
            assert!(!few.contains(&false), "seed {seed}");
            assert!(graph.walls.last().is_some_and(|wall| wall.quarter.is_none()));
            for turned_rad in [0.3, 0.6, 0.9, 1.2] {
                laps(&slanted(0.3 + turned_rad), &mut graph, (15, seed));
            }
            assert_eq!(graph.square_rad, None, "seed {seed}");
            assert!(graph.walls.iter().all(|wall| wall.quarter.is_none()));
            // What is neither clearly square nor clearly not stays what it was: here it takes more to begin again.
            let again = laps(&four(0.3), &mut graph, (10, seed));
            assert!(!again.contains(&true), "seed {seed}");
        }
    }
}
