//! The graph put in order: what does not fit is torn off, walls that are one are joined, and those that nothing lies on are
//! dropped.

use super::graph::{Graph, Mark, Wall};
use crate::model::geometry::normalize_rad;

/// Walls nearer to each other than this are one, metres, if the gap between their ends is no longer than that.
const MERGE_M: f64 = 0.05;
const MERGE_GAP_M: f64 = 0.5;
/// Walls that are one look the same way, radians: 7 degrees.
const MERGE_RAD: f64 = 0.125;
/// A mark this far off its wall was never on it, metres.
pub(super) const TORN_OFF_M: f64 = 0.12;

/// Puts the graph in order. Gives for each wall the one that it became; `None` = it is gone.
pub(super) fn tidy(graph: &mut Graph) -> Vec<Option<usize>> {
    tear_off(graph);
    measure(graph);
    let joined = joined(&graph.walls);
    join(graph, &joined)
}

/// Each wall becomes the one that `joined` gives for it. Gives for each wall where that one is now; `None` = it is gone.
pub(super) fn join(graph: &mut Graph, joined: &[usize]) -> Vec<Option<usize>> {
    let is_changed = joined.iter().enumerate().any(|(index, whole)| index != *whole);
    if is_changed {
        for mark in &mut graph.marks {
            mark.wall = joined.get(mark.wall).copied().unwrap_or(mark.wall);
        }
        measure(graph);
    }
    let places = drop_bare(graph);
    joined
        .iter()
        .map(|whole| places.get(*whole).copied().flatten())
        .collect()
}

fn tear_off(graph: &mut Graph) {
    let mut marks = core::mem::take(&mut graph.marks);
    marks.retain(|mark| graph.off_m(mark).abs() <= TORN_OFF_M);
    graph.marks = marks;
}

/// Ends and number of marks of each wall anew, from the marks as they lie now.
fn measure(graph: &mut Graph) {
    graph.forget_ends();
    let marks = core::mem::take(&mut graph.marks);
    for mark in &marks {
        graph.reach(mark);
    }
    graph.marks = marks;
}

/// For each wall the one that it is a part of.
fn joined(walls: &[Wall]) -> Vec<usize> {
    let mut joined: Vec<usize> = (0..walls.len()).collect();
    for (index, wall) in walls.iter().enumerate() {
        let other = walls
            .iter()
            .take(index)
            .enumerate()
            .find(|(other, longer)| joined.get(*other) == Some(other) && are_one(longer, wall));
        if let (Some((other, _)), Some(place)) = (other, joined.get_mut(index)) {
            *place = other;
        }
    }
    joined
}

/// Drops the walls without marks, and gives for each wall where it is now.
fn drop_bare(graph: &mut Graph) -> Vec<Option<usize>> {
    let mut kept = 0..;
    let places: Vec<Option<usize>> = graph
        .walls
        .iter()
        .map(|wall| if wall.marks > 0 { kept.next() } else { None })
        .collect();
    let place = |mark: &Mark| places.get(mark.wall).copied().flatten();
    for mark in &mut graph.marks {
        mark.wall = place(mark).unwrap_or(mark.wall);
    }
    graph.walls.retain(|wall| wall.marks > 0);
    places
}

/// Whether two walls face the same way.
pub(super) fn look_alike(one: &Wall, other: &Wall) -> bool {
    let turned_rad = normalize_rad(one.normal_rad - other.normal_rad);
    turned_rad.abs() <= MERGE_RAD && one.quarter == other.quarter
}

fn are_one(one: &Wall, other: &Wall) -> bool {
    if !look_alike(one, other) {
        return false;
    }
    let end = |along_m: f64| one.place_of(other.at(along_m));
    let ends = [end(other.low_m), end(other.high_m)];
    let is_near = ends.iter().all(|(off_m, _)| off_m.abs() <= MERGE_M);
    let low_m = ends[0].1.min(ends[1].1);
    let high_m = ends[0].1.max(ends[1].1);
    is_near && (low_m - one.high_m).max(one.low_m - high_m) <= MERGE_GAP_M
}
