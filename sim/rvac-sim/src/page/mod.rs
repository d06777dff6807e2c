//! One HTML page of several runs: coverage over time, pose error, the path, and the robot's map beside the ground
//! truth. Everything is drawn as SVG in the page itself; it needs no network and no scripts.

mod chart;
mod days;
mod map;
mod pictures;

use std::fmt::Write;

use serde_json::Value;

use crate::days::KeptDays;
use crate::trace::KeptRun;
use chart::{Chart, Curve};
pub use pictures::{Picture, pictures};

/// Colours of the runs of a home, suitable for colour-blind readers (Okabe and Ito 2008).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
/// Longest time that a chart of coverage shows, multiples of T0.
pub(crate) const LONGEST: f64 = 8.0;

const STYLE: &str = "\
body{font:15px/1.45 system-ui,sans-serif;color:#1d2730;background:#f4f5f3;margin:0}\
main{max-width:1180px;margin:0 auto;padding:24px}\
h1{font-size:26px;margin:0 0 4px}h2{font-size:21px;margin:36px 0 2px}h3{font-size:16px;margin:0 0 8px}\
p{margin:2px 0 10px;color:#55606a}\
.row{display:flex;flex-wrap:wrap;gap:16px}.card{background:#fff;border-radius:8px;padding:14px 16px;margin:8px 0;\
box-shadow:0 1px 3px #0002;flex:1 1 480px;min-width:0}\
svg{max-width:100%;height:auto;display:block}figure svg{background:#aab0b5;border-radius:4px}text{font:12px system-ui,sans-serif;fill:#55606a}\
table{border-collapse:collapse;font-size:14px;width:100%}td,th{padding:3px 10px 3px 0;text-align:right;\
border-bottom:1px solid #e8eaec}td:first-child,th:first-child{text-align:left}th{color:#55606a;font-weight:500}\
.key{display:inline-block;width:22px;height:3px;vertical-align:middle;margin-right:6px}\
figure{margin:0;flex:1 1 420px;min-width:0}figcaption{color:#55606a;font-size:13px;margin-bottom:4px}";

/// The page.
#[must_use]
pub fn write(runs: &[KeptRun], days: &[KeptDays]) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Runs of a simulated robot</title>\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body><main>\n\
         <h1>Runs of a simulated robot</h1><p>Times are multiples of T0, the time in which a robot that never turns and \
         never sweeps a place twice would sweep everything that it can reach.</p>\n"
    );
    let mut homes: Vec<&str> = runs.iter().map(home).collect();
    homes.dedup();
    for name in homes {
        let of_home: Vec<&KeptRun> = runs.iter().filter(|run| home(run) == name).collect();
        write_home(&mut page, name, &of_home);
    }
    for kept in days {
        days::write_days(&mut page, kept);
    }
    page.push_str("</main></body></html>\n");
    page
}

fn home(run: &KeptRun) -> &str {
    run.report["home"].as_str().unwrap_or("home")
}

fn number(run: &KeptRun, key: &str) -> Option<f64> {
    run.report[key].as_f64()
}

fn write_home(page: &mut String, name: &str, runs: &[&KeptRun]) {
    let first = |key| runs.first().and_then(|run| number(run, key)).unwrap_or(0.0);
    let t0_s = first("t0_s").max(1.0);
    put(
        page,
        format_args!(
            "<h2>{}</h2><p>{:.1} m² of floor, {:.1} m² can be swept, T0 = {:.1} min</p>\n",
            escape(name),
            first("free_area_m2"),
            first("reachable_area_m2"),
            t0_s / 60.0
        ),
    );
    let coverage = coverage(runs, t0_s);
    let error = pose_error(runs);
    put(
        page,
        format_args!(
            "<div class=\"row\"><div class=\"card\"><h3>Covered share, % over T0</h3>{coverage}</div>\
             <div class=\"card\"><h3>Error of the believed place, m over min</h3>{error}</div></div>\n"
        ),
    );
    figures(page, runs);
    for (run, colour) in runs.iter().zip(COLOURS.iter().cycle()) {
        put(
            page,
            format_args!(
                "<div class=\"card\"><h3><span class=\"key\" style=\"background:{colour}\"></span>{}</h3>\
                 <div class=\"row\">{}</div></div>\n",
                escape(&run.title),
                map::pictures(run)
            ),
        );
    }
}

