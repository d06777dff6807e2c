//! Runs and their stops for people who read.

use rvac_api::{Evidence, RoomHere, Run, RunAsker, RunJob, RunRecord, RunResult, RunStop};

use crate::codes::{run_text, stop_cause_text};
use crate::figures::{area_text, clock_text, distance_text, percent_text};
use crate::words::Words;

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
    /// The robot could not go on, or the reason is unknown.
    pub is_bad: bool,
}

/// The runs, newest first.
#[must_use]
pub fn run_rows(words: &Words, runs: &[Run]) -> Vec<RunRow> {
    runs.iter().map(|run| row(words, run)).collect()
}

fn row(words: &Words, run: &Run) -> RunRow {
    let mut figures = vec![job_text(words, &run.job), clock_text(run.duration_s)];
    if run.swept_m2 > 0.0 {
        figures.push(area_text(words, run.swept_m2));
    }
    if let (Some(start), Some(end)) = (run.charge_start, run.charge_end) {
        let (start, end) = (percent_text(words, start), percent_text(words, end));
        figures.push(words.history.battery_from_to.fill([&start, &end]));
    }
    if let Some(by_s) = run.clock_set_s {
        let set = if by_s < 0 {
            words.history.clock_set_back
        } else {
            words.history.clock_set_forward
        };
        figures.push(set.fill([&clock_text(by_s.unsigned_abs() as f64)]));
    }
    RunRow {
        number: run.number,
        start_s: run.start_s,
        words: run_text(words, run),
        figures: figures.join(", "),
        is_bad: matches!(run.result, RunResult::GaveUp | RunResult::CutShort),
    }
}

fn job_text(words: &Words, job: &RunJob) -> String {
    let texts = &words.history;
    let (rooms, zones, spots, passes) = match job {
        RunJob::Clean {
            rooms,
            zones,
            spots,
            passes,
            ..
        } => (rooms, zones, spots, passes),
        RunJob::Spot => return texts.spot.to_owned(),
        RunJob::GoTo => return texts.to_place.to_owned(),
        RunJob::Dock => return texts.to_dock.to_owned(),
    };
    let mut parts: Vec<String> = rooms.iter().map(|room| room_here_text(words, room)).collect();
    match zones {
        0 => {}
        1 => parts.push(texts.a_zone.to_owned()),
        count => parts.push(texts.zones.fill([count])),
    }
    match spots {
        0 => {}
        1 => parts.push(texts.a_spot.to_owned()),
        count => parts.push(texts.spots.fill([count])),
    }
    let place = if parts.is_empty() {
        texts.everything.to_owned()
    } else {
        parts.join(", ")
    };
    match passes {
        1 => place,
        times => texts.times.fill([&place, times]),
    }
}

/// What people call the room in which the robot is, else its number.
#[must_use]
pub fn room_here_text(words: &Words, room: &RoomHere) -> String {
    room.name
        .clone()
        .unwrap_or_else(|| words.schedule.room.fill([&room.id]))
}

/// Who asked for something.
fn asker_text(words: &Words, asker: &RunAsker) -> String {
    let texts = &words.history;
    match asker {
        RunAsker::Client(name) => name.clone(),
        RunAsker::Button => texts.by_button.to_owned(),
        RunAsker::Schedule { name, .. } => texts.by_schedule.fill([name]),
        RunAsker::Robot => texts.by_robot.to_owned(),
    }
}

/// For within a sentence.
fn uncapitalized(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(letters).collect()
}

