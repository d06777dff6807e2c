//! What the brain decided, as sentences, the newest kept for clients that come later.

use brain::action::Decision;
use rvac_api::{Explanation, explain};

use crate::newest::Newest;
use crate::to_api;

/// Decisions kept: some minutes of cleaning.
const KEPT: usize = 100;
/// Numbers in sentences stay below this, whatever a decision carries.
const SHOWN_MAX: f64 = 1e6;

/// The newest decisions.
#[derive(Debug, Default)]
pub(crate) struct Diary {
    newest: Newest<rvac_api::Decision, KEPT>,
}

impl Diary {
    /// Numbers a decision, puts it into words and keeps it.
    pub(crate) fn write(&mut self, now_us: u64, decision: &Decision) -> rvac_api::Decision {
        self.newest.keep(|number| rvac_api::Decision {
            number,
            t: to_api::seconds(now_us),
            what: decision.what.to_owned(),
            reason: decision.reason.to_owned(),
            value: if decision.value.is_finite() {
                decision.value
            } else {
                0.0
            },
            text: sentence(decision),
        })
    }

    /// The decisions that are kept, oldest first.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &rvac_api::Decision> {
        self.newest.entries()
    }
}

/// What was decided and why. A name without words of its own is shown as it is.
pub(crate) fn sentence(decision: &Decision) -> String {
    format!(
        "{}: {}.",
        deed(decision.what, decision.value),
        because(decision.reason)
    )
}

fn deed(what: &str, value: f64) -> String {
    let value = if value.is_finite() {
        value.clamp(-SHOWN_MAX, SHOWN_MAX)
    } else {
        0.0
    };
    match what {
        "back-off" => "Backed off and turned away".to_owned(),
        "plan" => format!("Route planned, {:.0} min", (value / 60.0).max(1.0)),
        "clean-by-statistics" => {
            "Cleaning started without a map; statistics estimate how much is clean".to_owned()
        }
        "leave-way" => "Left the planned route".to_owned(),
        "wait" => "Waited".to_owned(),
        "turn-to-part" => "Turned to the next part of the job".to_owned(),
        "keep-no-map" => "Saves no map of this run".to_owned(),
        "edit-refused" => "Refused a change of the map".to_owned(),
        "lap" => "Began a lap along the walls".to_owned(),
        "end-lap" => "Ended its lap along the walls".to_owned(),
        "contour-closed" => "Came back along the walls to where it began".to_owned(),
        "turn" => "Turned away".to_owned(),
        "arc" => "Drove an arc round the corner".to_owned(),
        "follow-wall" => "Began to follow a wall".to_owned(),
        "leave-wall" => "Left the wall".to_owned(),
        "withdraw" => "Undid the last part of the map".to_owned(),
        "spiral" => "Began a spiral".to_owned(),
        "covered" => format!(
            "Cleaned {:.0} % of the reachable floor",
            100.0 * value.clamp(0.0, 1.0)
        ),
        "bounce" => "Bounced to get out of this place".to_owned(),
        "squeeze" => "Tried to pass a narrow gap".to_owned(),
        "approach" => "Approached the dock".to_owned(),
        "wait-for-current" => "Waited for current from the dock".to_owned(),
        "dock-travel" => "Set out for the dock".to_owned(),
        "forget-obstructions" => "Forgot the obstacles of this job".to_owned(),
        "dock-way" => format!("Route to the dock planned, {value:.0} m"),
        "dock-search" => "Began to search for the dock".to_owned(),
        "dock-search-turn" => "Turned to where it had not searched yet".to_owned(),
        "dock-scan" => "Looked round for the beams of the dock".to_owned(),
        "dock-line" => "Turned towards the middle of the dock's beams".to_owned(),
        "dock-wiggle" => "Shifted on the dock to find the contacts".to_owned(),
        "dock-retry" => "Backed away from the dock to try again".to_owned(),
        "dock-found" => "Stored the position of the dock".to_owned(),
        "rest" => "Stood still for a moment".to_owned(),
        "refuse" => "Refused".to_owned(),
        "depart" => "Left the dock backwards".to_owned(),
        "escape-back-out" => "Backed out and turned".to_owned(),
        "escape-wiggle" => "Shook its wheels to come free".to_owned(),
        "escape-reverse" => "Backed as far as it knew the ground, and turned round".to_owned(),
        "escape-edge-left" => "Looked for a way out, with the edge on its left".to_owned(),
        "escape-edge-right" => "Looked for a way out, with the edge on its right".to_owned(),
        "escape-wait" => "Waited for somebody to leave or to open a door".to_owned(),
        "free" => format!("Came free after {value:.0} tries"),
        "state-disconnected" => "Lost the connection".to_owned(),
        "state-idle" => "Stood still, without a job".to_owned(),
        "state-starting" => "Announced that it will move".to_owned(),
        "state-cleaning" => "Cleaning started".to_owned(),
        "state-spot" => "Spot cleaning started".to_owned(),
        "state-docking" => "Returning to the dock".to_owned(),
        "state-docked" => "Rested on its dock".to_owned(),
        "state-manual" => "Manual control started".to_owned(),
        "state-paused" => "Paused".to_owned(),
        "state-stuck" => "Gave up and waits for help".to_owned(),
        "state-error" => "Stopped with a fault".to_owned(),
        other => plain(other),
    }
}

/// A reason in words, for the end of a sentence.
pub(crate) fn because(reason: &str) -> String {
    explain(reason).map_or_else(|| plain(reason), Explanation::clause)
}

/// A name as words.
fn plain(name: &str) -> String {
    name.replace('-', " ")
}

#[cfg(test)]
mod tests {
    use brain::action::{DECISIONS, Decision};

    use super::{Diary, KEPT, deed, plain};

    fn decision(what: &'static str, reason: &'static str, value: f64) -> Decision {
        Decision { what, reason, value }
    }

    #[test]
    fn a_turn_is_told_with_its_cause() {
        let mut diary = Diary::default();
        let entry = diary.write(2_500_000, &decision("back-off", "bump-left", 0.8));
        assert_eq!(
            entry.text,
            "Backed off and turned away: it touched something on its left."
        );
        assert_eq!(
            (entry.number, entry.t, entry.reason.as_str()),
            (1, 2.5, "bump-left")
        );
    }

    #[test]
    fn every_decision_of_the_brain_has_words() {
        let lacking: Vec<_> = DECISIONS
            .iter()
            .filter(|what| deed(what, 1.0) == plain(what))
            .collect();
        assert!(lacking.is_empty(), "{lacking:?}");
    }

    #[test]
    fn unknown_names_and_strange_numbers_are_told_as_they_are() {
        let mut diary = Diary::default();
        let entry = diary.write(0, &decision("new-trick", "odd-cause", f64::NAN));
        assert_eq!((entry.text.as_str(), entry.value), ("new trick: odd cause.", 0.0));
        let entry = diary.write(0, &decision("plan", "unswept-floor", f64::INFINITY));
        assert!(entry.text.starts_with("Route planned, 1 min"), "{}", entry.text);
    }

    #[test]
    fn the_newest_are_kept_and_numbers_go_on() {
        let mut diary = Diary::default();
        for _ in 0..KEPT + 3 {
            diary.write(0, &decision("back-off", "bump-left", 1.0));
        }
        let numbers: Vec<u64> = diary.entries().map(|entry| entry.number).collect();
        assert_eq!(
            (numbers.len(), numbers[0], numbers[KEPT - 1]),
            (KEPT, 4, KEPT as u64 + 3)
        );
    }
}