/// Writing into a string cannot fail.
fn put(page: &mut String, text: std::fmt::Arguments<'_>) {
    page.write_fmt(text).ok();
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

fn coverage(runs: &[&KeptRun], t0_s: f64) -> String {
    let mut curves = vec![Curve {
        colour: "#8a949c",
        dashed: true,
        points: vec![(0.0, 0.0), (1.0, 100.0), (LONGEST, 100.0)],
    }];
    let mut longest = 2.0_f64;
    for (run, colour) in runs.iter().zip(COLOURS.iter().cycle()) {
        let samples = &run.trace.samples;
        let begun_s = samples
            .iter()
            .find(|sample| sample.cleans)
            .map_or(0.0, |sample| sample.t_s);
        let points: Vec<(f64, f64)> = samples
            .iter()
            .filter(|sample| sample.t_s >= begun_s)
            .map(|sample| ((sample.t_s - begun_s) / t0_s, 100.0 * sample.share))
            .take_while(|point| point.0 <= LONGEST)
            .collect();
        longest = points.last().map_or(longest, |point| longest.max(point.0));
        curves.push(Curve {
            colour,
            dashed: false,
            points,
        });
    }
    Chart {
        x_max: longest,
        y_max: 100.0,
        curves: &curves,
    }
    .svg()
}

fn pose_error(runs: &[&KeptRun]) -> String {
    let (mut curves, mut longest_min, mut worst_m) = (Vec::new(), 1.0_f64, 0.1_f64);
    for (run, colour) in runs.iter().zip(COLOURS.iter().cycle()) {
        let points: Vec<(f64, f64)> = run
            .trace
            .samples
            .iter()
            .map(|sample| (sample.t_s / 60.0, sample.error_m))
            .collect();
        longest_min = points
            .last()
            .map_or(longest_min, |point| longest_min.max(point.0));
        worst_m = points.iter().fold(worst_m, |worst, point| worst.max(point.1));
        curves.push(Curve {
            colour,
            dashed: false,
            points,
        });
    }
    Chart {
        x_max: longest_min,
        y_max: 1.05 * worst_m,
        curves: &curves,
    }
    .svg()
}

/// Figures by run: heading, key in the report, decimals.
const COLUMNS: [(&str, &str, usize); 9] = [
    ("80 %", "t80_over_t0", 2),
    ("90 %", "t90_over_t0", 2),
    ("95 %", "t95_over_t0", 2),
    ("share at 1.8 T0", "share_at_1_8_t0", 3),
    ("covered", "covered", 3),
    ("turning °/m²", "turn_deg_per_m2", 0),
    ("bumps/m²", "bumps_per_m2", 2),
    ("place, m", "pose_rmse_m", 3),
    ("lost, s", "lost_seconds", 0),
];

fn figures(page: &mut String, runs: &[&KeptRun]) {
    page.push_str("<div class=\"card\"><table><tr><th>run</th>");
    for (heading, _, _) in COLUMNS {
        put(page, format_args!("<th>{heading}</th>"));
    }
    page.push_str("</tr>\n<tr><td><span class=\"key\" style=\"background:#8a949c\"></span>lower bound</td><td>0.80</td><td>0.90</td><td>0.95</td><td>1.000</td><td>1.000</td><td>0</td><td>0</td><td>0</td><td>0</td></tr>\n");
    for (run, colour) in runs.iter().zip(COLOURS.iter().cycle()) {
        put(
            page,
            format_args!(
                "<tr><td><span class=\"key\" style=\"background:{colour}\"></span>{}</td>",
                escape(&run.title)
            ),
        );
        for (_, key, decimals) in COLUMNS {
            let text = match &run.report[key] {
                Value::Number(value) => format!("{:.decimals$}", value.as_f64().unwrap_or(f64::NAN)),
                _ => "–".to_owned(),
            };
            put(page, format_args!("<td>{text}</td>"));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table></div>\n");
}
