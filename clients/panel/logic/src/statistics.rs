//! What all runs come to, for people who read.

use rvac_api::Statistics;

use crate::codes::explain;
use crate::figures::distance_text;
use crate::words::{Template, Words};

/// Causes of stops that are listed, the most frequent first.
const CAUSES_MAX: usize = 8;

/// The whole in one line; `None` before the first run has ended.
#[must_use]
pub fn statistics_headline(words: &Words, sums: &Statistics) -> Option<String> {
    if sums.runs.is_empty() {
        return None;
    }
    let texts = &words.history;
    let cleanings = count(sums, "clean");
    let cleanings = match cleanings {
        1 => texts.one_cleaning.to_owned(),
        many => texts.cleanings.fill([&many]),
    };
    let hours = texts.hours.fill([&words.number(sums.moving_h, 1)]);
    let area = words.unit.square_metres.fill([&words.number(sums.swept_m2, 0)]);
    Some(texts.lifetime.fill([&cleanings, &hours, &area]))
}

/// The figures: what they are and what they say.
#[must_use]
pub fn statistics_rows(words: &Words, sums: &Statistics) -> Vec<(String, String)> {
    let texts = &words.history;
    let hours = |hours: f64| texts.hours.fill([&words.number(hours, 1)]);
    let mut rows = vec![
        (texts.runs_of_all.to_owned(), jobs(words, sums)),
        (texts.ended_by.to_owned(), ends(words, sums)),
        (texts.duration.to_owned(), hours(sums.duration_h)),
        (texts.in_motion.to_owned(), hours(sums.moving_h)),
        (
            texts.distance.to_owned(),
            distance_text(words, sums.path_km * 1e3),
        ),
        (texts.bumps.to_owned(), sums.bumps.to_string()),
    ];
    rows.extend(causes(words, sums));
    rows
}

fn count(sums: &Statistics, job: &str) -> u64 {
    sums.runs.get(job).copied().unwrap_or(0)
}

fn jobs(words: &Words, sums: &Statistics) -> String {
    let texts = &words.history;
    let kinds = [
        (count(sums, "clean"), texts.count_cleanings),
        (count(sums, "spot"), texts.count_spots),
        (count(sums, "go-to"), texts.count_drives),
        (count(sums, "dock"), texts.count_returns),
    ];
    join(kinds)
}

fn ends(words: &Words, sums: &Statistics) -> String {
    let texts = &words.history;
    let of = |names: &[&str]| -> u64 { names.iter().filter_map(|name| sums.results.get(*name)).sum() };
    let kinds = [
        (of(&["finished"]), texts.end_finished),
        (of(&["stopped"]), texts.end_stopped),
        (of(&["gave-up"]), texts.end_gave_up),
        (of(&["daemon-ended", "cut-short", "other-robot"]), texts.end_other),
    ];
    join(kinds)
}

/// Those of which there are some.
fn join<const N: usize>(kinds: [(u64, Template<1>); N]) -> String {
    let parts = kinds.into_iter().filter(|(count, _)| *count > 0);
    parts
        .map(|(count, text)| text.fill([&count]))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Why it stopped or waited on its way, the most frequent first.
fn causes(words: &Words, sums: &Statistics) -> Vec<(String, String)> {
    sums.stops_most_first()
        .into_iter()
        .take(CAUSES_MAX)
        .map(|(code, count)| {
            let cause = explain(words, code).map_or(code, |known| known.cause);
            (
                cause.trim_end_matches('.').to_owned(),
                words.history.times_stopped.fill([&count]),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{statistics_headline, statistics_rows};
    use crate::words::Language;
    use rvac_api::Statistics;

    fn sums() -> Statistics {
        let counts = |all: &[(&str, u64)]| {
            all.iter()
                .map(|(name, count)| ((*name).to_owned(), *count))
                .collect()
        };
        Statistics {
            since_s: Some(1_800_000_000),
            runs: counts(&[("clean", 12), ("dock", 3)]),
            results: counts(&[("finished", 13), ("gave-up", 1), ("cut-short", 1)]),
            stops: counts(&[("button-stop", 1), ("wheel-drop", 5), ("of-tomorrow", 2)]),
            duration_h: 20.0,
            moving_h: 9.75,
            swept_m2: 412.4,
            path_km: 7.25,
            bumps: 904,
        }
    }

    #[test]
    fn one_line_says_the_whole_and_nothing_is_said_of_no_runs() {
        let english = Language::English.words();
        assert_eq!(
            statistics_headline(english, &sums()).as_deref(),
            Some("All together: 12 cleanings, 9.8 hours, 412\u{a0}m²")
        );
        assert_eq!(statistics_headline(english, &Statistics::default()), None);
        let estonian = statistics_headline(Language::Estonian.words(), &sums()).unwrap();
        assert!(estonian.contains("12 koristust, 9,8 tundi"), "{estonian}");
    }

    #[test]
    fn the_most_frequent_cause_comes_first_and_one_without_words_is_named() {
        let rows = statistics_rows(Language::English.words(), &sums());
        let said: Vec<&str> = rows.iter().map(|(_, said)| said.as_str()).collect();
        assert_eq!(said[0], "cleanings:\u{a0}12, returns to the dock:\u{a0}3");
        assert_eq!(said[1], "13 finished, 1 given up, 1 cut short");
        assert!(rows[6].0.contains("wheel") && said[6] == "5x", "{rows:?}");
        assert_eq!(rows[7], ("of-tomorrow".to_owned(), "2x".to_owned()));
    }
}
