//! The home with the robot's path, and beside it the robot's map.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::trace::{DROP, Drawing, FLOOR, KeptRun, NOTHING, OUT_OF_REACH, RUG, SOLID, Sample};

/// Colours of the path from its beginning to its end.
const WAY: [&str; 5] = ["#9ecae1", "#6baed6", "#4292c6", "#2171b5", "#084594"];

/// Both pictures of a run, with what they show.
pub(super) fn pictures(run: &KeptRun) -> String {
    let mut both = format!(
        "<figure><figcaption>The home, the way (light to dark), {} bumps, the dock</figcaption>{}</figure>",
        run.trace.bumps.len(),
        truth(run)
    );
    if let Some(drawn) = drawn(run) {
        write!(
            both,
            "<figure><figcaption>The robot's map at the end{}</figcaption>{drawn}</figure>",
            verdict(run)
        )
        // Writing into a string cannot fail.
        .ok();
    }
    both
}

/// How well the map agrees with the home, as placed and laid over it.
fn verdict(run: &KeptRun) -> String {
    let agreement = |key: &str| run.report[key].as_f64();
    let both = |placed: &str, aligned: &str, text: fn(f64) -> String| {
        let aligned = agreement(aligned).map_or_else(String::new, |value| {
            format!(" ({} laid over the home)", text(value))
        });
        agreement(placed).map(|value| format!("{}{aligned}", text(value)))
    };
    let iou = both("map_iou", "map_iou_aligned", |iou| format!("{iou:.3}"));
    let iou = iou.map_or_else(String::new, |iou| format!(", IoU {iou}"));
    let wall = both("wall_error_m", "wall_error_aligned_m", |wall_m| {
        format!("{:.1} cm", 100.0 * wall_m)
    });
    let wall = wall.map_or_else(String::new, |wall| format!(", walls {wall} off"));
    let carpet = agreement("carpet_recall").map_or_else(String::new, |recall| {
        let right = agreement("carpet_precision").map_or_else(String::new, |right| {
            format!(", {:.0} % of what it takes for carpet is", 100.0 * right)
        });
        format!(", {:.0} % of the rugs it swept found{right}", 100.0 * recall)
    });
    format!("{iou}{wall}{carpet}")
}

/// The home with the path, bumps and the dock.
pub(super) fn truth(run: &KeptRun) -> String {
    let content = format!(
        "{}{}{}{}",
        cells(&run.plan),
        path(&run.trace.samples),
        bumps(&run.trace.bumps),
        dock(run.dock)
    );
    frame(run, &content)
}

/// The robot's map, if it has one.
pub(super) fn drawn(run: &KeptRun) -> Option<String> {
    let map = run.map.as_ref()?;
    Some(frame(run, &format!("{}{}", cells(map), dock(run.dock))))
}

fn frame(run: &KeptRun, content: &str) -> String {
    let (width_m, height_m) = extent(&run.plan);
    format!(
        "<svg viewBox=\"0 0 {width_m:.2} {height_m:.2}\" role=\"img\"><g transform=\"translate(0 {height_m:.2}) scale(1 -1)\">{content}</g></svg>"
    )
}

fn extent(drawing: &Drawing) -> (f64, f64) {
    let count: u32 = drawing.runs.chunks_exact(2).map(|pair| pair[1]).sum();
    let rows = (count as usize).checked_div(drawing.width).unwrap_or(0);
    (
        drawing.width as f64 * drawing.cell_m,
        rows as f64 * drawing.cell_m,
    )
}

const fn colour(kind: u32) -> &'static str {
    match kind {
        FLOOR => "#ffffff",
        SOLID => "#4a4038",
        DROP => "#d9534f",
        RUG => "#f3e7c4",
        OUT_OF_REACH => "#d8dbdd",
        _ => "#b9bfc4",
    }
}

