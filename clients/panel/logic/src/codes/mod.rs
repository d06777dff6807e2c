//! Codes come over the wire; people read sentences. A code without words in the language of the page is shown in the robot's own
//! English sentence, or shown as it is.

mod diary;
mod estonian;

pub use rvac_api::Explanation;
use rvac_api::{Decision, Failure, FloorQuestion, LogEntry, Run, RunResult, RunStop};

use crate::decimal::read_decimal;
use crate::words::{Language, Words};

const fn entry(code: &'static str, cause: &'static str, remedy: &'static str) -> (&'static str, Explanation) {
    (code, Explanation { cause, remedy })
}

fn find<T: Copy>(entries: &[(&str, T)], code: &str) -> Option<T> {
    entries
        .iter()
        .find(|(known, _)| *known == code)
        .map(|(_, told)| *told)
}

/// Headline of a state.
#[must_use]
pub fn state_title(words: &Words, state: &str) -> &'static str {
    let titles = &words.state;
    match state {
        "disconnected" => titles.disconnected,
        "idle" => titles.idle,
        "starting" => titles.starting,
        "cleaning" => titles.cleaning,
        "spot" => titles.spot,
        "going" => titles.going,
        "docking" => titles.docking,
        "docked" => titles.docked,
        "manual" => titles.manual,
        "paused" => titles.paused,
        "stuck" => titles.stuck,
        "error" => titles.error,
        _ => titles.unknown,
    }
}

/// Name of a cleaning pattern; one that is not known is shown by its code.
#[must_use]
pub fn strategy_title<'a>(words: &Words, strategy: &'a str) -> &'a str {
    let titles = &words.action;
    match strategy {
        "bounce" => titles.random,
        "wall-bounce" => titles.random_with_walls,
        "statistical" => titles.by_statistics,
        "systematic" => titles.rows,
        other => other,
    }
}

/// The explanation of a code; a code without explanation gives none and is shown as it is.
#[must_use]
pub fn explain(words: &Words, code: &str) -> Option<Explanation> {
    match words.language {
        Language::English => rvac_api::explain(code),
        Language::Estonian => find(estonian::CATALOGUE, code),
    }
}

/// What is said when the robot refuses, in few words that fit everywhere.
#[must_use]
pub fn failure_text(words: &Words, failure: &Failure) -> String {
    if failure.text.is_empty() {
        explain(words, &failure.reason).map_or_else(|| failure.reason.clone(), Explanation::text)
    } else {
        refusal_text(words, &failure.reason, &failure.text)
    }
}

/// What is said when the robot refuses something that has a place of its own for it: its own sentence is for that very thing.
#[must_use]
pub fn refusal_text(words: &Words, reason: &str, text: &str) -> String {
    match words.language {
        Language::English => text.to_owned(),
        Language::Estonian => find(estonian::REFUSALS, reason)
            .map(str::to_owned)
            .or_else(|| explain(words, reason).map(Explanation::text))
            .unwrap_or_else(|| text.to_owned()),
    }
}

/// What the robot asks about its floor.
#[must_use]
pub fn question_text(words: &Words, question: &FloorQuestion) -> String {
    match (words.language, question.reason.as_str()) {
        (Language::Estonian, "which-dock") => words.home.which_dock.to_owned(),
        (Language::Estonian, "floor-unknown") => words.home.floor_unknown.to_owned(),
        _ => question.text.clone(),
    }
}

/// A value of the device table that comes as a code.
#[must_use]
pub fn reading_text<'a>(words: &Words, code: &'a str) -> &'a str {
    match words.language {
        Language::English => code,
        Language::Estonian => find(estonian::READINGS, code).unwrap_or(code),
    }
}

/// What the robot decided, and why.
#[must_use]
pub fn decision_text(words: &Words, decision: &Decision) -> String {
    told_decision(words, decision).unwrap_or_else(|| decision.text.clone())
}

fn told_decision(words: &Words, decision: &Decision) -> Option<String> {
    let deed = find(deeds(words)?, &decision.what)?;
    let cause = cause(words, &decision.reason)?;
    Some(format!("{}: {cause}.", with_value(deed, decision)))
}

fn deeds(words: &Words) -> Option<&'static [(&'static str, &'static str)]> {
    match words.language {
        Language::English => None,
        Language::Estonian => Some(diary::DEEDS),
    }
}

/// A cause for the end of a sentence, in a language that is not the robot's own.
fn cause(words: &Words, code: &str) -> Option<String> {
    match words.language {
        Language::English => None,
        Language::Estonian => explain(words, code).map(estonian::clause),
    }
}

