//! Runs and their stops for people who read.

use rvac_api::{Run, RunAsker, RunJob, RunRecord, RunResult, RunStop};

use crate::figures::{area_text, clock_text, distance_text, percent_text};

/// A run in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunRow {
    /// Its number.
    pub number: u64,
    /// When it began, seconds since 1970; `None` = the clock was not set.
    pub start_s: Option<i64>,
    /// What came of it.
    pub words: String,
    /// Its figures.
    pub figures: String,
    /// The robot could not go on, or nobody knows.
    pub is_bad: bool,
}

/// The runs, newest first.
#[must_use]
pub fn run_rows(runs: &[Run]) -> Vec<RunRow> {
    runs.iter().map(row).collect()
}

fn row(run: &Run) -> RunRow {
    let mut figures = vec![job_text(&run.job), clock_text(run.duration_s)];
    if run.swept_m2 > 0.0 {
        figures.push(area_text(run.swept_m2));
    }
    figures.extend(charge_text(run));
    RunRow {
        number: run.number,
        start_s: run.start_s,
        words: run.text.clone(),
        figures: figures.join(", "),
        is_bad: matches!(run.result, RunResult::GaveUp | RunResult::CutShort),
    }
}

fn charge_text(run: &Run) -> Option<String> {
    let (start, end) = (run.charge_start?, run.charge_end?);
    Some(format!(
        "battery {} to {}",
        percent_text(start),
        percent_text(end)
    ))
}

fn job_text(job: &RunJob) -> String {
    let RunJob::Clean {
        rooms, zones, passes, ..
    } = job
    else {
        return if *job == RunJob::Spot {
            "Spot"
        } else {
            "To the dock"
        }
        .to_owned();
    };
    let mut parts: Vec<String> = rooms.iter().map(rvac_api::RoomHere::title).collect();
    match zones {
        0 => {}
        1 => parts.push("a zone".to_owned()),
        count => parts.push(format!("{count} zones")),
    }
    let place = if parts.is_empty() {
        "All".to_owned()
    } else {
        parts.join(", ")
    };
    match passes {
        1 => place,
        times => format!("{place}, {times} times"),
    }
}

/// All figures of a run: what they are and what they say.
#[must_use]
pub fn run_figures(run: &Run) -> Vec<(&'static str, String)> {
    let asker = match &run.by {
        RunAsker::Client(name) => name.clone(),
        RunAsker::Button => "Button on the robot".to_owned(),
        RunAsker::Schedule { name, .. } => format!("Schedule {name}"),
        RunAsker::Robot => "The robot itself".to_owned(),
    };
    let share = run.share.map_or_else(String::new, |share| {
        format!(" ({} of that floor)", percent_text(share))
    });
    let mut figures = vec![
        ("Order", job_text(&run.job)),
        ("Asked by", asker),
        ("Time", clock_text(run.duration_s)),
        ("In motion", clock_text(run.moving_s)),
        ("Swept", format!("{}{share}", area_text(run.swept_m2))),
        ("Way", distance_text(run.path_m)),
        ("Bumps", run.bumps.to_string()),
    ];
    if let (Some(start), Some(end)) = (run.charge_start, run.charge_end) {
        figures.push((
            "Battery",
            format!("{} to {}", percent_text(start), percent_text(end)),
        ));
    }
    if let Some(map) = run.map {
        figures.push(("Map", format!("version {map}")));
    }
    figures
}

/// A stop of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct StopRow {
    /// Its number in the run, from 1, as the picture shows it.
    pub number: usize,
    /// Seconds since the run began.
    pub at_s: f64,
    /// When, why and for how long.
    pub words: String,
}

/// The stops of a run, in order.
#[must_use]
pub fn stop_rows(record: &RunRecord) -> Vec<StopRow> {
    let row = |(index, stop): (usize, &RunStop)| StopRow {
        number: index + 1,
        at_s: stop.at_s,
        words: stop_text(stop),
    };
    record.stops.iter().enumerate().map(row).collect()
}

fn stop_text(stop: &RunStop) -> String {
    let lasted = match stop.lasted_s {
        Some(lasted_s) => format!("for {}", clock_text(lasted_s)),
        None => "until the end".to_owned(),
    };
    let by = stop
        .by
        .as_ref()
        .map_or_else(String::new, |by| format!(" By {by}."));
    format!("{}{by} At {}, {lasted}.", stop.text, clock_text(stop.at_s))
}

#[cfg(test)]
mod tests {
    use rvac_api::RunRecord;

    use super::{run_figures, run_rows, stop_rows};

    fn kept() -> RunRecord {
        RunRecord {
            run: rvac_api::Run {
                number: 7,
                job: rvac_api::RunJob::Clean {
                    strategy: "systematic".to_owned(),
                    rooms: vec![rvac_api::RoomHere {
                        id: 2,
                        name: Some("Köök".to_owned()),
                    }],
                    zones: 1,
                    passes: 2,
                },
                by: rvac_api::RunAsker::Button,
                start_s: None,
                end_s: None,
                duration_s: 3905.0,
                moving_s: 1800.0,
                swept_m2: 12.34,
                share: Some(0.5),
                path_m: 151.6,
                bumps: 12,
                charge_start: Some(0.98),
                charge_end: Some(0.71),
                result: rvac_api::RunResult::GaveUp,
                reason: "slip".to_owned(),
                text: "Gave up: its wheels slip.".to_owned(),
                stop_count: 1,
                floor: None,
                map: Some(3),
                recordings: vec![],
            },
            stops: vec![rvac_api::RunStop {
                at_s: 61.0,
                lasted_s: Some(12.0),
                state: "paused".to_owned(),
                reason: "command".to_owned(),
                text: "Paused: somebody asked for it.".to_owned(),
                by: Some("panel".to_owned()),
                place: rvac_api::Pose::default(),
                evidence: rvac_api::Evidence::default(),
            }],
            picture: None,
        }
    }

    #[test]
    fn a_run_reads_well() {
        let record = kept();
        let [row] = run_rows(std::slice::from_ref(&record.run))
            .try_into()
            .expect("one");
        assert_eq!(
            row.figures,
            "Köök, a zone, 2 times, 1:05:05, 12.3 m², battery 98 % to 71 %"
        );
        assert!(row.is_bad);
        let figures = run_figures(&record.run);
        assert!(figures.contains(&("Swept", "12.3 m² (50 % of that floor)".to_owned())));
        assert_eq!(
            stop_rows(&record)[0].words,
            "Paused: somebody asked for it. By panel. At 1:01, for 0:12."
        );
    }
}
