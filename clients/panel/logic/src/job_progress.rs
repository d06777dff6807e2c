//! How far the running job is, and what became of the last one, for people.

use rvac_api::{Estimate, PlannedPath, Run, RunJob, Status};

use crate::codes::{run_text, state_title};
use crate::figures::{area_text, clock_text, percent_text};
use crate::history::room_here_text;
use crate::words::Words;

/// Robots that have not driven far yet count as this fast, m/s.
const USUAL_M_PER_S: f64 = 0.2;
/// A job that has lasted as long says itself how fast it is.
const MEASURED_AFTER_S: f64 = 60.0;
/// Bounds of what is believed of it, m/s: turns, bumps and short pauses count.
const SLOWEST_M_PER_S: f64 = 0.05;
const FASTEST_M_PER_S: f64 = 0.4;
/// A planned path that is shorter says nothing of the job: the robot plans anew at its end.
const LEAST_M: f64 = 2.0;

/// Length of a planned path in metres, with what is planned behind a wall: the robot cleans there too, once it has found another way.
#[must_use]
pub fn route_length_m(path: &PlannedPath) -> f64 {
    let corner = |point: &[i32]| match point {
        [x, y] => Some([f64::from(*x), f64::from(*y)]),
        _ => None,
    };
    let corners: Vec<[f64; 2]> = path.points_mm.chunks(2).filter_map(corner).collect();
    let steps = corners.windows(2).map(|pair| match pair {
        [from, to] => (to[0] - from[0]).hypot(to[1] - from[1]),
        _ => 0.0,
    });
    (steps.sum::<f64>() + f64::from(path.beyond_mm)) / 1000.0
}

/// What is known of the end of the running job.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobProgress {
    /// Seconds that the planned path takes.
    pub left_s: Option<f64>,
    /// Share that is done, 0..1.
    pub share: Option<f64>,
}

impl JobProgress {
    /// By the length of the planned path and the robot's own estimate; nothing while no job runs.
    #[must_use]
    pub fn of(status: &Status, route_m: f64, estimate: Option<&Estimate>) -> Self {
        if !matches!(status.state.as_str(), "cleaning" | "paused") {
            return Self::default();
        }
        let speed = if status.job_s >= MEASURED_AFTER_S {
            (status.path_m / status.job_s).clamp(SLOWEST_M_PER_S, FASTEST_M_PER_S)
        } else {
            USUAL_M_PER_S
        };
        let left_s = (route_m >= LEAST_M).then_some(route_m / speed);
        Self {
            left_s,
            share: estimate.and_then(|estimate| estimate.covered),
        }
    }

    /// As a sentence; nothing where nothing is known.
    #[must_use]
    pub fn text(&self, words: &Words) -> Option<String> {
        let texts = &words.status;
        let done = self.share.map(|share| percent_text(words, share));
        let left = self.left_s.map(|left_s| (left_s / 60.0).ceil().max(1.0));
        match (left, done) {
            (Some(left), Some(done)) => Some(texts.left_and_done.fill([&words.number(left, 0), &done])),
            (Some(left), None) => Some(texts.minutes_left.fill([&words.number(left, 0)])),
            (None, Some(done)) => Some(texts.done_so_far.fill([&done])),
            (None, None) => None,
        }
    }
}

/// What the robot does and where, in a few words.
#[must_use]
pub fn headline(words: &Words, status: &Status) -> String {
    let title = state_title(words, &status.state);
    match &status.room {
        Some(room) if matches!(status.state.as_str(), "cleaning" | "spot" | "paused") => {
            format!("{title}: {}", room_here_text(words, room))
        }
        _ => title.to_owned(),
    }
}

/// What became of a job that is over, in one line; nothing of drives to the dock or to a place.
#[must_use]
pub fn run_summary(words: &Words, run: &Run) -> Option<String> {
    if matches!(run.job, RunJob::Dock | RunJob::GoTo) {
        return None;
    }
    let texts = &words.status;
    let (area, lasted) = (area_text(words, run.swept_m2), clock_text(run.duration_s));
    let figures = match run.share {
        Some(share) if share < 0.995 => {
            let (done, left) = (percent_text(words, share), percent_text(words, 1.0 - share));
            texts.summary_left.fill([&area, &lasted, &done, &left])
        }
        Some(_) => texts.summary_whole.fill([&area, &lasted]),
        None => texts.summary.fill([&area, &lasted]),
    };
    Some(format!("{} {figures}", run_text(words, run)))
}