/// Cells as one path a kind: rectangles of equal rows.
fn cells(drawing: &Drawing) -> String {
    let mut paths: BTreeMap<u32, String> = BTreeMap::new();
    let mut growing: BTreeMap<(u32, usize, usize), usize> = BTreeMap::new();
    let rows = rows(drawing);
    for (row, segments) in rows.iter().enumerate() {
        let ended: Vec<_> = growing
            .keys()
            .filter(|segment| !segments.contains(segment))
            .copied()
            .collect();
        for segment in ended {
            if let Some(first) = growing.remove(&segment) {
                rectangle(&mut paths, segment, (first, row));
            }
        }
        for segment in segments {
            growing.entry(*segment).or_insert(row);
        }
    }
    for (segment, first) in growing {
        rectangle(&mut paths, segment, (first, rows.len()));
    }
    let [x, y, turn_rad] = drawing.origin;
    let mut svg = format!(
        "<g transform=\"translate({x:.4} {y:.4}) rotate({:.4}) scale({})\" shape-rendering=\"crispEdges\">",
        turn_rad.to_degrees(),
        drawing.cell_m
    );
    for (kind, path) in paths {
        write!(svg, "<path fill=\"{}\" d=\"{path}\"/>", colour(kind)).ok();
    }
    svg.push_str("</g>");
    svg
}

fn rectangle(
    paths: &mut BTreeMap<u32, String>,
    (kind, start, end): (u32, usize, usize),
    (low, high): (usize, usize),
) {
    let path = paths.entry(kind).or_default();
    let (width, height) = (end - start, high - low);
    write!(path, "M{start} {low}h{width}v{height}h-{width}z").ok();
}

/// Segments of equal cells of each row: kind, first column, end. What is nothing is left out.
fn rows(drawing: &Drawing) -> Vec<Vec<(u32, usize, usize)>> {
    let width = drawing.width.max(1);
    let mut rows: Vec<Vec<(u32, usize, usize)>> = Vec::new();
    let mut at = 0;
    for pair in drawing.runs.chunks_exact(2) {
        let (kind, end) = (pair[0], at + pair[1] as usize);
        while at < end {
            let (row, column) = (at / width, at % width);
            let stop = (column + end - at).min(width);
            if rows.len() <= row {
                rows.resize_with(row + 1, Vec::new);
            }
            if kind != NOTHING
                && let Some(segments) = rows.get_mut(row)
            {
                segments.push((kind, column, stop));
            }
            at += stop - column;
        }
    }
    rows
}

fn path(samples: &[Sample]) -> String {
    let mut svg = String::new();
    let length = samples.len().div_ceil(WAY.len()).max(1);
    for (number, colour) in WAY.iter().enumerate() {
        let first = number * length;
        // One sample more, so that the pieces join.
        let end = (first + length + 1).min(samples.len());
        let Some(piece) = samples.get(first..end) else {
            break;
        };
        let points: Vec<String> = piece
            .iter()
            .map(|sample| format!("{:.2},{:.2}", sample.place[0], sample.place[1]))
            .collect();
        write!(
            svg,
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"0.03\" points=\"{}\"/>",
            points.join(" ")
        )
        .ok();
    }
    svg
}

fn bumps(places: &[[f64; 2]]) -> String {
    let mut svg = String::from("<g fill=\"#d55e00\" fill-opacity=\"0.7\">");
    for [x, y] in places {
        write!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"0.04\"/>").ok();
    }
    svg.push_str("</g>");
    svg
}

fn dock(place: Option<[f64; 2]>) -> String {
    place.map_or_else(String::new, |[x, y]| {
        format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"0.12\" fill=\"#009e73\"/>")
    })
}

#[cfg(test)]
mod tests {
    use super::rows;
    use crate::trace::{Drawing, FLOOR, NOTHING, SOLID};

    #[test]
    fn runs_that_go_over_the_end_of_a_row_are_cut() {
        let drawing = Drawing {
            cell_m: 0.02,
            width: 4,
            origin: [0.0; 3],
            runs: vec![NOTHING, 1, FLOOR, 5, SOLID, 2],
        };
        assert_eq!(
            rows(&drawing),
            vec![vec![(FLOOR, 1, 4)], vec![(FLOOR, 0, 2), (SOLID, 2, 4)]]
        );
    }
}
