//! Cleans up the graph: rejects outliers, merges landmarks that are one wall, and drops landmarks without observations.

use super::graph::{Graph, LineLandmark, LineObservation};
use super::parameters::CLEANUP;
use crate::model::geometry::normalize_rad;

/// Cleans up the graph. Returns for each landmark the one that replaces it; `None` = it was dropped.
pub(super) fn clean_up(graph: &mut Graph) -> Vec<Option<usize>> {
    reject_outliers(graph);
    measure(graph);
    let merged = merged(&graph.landmarks);
    merge(graph, &merged)
}

/// Replaces each landmark by the one that `merged` names for it. Returns the new index of each landmark; `None` = it was dropped.
pub(super) fn merge(graph: &mut Graph, merged: &[usize]) -> Vec<Option<usize>> {
    let is_changed = merged.iter().enumerate().any(|(index, whole)| index != *whole);
    if is_changed {
        for observation in &mut graph.observations {
            observation.landmark = merged
                .get(observation.landmark)
                .copied()
                .unwrap_or(observation.landmark);
        }
        measure(graph);
    }
    let places = drop_unobserved(graph);
    merged
        .iter()
        .map(|whole| places.get(*whole).copied().flatten())
        .collect()
}

fn reject_outliers(graph: &mut Graph) {
    let mut observations = core::mem::take(&mut graph.observations);
    observations.retain(|observation| graph.off_m(observation).abs() <= CLEANUP.outlier_m);
    graph.observations = observations;
}

/// Measures the ends of each landmark and counts its observations again, with the present poses.
fn measure(graph: &mut Graph) {
    graph.reset_extents();
    let observations = core::mem::take(&mut graph.observations);
    for observation in &observations {
        graph.extend_landmark(observation);
    }
    graph.observations = observations;
}

/// For each landmark the one into which it is merged.
fn merged(landmarks: &[LineLandmark]) -> Vec<usize> {
    let mut merged: Vec<usize> = (0..landmarks.len()).collect();
    for (index, landmark) in landmarks.iter().enumerate() {
        let other = landmarks
            .iter()
            .take(index)
            .enumerate()
            .find(|(other, longer)| merged.get(*other) == Some(other) && are_mergeable(longer, landmark));
        if let (Some((other, _)), Some(place)) = (other, merged.get_mut(index)) {
            *place = other;
        }
    }
    merged
}

/// Drops the landmarks without observations. Returns the new index of each landmark.
fn drop_unobserved(graph: &mut Graph) -> Vec<Option<usize>> {
    let mut kept = 0..;
    let places: Vec<Option<usize>> = graph
        .landmarks
        .iter()
        .map(|landmark| {
            if landmark.observation_count > 0 {
                kept.next()
            } else {
                None
            }
        })
        .collect();
    let place = |observation: &LineObservation| places.get(observation.landmark).copied().flatten();
    for observation in &mut graph.observations {
        observation.landmark = place(observation).unwrap_or(observation.landmark);
    }
    graph.landmarks.retain(|landmark| landmark.observation_count > 0);
    places
}

/// Whether two landmarks face the same way.
pub(super) fn face_the_same_way(one: &LineLandmark, other: &LineLandmark) -> bool {
    let turned_rad = normalize_rad(one.normal_rad - other.normal_rad);
    turned_rad.abs() <= CLEANUP.merge_max_rad && one.quarter == other.quarter
}

fn are_mergeable(one: &LineLandmark, other: &LineLandmark) -> bool {
    if !face_the_same_way(one, other) {
        return false;
    }
    let end = |along_m: f64| one.project(other.at(along_m));
    let ends = [end(other.low_m), end(other.high_m)];
    let is_near = ends.iter().all(|end| end.off_m.abs() <= CLEANUP.merge_max_m);
    let low_m = ends[0].along_m.min(ends[1].along_m);
    let high_m = ends[0].along_m.max(ends[1].along_m);
    is_near && (low_m - one.high_m).max(one.low_m - high_m) <= CLEANUP.merge_gap_max_m
}