#[cfg(test)]
mod tests {
    use super::{JobProgress, headline, route_length_m, run_summary};
    use crate::words::{Language, Words};
    use rvac_api::{Estimate, PlannedPath, RoomHere, Run, RunAsker, RunJob, RunResult, Status};

    const ENGLISH: &Words = Language::English.words();

    fn cleaning(job_s: f64, path_m: f64) -> Status {
        Status {
            state: "cleaning".to_owned(),
            job_s,
            path_m,
            ..Status::default()
        }
    }

    fn covered(share: f64) -> Estimate {
        Estimate {
            sigma_m: 0.0,
            sigma_rad: 0.0,
            lost: false,
            agreement: None,
            covered: Some(share),
            covered_low: None,
            map_doubt: None,
        }
    }

    #[test]
    fn the_planned_path_says_how_long_it_takes() {
        let path = PlannedPath {
            points_mm: vec![0, 0, 3000, 0, 3000, 4000],
            beyond_mm: 0,
        };
        assert!((route_length_m(&path) - 7.0).abs() < 1e-9);
        let cut = PlannedPath {
            beyond_mm: 2_500,
            ..path
        };
        assert!((route_length_m(&cut) - 9.5).abs() < 1e-9);
        assert!(route_length_m(&PlannedPath::default()) < 1e-9);
        let job = JobProgress::of(&cleaning(100.0, 10.0), 30.0, Some(&covered(0.62)));
        assert_eq!(
            job.text(ENGLISH).as_deref(),
            Some("About 5\u{a0}min left, 62\u{a0}% done.")
        );
        let young = JobProgress::of(&cleaning(5.0, 0.1), 30.0, None);
        assert_eq!(young.text(ENGLISH).as_deref(), Some("About 3\u{a0}min left."));
        let exploring = JobProgress::of(&cleaning(5.0, 0.1), 0.5, None);
        assert_eq!(exploring.text(ENGLISH), None);
        let idle = Status {
            state: "idle".to_owned(),
            ..Status::default()
        };
        assert_eq!(
            JobProgress::of(&idle, 30.0, Some(&covered(0.5))),
            JobProgress::default()
        );
    }

    #[test]
    fn the_headline_says_what_and_where() {
        let mut status = cleaning(1.0, 0.0);
        assert_eq!(headline(ENGLISH, &status), "Cleaning");
        status.room = Some(RoomHere {
            id: 2,
            name: Some("Köök".to_owned()),
        });
        assert_eq!(headline(ENGLISH, &status), "Cleaning: Köök");
        assert_eq!(headline(Language::Estonian.words(), &status), "Koristab: Köök");
    }

    fn run(share: Option<f64>, job: RunJob) -> Run {
        Run {
            number: 1,
            job,
            by: RunAsker::Robot,
            start_s: None,
            end_s: None,
            clock_set_s: None,
            duration_s: 1091.0,
            moving_s: 1000.0,
            swept_m2: 23.44,
            share,
            path_m: 90.0,
            bumps: 3,
            charge_start: None,
            charge_end: None,
            result: RunResult::Finished,
            reason: String::new(),
            text: "Finished.".to_owned(),
            stop_count: 0,
            floor: None,
            map: None,
            recordings: Vec::new(),
        }
    }

    #[test]
    fn the_end_is_summarized_with_what_was_left() {
        let summary = |share| run_summary(ENGLISH, &run(share, RunJob::Spot)).unwrap();
        assert!(
            summary(None).ends_with("23.4\u{a0}m² in 18:11."),
            "{}",
            summary(None)
        );
        assert!(
            summary(Some(0.93)).ends_with(
                "23.4\u{a0}m² in 18:11: 93\u{a0}% of the floor. 7\u{a0}% could not be reached or was left."
            ),
            "{}",
            summary(Some(0.93))
        );
        assert!(summary(Some(1.0)).ends_with("23.4\u{a0}m² in 18:11: all of the floor."));
        assert_eq!(run_summary(ENGLISH, &run(None, RunJob::Dock)), None);
    }
}