fn with_value(deed: &str, decision: &Decision) -> String {
    let value = match decision.what.as_str() {
        "plan" => (decision.value / 60.0).max(1.0),
        "covered" => 100.0 * decision.value.clamp(0.0, 1.0),
        _ => decision.value,
    };
    deed.replace("{}", &format!("{value:.0}"))
}

/// A line of the log, and whether it is in the language of the page. The brain's decisions are there as codes, `turn (bump-left)`; what
/// the daemon says besides are sentences in English.
#[must_use]
pub fn log_text(words: &Words, entry: &LogEntry) -> (String, bool) {
    let told = decided(entry).and_then(|decision| {
        let sentence = told_decision(words, &decision)?;
        let remedy = if entry.text.contains("): ") {
            explain(words, &decision.reason).map_or("", |told| told.remedy)
        } else {
            ""
        };
        Some(format!("{sentence} {remedy}").trim_end().to_owned())
    });
    let is_told = told.is_some() || words.language == Language::English;
    (told.unwrap_or_else(|| entry.text.clone()), is_told)
}

/// The decision in a line of the log, if there is one.
fn decided(entry: &LogEntry) -> Option<Decision> {
    let (what, rest) = entry.text.split_once(" (").filter(|_| entry.part == "brain")?;
    let (reason, value) = rest.split_once(')')?;
    Some(Decision {
        number: entry.number,
        t: entry.t,
        what: what.to_owned(),
        reason: reason.to_owned(),
        value: read_decimal(value.trim()).unwrap_or_default(),
        text: String::new(),
    })
}

/// What came of a run.
#[must_use]
pub fn run_text(words: &Words, run: &Run) -> String {
    if words.language == Language::English {
        return run.text.clone();
    }
    let texts = &words.history;
    let with_cause = |text: crate::words::Template<1>| {
        cause(words, &run.reason).map_or_else(|| run.text.clone(), |cause| text.fill([&cause]))
    };
    match (run.result, run.reason.as_str()) {
        (RunResult::Finished, "finished" | "docked") => texts.finished.to_owned(),
        (RunResult::Finished, _) => with_cause(texts.finished_as),
        (RunResult::Stopped, _) => texts.stopped.to_owned(),
        (RunResult::GaveUp, _) => with_cause(texts.gave_up),
        (RunResult::DaemonEnded, _) => texts.daemon_ended.to_owned(),
        (RunResult::CutShort, _) => texts.cut_short.to_owned(),
        (RunResult::OtherRobot, _) => texts.other_robot.to_owned(),
    }
}