/// All figures of a run: what they are and what they say.
#[must_use]
pub fn run_figures(words: &Words, run: &Run) -> Vec<(&'static str, String)> {
    let texts = &words.history;
    let asker = asker_text(words, &run.by);
    let share = run.share.map_or_else(String::new, |share| {
        texts.of_floor.fill([&percent_text(words, share)])
    });
    let swept = area_text(words, run.swept_m2);
    let mut figures = vec![
        (texts.order, job_text(words, &run.job)),
        (texts.asked_by, asker),
        (texts.duration, clock_text(run.duration_s)),
        (texts.in_motion, clock_text(run.moving_s)),
        (texts.swept, format!("{swept}{share}")),
        (texts.distance, distance_text(words, run.path_m)),
        (texts.bumps, run.bumps.to_string()),
    ];
    if let (Some(start), Some(end)) = (run.charge_start, run.charge_end) {
        let (start, end) = (percent_text(words, start), percent_text(words, end));
        figures.push((texts.battery, texts.from_to.fill([&start, &end])));
    }
    if let Some(map) = run.map {
        figures.push((texts.map, texts.version.fill([&map])));
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
    /// Sensor readings and attempts before, if it stopped by itself.
    pub evidence: Evidence,
}

/// The stops of a run, in order.
#[must_use]
pub fn stop_rows(words: &Words, record: &RunRecord) -> Vec<StopRow> {
    let row = |(index, stop): (usize, &RunStop)| StopRow {
        number: index + 1,
        at_s: stop.at_s,
        words: stop_text(words, stop),
        evidence: stop.evidence.clone(),
    };
    record.stops.iter().enumerate().map(row).collect()
}

fn stop_text(words: &Words, stop: &RunStop) -> String {
    let texts = &words.history;
    let lasted = match stop.lasted_s {
        Some(lasted_s) => texts.lasted.fill([&clock_text(lasted_s)]),
        None => texts.until_end.to_owned(),
    };
    // Older records have the robot's own English words only.
    let asker = stop.asker.as_ref().map(|asker| match asker {
        RunAsker::Client(name) => name.clone(),
        other => uncapitalized(&asker_text(words, other)),
    });
    let asker = asker.or_else(|| stop.by.clone());
    let by = asker.map_or_else(String::new, |by| texts.by.fill([&by]));
    let (cause, at) = (stop_cause_text(words, stop), clock_text(stop.at_s));
    texts.stop.fill([&cause, &by, &at, &lasted])
}

#[cfg(test)]
mod tests {
    use rvac_api::{RunAsker, RunRecord};

    use super::{run_figures, run_rows, stop_rows};
    use crate::words::{Language, Words};

    const ENGLISH: &Words = Language::English.words();

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
                    spots: 0,
                    passes: 2,
                },
                by: rvac_api::RunAsker::Button,
                start_s: None,
                end_s: None,
                clock_set_s: None,
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
                text: "Paused: it was requested.".to_owned(),
                remedy: String::new(),
                by: Some("panel".to_owned()),
                asker: None,
                place: rvac_api::Pose::default(),
                evidence: rvac_api::Evidence::default(),
            }],
            picture: None,
        }
    }

    #[test]
    fn a_run_reads_well() {
        let record = kept();
        let [row] = run_rows(ENGLISH, std::slice::from_ref(&record.run))
            .try_into()
            .expect("one");
        assert_eq!(
            row.figures,
            "Köök, a zone, 2 times, 1:05:05, 12.3\u{a0}m², battery 98\u{a0}% to 71\u{a0}%"
        );
        assert!(row.is_bad);
        let figures = run_figures(ENGLISH, &record.run);
        assert!(figures.contains(&("Cleaned", "12.3\u{a0}m² (50\u{a0}% of that floor)".to_owned())));
        assert_eq!(
            stop_rows(ENGLISH, &record)[0].words,
            "Paused: it was requested. By panel. At 1:01, for 0:12."
        );
        let estonian = Language::Estonian.words();
        assert_eq!(
            run_rows(estonian, std::slice::from_ref(&record.run))[0].words,
            "Robot andis alla: rattad libisevad."
        );
        assert_eq!(
            stop_rows(estonian, &record)[0].words,
            "Pausil: keegi palus seda. Andis panel. Ajal 1:01, kestis 0:12."
        );
        let mut set_back = record.run.clone();
        set_back.clock_set_s = Some(-3_600);
        let row = &run_rows(ENGLISH, &[set_back])[0];
        assert!(
            row.figures.ends_with(", the clock was set back by 1:00:00"),
            "{}",
            row.figures
        );
        let mut pressed = record;
        pressed.stops[0].by = Some("the button on the robot".to_owned());
        pressed.stops[0].asker = Some(RunAsker::Button);
        assert_eq!(
            stop_rows(estonian, &pressed)[0].words,
            "Pausil: keegi palus seda. Andis nupp robotil. Ajal 1:01, kestis 0:12."
        );
    }
}
