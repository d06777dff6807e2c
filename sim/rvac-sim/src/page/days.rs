//! Curves over runs that follow each other.

use super::chart::{Chart, Curve};
use super::{COLOURS, escape, put};
use crate::days::KeptDays;

/// Figures by chart: heading, and keys of what it shows.
const CHARTS: [(&str, &[&str]); 10] = [
    ("Share swept", &["swept"]),
    (
        "Time until 90 % and 95 % were swept, T0",
        &["t90_over_t0", "t95_over_t0"],
    ),
    ("Bumps a square metre", &["bumps_per_m2"]),
    (
        "Place, aligned, m: median and 90th percentile in a run",
        &["place_median_aligned_m", "place_p90_aligned_m"],
    ),
    ("Share told and true one, distance", &["told_minus_true"]),
    (
        "Agreement of the map with the home, aligned",
        &["map_iou_aligned"],
    ),
    (
        "Distance of walls from true ones, aligned, m",
        &["wall_error_aligned_m"],
    ),
    (
        "Obstacles that do not exist, and those that the map lacks, m²",
        &["false_obstacle_m2", "missing_obstacle_m2"],
    ),
    (
        "Seconds lost, and wrong unnoticed",
        &["lost_s", "unnoticed_wrong_s"],
    ),
    ("Bytes of the map", &["map_bytes"]),
];

/// All charts of some chains.
pub(super) fn write_days(page: &mut String, kept: &KeptDays) {
    put(
        page,
        format_args!(
            "<h2>{}</h2><p>Each run began with what the run before left. Lines are medians over homes and seeds, dashed ones the \
             90th percentile toward the worse.</p><div class=\"row\">\n",
            escape(&kept.title)
        ),
    );
    for (heading, figures) in CHARTS {
        if let Some(chart) = chart(kept, figures) {
            put(
                page,
                format_args!(
                    "<div class=\"card\"><h3>{heading}</h3>{}{chart}</div>\n",
                    key(figures)
                ),
            );
        }
    }
    page.push_str("</div>\n");
}

/// Which colour is what, where a chart shows more than one figure.
fn key(figures: &[&str]) -> String {
    if figures.len() < 2 {
        return String::new();
    }
    let names = figures.iter().zip(COLOURS).map(|(figure, colour)| {
        let name = escape(&figure.replace('_', " "));
        format!("<span class=\"key\" style=\"background:{colour}\"></span>{name} ")
    });
    format!("<p>{}</p>", names.collect::<String>())
}

/// `None` where no run has any of the figures.
fn chart(kept: &KeptDays, figures: &[&str]) -> Option<String> {
    let mut curves = Vec::new();
    for (figure, colour) in figures.iter().zip(COLOURS) {
        for (which, dashed) in [("median", false), ("p90", true)] {
            curves.push(Curve {
                colour,
                dashed,
                points: kept.curve(figure, which),
            });
        }
    }
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (runs, most) = points().fold((1.0_f64, 0.0_f64), |(runs, most), (run, value)| {
        (runs.max(*run), most.max(*value))
    });
    points().next()?;
    let y_max = if most > 0.0 { 1.05 * most } else { 1.0 };
    Some(
        Chart {
            x_max: runs,
            y_max,
            curves: &curves,
        }
        .svg(),
    )
}

#[cfg(test)]
mod tests {
    use super::write_days;
    use crate::days::KeptDays;

    #[test]
    fn a_page_has_a_chart_of_each_figure_that_some_run_has() {
        let day = |run: u32| {
            serde_json::json!({
                "run": run,
                "swept": {"median": 0.95, "p90": 0.9, "missing": 0},
                "t90_over_t0": {"median": 1.5, "p90": null, "missing": 1},
            })
        };
        let kept = KeptDays {
            title: "Two <homes>".to_owned(),
            days: (1..=3).map(day).collect(),
        };
        let mut page = String::new();
        write_days(&mut page, &kept);
        assert_eq!(page.matches("<svg").count(), 2);
        assert!(page.contains("Two &lt;homes&gt;") && page.contains("Share swept"));
        assert_eq!(
            kept.curve("t90_over_t0", "median"),
            [(1.0, 1.5), (2.0, 1.5), (3.0, 1.5)]
        );
        assert!(kept.curve("t90_over_t0", "p90").is_empty());
    }
}
