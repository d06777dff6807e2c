//! Whether the home's walls stand at right angles, and in which directions.

use super::graph::{Graph, Wall};
use crate::geometry::normalize_rad;
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
