//! Codes come over the wire; people read sentences. A code without words in the language of the page is told in the robot's own
//! English sentence, or shown as it is.

mod diary;
mod english;
mod estonian;

use rvac_api::{Decision, Failure, FloorQuestion, Run, RunResult, RunStop};

use crate::words::{Language, Words};

/// What a code means for the person in front of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// What happened.
    pub what: &'static str,
    /// What to do about it; empty when there is nothing to do.
    pub remedy: &'static str,
}

impl Explanation {
    /// Both.
    #[must_use]
    pub fn text(self) -> String {
        format!("{} {}", self.what, self.remedy).trim_end().to_owned()
    }
}

const fn entry(code: &'static str, what: &'static str, remedy: &'static str) -> (&'static str, Explanation) {
    (code, Explanation { what, remedy })
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
        "docking" => titles.docking,
        "docked" => titles.docked,
        "manual" => titles.manual,
        "paused" => titles.paused,
        "stuck" => titles.stuck,
        "error" => titles.error,
        _ => titles.unknown,
    }
}

/// The explanation of a code; a code that nobody has explained yet gives none and is shown as it is.
#[must_use]
pub fn explain(words: &Words, code: &str) -> Option<Explanation> {
    let catalogue = match words.language {
        Language::English => english::CATALOGUE,
        Language::Estonian => estonian::CATALOGUE,
    };
    find(catalogue, code)
}

/// What is said when the robot refuses, in few words that fit everywhere.
#[must_use]
pub fn failure_text(words: &Words, failure: &Failure) -> String {
    explain(words, &failure.reason).map_or_else(
        || refusal_text(words, &failure.reason, &failure.text),
        Explanation::text,
    )
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
    let told = || {
        let deed = find(deeds(words)?, &decision.what)?;
        let cause = cause(words, &decision.reason)?;
        Some(format!("{}: {cause}.", with_value(deed, decision)))
    };
    told().unwrap_or_else(|| decision.text.clone())
}

fn deeds(words: &Words) -> Option<&'static [(&'static str, &'static str)]> {
    match words.language {
        Language::English => None,
        Language::Estonian => Some(diary::DEEDS),
    }
}

fn cause(words: &Words, code: &str) -> Option<&'static str> {
    match words.language {
        Language::English => None,
        Language::Estonian => find(diary::CAUSES, code),
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

/// What came of a run.
#[must_use]
pub fn run_text(words: &Words, run: &Run) -> String {
    if words.language == Language::English {
        return run.text.clone();
    }
    let told = &words.history;
    let with_cause = |text: crate::words::Told<1>| {
        cause(words, &run.reason).map_or_else(|| run.text.clone(), |cause| text.fill([&cause]))
    };
    match (run.result, run.reason.as_str()) {
        (RunResult::Finished, "finished" | "docked") => told.finished.to_owned(),
        (RunResult::Finished, _) => with_cause(told.finished_as),
        (RunResult::Stopped, _) => told.stopped.to_owned(),
        (RunResult::GaveUp, _) => with_cause(told.gave_up),
        (RunResult::DaemonEnded, _) => told.daemon_ended.to_owned(),
        (RunResult::CutShort, _) => told.cut_short.to_owned(),
        (RunResult::OtherRobot, _) => told.other_robot.to_owned(),
    }
}

/// Why the robot stood on the way.
#[must_use]
pub fn stop_cause_text(words: &Words, stop: &RunStop) -> String {
    cause(words, &stop.reason).map_or_else(
        || stop.text.clone(),
        |cause| format!("{}: {cause}.", state_title(words, &stop.state)),
    )
}

#[cfg(test)]
mod tests {
    use rvac_api::Decision;

    use super::{decision_text, english, estonian, explain, find, state_title};
    use crate::words::Language;

    #[test]
    fn every_code_is_explained_once_in_whole_sentences() {
        for catalogue in [english::CATALOGUE, estonian::CATALOGUE] {
            for (index, (code, explanation)) in catalogue.iter().enumerate() {
                assert!(
                    catalogue[index + 1..].iter().all(|(other, _)| other != code),
                    "{code} stands twice"
                );
                assert!(explanation.what.ends_with('.'), "{code}");
                assert!(
                    explanation.remedy.is_empty() || explanation.remedy.ends_with('.'),
                    "{code}"
                );
            }
        }
    }

    #[test]
    fn every_language_explains_the_same_codes() {
        for (code, explanation) in english::CATALOGUE {
            let other = find(estonian::CATALOGUE, code).unwrap_or_else(|| panic!("{code} has no Estonian"));
            assert_eq!(other.remedy.is_empty(), explanation.remedy.is_empty(), "{code}");
            assert_ne!(other.what, explanation.what, "{code}");
        }
        assert_eq!(english::CATALOGUE.len(), estonian::CATALOGUE.len());
    }

    #[test]
    fn unknown_codes_are_left_to_the_caller() {
        for language in Language::ALL {
            assert_eq!(explain(language.words(), "flux-capacitor"), None);
            assert!(explain(language.words(), "wheel-drop").is_some());
        }
        assert_eq!(state_title(Language::English.words(), "flying"), "Unknown state");
    }

    #[test]
    fn decisions_are_told_by_their_codes_and_unknown_ones_in_the_words_of_the_robot() {
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