/// Why the robot stopped during the run, and what can be done about it.
#[must_use]
pub fn stop_cause_text(words: &Words, stop: &RunStop) -> String {
    let told = cause(words, &stop.reason).map_or_else(
        || stop.text.clone(),
        |cause| format!("{}: {cause}.", state_title(words, &stop.state)),
    );
    let remedy = explain(words, &stop.reason).map_or(stop.remedy.as_str(), |known| known.remedy);
    format!("{told} {remedy}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use rvac_api::{Decision, LogEntry, LogLevel};

    use super::{decision_text, estonian, explain, find, log_text, state_title, strategy_title};
    use crate::words::Language;

    #[test]
    fn every_language_explains_the_same_codes() {
        for (code, english) in rvac_api::explanations() {
            let other = find(estonian::CATALOGUE, code).unwrap_or_else(|| panic!("{code} has no Estonian"));
            assert_eq!(other.remedy.is_empty(), english.remedy.is_empty(), "{code}");
            assert_ne!(other.cause, english.cause, "{code}");
            for sentence in [other.cause, other.remedy] {
                assert!(sentence.is_empty() || sentence.ends_with('.'), "{code}");
            }
        }
        assert_eq!(rvac_api::explanations().count(), estonian::CATALOGUE.len());
    }

    #[test]
    fn nothing_of_the_catalogue_has_a_second_wording() {
        for (code, _) in estonian::REFUSALS {
            assert_eq!(rvac_api::explain(code), None, "{code}");
        }
    }

    #[test]
    fn every_reason_of_the_brain_is_a_cause_in_estonian() {
        let words = Language::Estonian.words();
        let reasons = brain::Reason::all().map(brain::Reason::name);
        let refusals = brain::JobRefusal::all().map(brain::JobRefusal::name);
        let missing = |name: &&str| super::cause(words, name).is_none();
        let missing: Vec<_> = reasons.chain(refusals).filter(missing).collect();
        assert!(missing.is_empty(), "{missing:?}");
        let clause = |code| super::cause(words, code).expect("known");
        assert_eq!(clause("wheel-drop"), "ratas ripub õhus");
        assert_eq!(clause("place-unknown"), "ta ei tea, kus ta on");
        assert_eq!(clause("no-map"), "tal ei ole veel kodu kaarti");
    }

    #[test]
    fn every_decision_of_the_brain_is_shown_in_estonian() {
        let missing = |kind: &brain::DecisionKind| find(super::diary::DEEDS, kind.name()).is_none();
        let missing: Vec<_> = brain::DecisionKind::all().filter(missing).collect();
        assert!(missing.is_empty(), "{missing:?}");
        assert_eq!(brain::DecisionKind::all().count(), super::diary::DEEDS.len());
    }

    /// The book names every code with which a request is refused.
    #[test]
    fn every_refusal_of_the_book_is_shown_in_estonian() {
        let page = include_str!("../../../../../docs/book/src/socket-api.md");
        let requests: Vec<&str> = quoted(page, r#"{"c":""#, '"').collect();
        // A sentence about refusals begins with that word and ends with the row or the line.
        let told = page
            .split("efused")
            .skip(1)
            .filter_map(|rest| rest.split(['|', '\n']).next());
        let codes = told.flat_map(|told| quoted(told, "`", '`').step_by(2));
        let codes = codes.filter(|code| {
            code.contains('-') && code.chars().all(|sign| sign.is_ascii_lowercase() || sign == '-')
        });
        let mut seen = 0;
        for code in codes.filter(|code| !requests.contains(code)) {
            let is_told =
                find(estonian::REFUSALS, code).is_some() || find(estonian::CATALOGUE, code).is_some();
            assert!(is_told, "{code} has no Estonian");
            seen += 1;
        }
        assert!(seen > 30, "only {seen} were found: has the page another form?");
    }

    /// The text behind each `begin`, up to `end`.
    fn quoted<'a>(text: &'a str, begin: &'a str, end: char) -> impl Iterator<Item = &'a str> {
        text.split(begin)
            .skip(1)
            .filter_map(move |rest| rest.split(end).next())
    }

    #[test]
    fn the_log_tells_decisions_by_their_codes_and_says_what_is_english() {
        let entry = |part: &str, text: &str| LogEntry {
            number: 1,
            t: 0.0,
            level: LogLevel::Info,
            part: part.to_owned(),
            text: text.to_owned(),
        };
        let (english, estonian) = (Language::English.words(), Language::Estonian.words());
        let decided = entry("brain", "plan (unswept-floor) 150.00");
        assert_eq!(log_text(english, &decided), (decided.text.clone(), true));
        assert_eq!(
            log_text(estonian, &decided),
            (
                "Kavandas teekonna, 2 min: osa põrandast on veel koristamata.".to_owned(),
                true
            )
        );
        let stood = entry(
            "brain",
            "state-paused (wheel-drop): A wheel hangs in the air. Put the robot flat on the floor.",
        );
        assert_eq!(
            log_text(estonian, &stood).0,
            "Jäi pausile: ratas ripub õhus. Pane robot kindlalt põrandale."
        );
        for other in [
            entry("vthal", "plan (unswept-floor)"),
            entry("brain", "odd (odd"),
            entry("brain", "odd (odd)"),
        ] {
            assert_eq!(log_text(estonian, &other), (other.text.clone(), false));
        }
    }

    #[test]
    fn every_strategy_of_the_brain_has_a_name() {
        for language in Language::ALL {
            for name in brain::StrategyName::ALL.map(|strategy| strategy.name()) {
                assert_ne!(strategy_title(language.words(), name), name);
            }
        }
    }

    #[test]
    fn unknown_codes_are_left_to_the_caller() {
        for language in Language::ALL {
            assert_eq!(explain(language.words(), "flux-capacitor"), None);
            assert!(explain(language.words(), "wheel-drop").is_some());
        }
        assert_eq!(state_title(Language::English.words(), "flying"), "Unknown state");
        assert_eq!(strategy_title(Language::English.words(), "zigzag"), "zigzag");
    }

    #[test]
    fn decisions_are_shown_by_their_codes_and_unknown_ones_in_the_words_of_the_robot() {
        let decision = |what: &str, reason: &str| Decision {
            number: 1,
            t: 0.0,
            what: what.to_owned(),
            reason: reason.to_owned(),
            value: 150.0,
            text: "As the robot says.".to_owned(),
        };
        let estonian = Language::Estonian.words();
        assert_eq!(
            decision_text(estonian, &decision("plan", "unswept-floor")),
            "Kavandas teekonna, 2 min: osa põrandast on veel koristamata."
        );
        for (what, reason) in [("plan", "odd"), ("odd", "command")] {
            assert_eq!(
                decision_text(estonian, &decision(what, reason)),
                "As the robot says."
            );
        }
        assert_eq!(
            decision_text(Language::English.words(), &decision("plan", "unswept-floor")),
            "As the robot says."
        );
    }
}
