//! What the brain decided, as sentences, the newest kept for clients that come later.

use brain::{Decision, DecisionKind};
use rvac_api::{Explanation, explain};

use crate::newest::Newest;
use crate::to_api;

/// Decisions kept: some minutes of cleaning.
const KEPT: usize = 100;
/// Limit of numbers in sentences, because a decision may carry any value.
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
            what: decision.kind.name().to_owned(),
            reason: decision.cause.name().to_owned(),
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

/// What was decided and why.
pub(crate) fn sentence(decision: &Decision) -> String {
    format!(
        "{}: {}.",
        deed(decision.kind, shown(decision.value)),
        because(decision.cause.name())
    )
}

/// A value that fits into a sentence.
const fn shown(value: f64) -> f64 {
    if value.is_finite() {
        value.clamp(-SHOWN_MAX, SHOWN_MAX)
    } else {
        0.0
    }
}

/// A share in percent.
const fn percent(share: f64) -> f64 {
    100.0 * share.clamp(0.0, 1.0)
}

const BY_STATISTICS: &str = "Cleaning started without a map; statistics estimate how much is clean";
const BY_MAP: &str = "Cleaned what its map shows; how much of the home that is cannot be said";

/// What was done, with a value that can be shown.
fn deed(kind: DecisionKind, value: f64) -> String {
    match kind {
        DecisionKind::BackOff => "Backed off and turned away".to_owned(),
        DecisionKind::Plan => format!("Route planned, {:.0} min", (value / 60.0).max(1.0)),
        DecisionKind::CleanByStatistics => BY_STATISTICS.to_owned(),
        DecisionKind::LeaveWay => "Left the planned route".to_owned(),
        DecisionKind::Wait => "Waited".to_owned(),
        DecisionKind::TurnToPart => "Turned to the next part of the job".to_owned(),
        DecisionKind::KeepNoMap => "Saves no map of this run".to_owned(),
        DecisionKind::BeginMapAnew => "Began its map anew".to_owned(),
        DecisionKind::EditRefused => "Refused a change of the map".to_owned(),
        DecisionKind::Lap => "Began a lap along the walls".to_owned(),
        DecisionKind::EndLap => "Ended its lap along the walls".to_owned(),
        DecisionKind::ContourClosed => "Came back along the walls to where it began".to_owned(),
        DecisionKind::Turn => "Turned away".to_owned(),
        DecisionKind::Arc => "Drove an arc round the corner".to_owned(),
        DecisionKind::FollowWall => "Began to follow a wall".to_owned(),
        DecisionKind::LeaveOutGyro => "Left its gyro out of the estimate of its position".to_owned(),
        DecisionKind::TakeUpGyro => "Uses its gyro again".to_owned(),
        DecisionKind::FindHeading => "Drives about to find its heading".to_owned(),
        DecisionKind::HeadingFound => format!("Found its heading after {value:.0} m"),
        DecisionKind::SearchPlace => "Looks for its position by its radio beacons".to_owned(),
        DecisionKind::PlaceFound => format!("Found its position by its radio beacons after {value:.0} m"),
        DecisionKind::ForgetBeacons => format!("Forgot where radio beacon {value:.0} was"),
        DecisionKind::TakeFix => "Drives to walls, to know its position better".to_owned(),
        DecisionKind::FixTaken => "Went on, with its position known better".to_owned(),
        DecisionKind::LeaveWall => "Left the wall".to_owned(),
        DecisionKind::Withdraw => "Undid the last part of the map".to_owned(),
        DecisionKind::Spiral => "Began a spiral".to_owned(),
        DecisionKind::Covered => format!("Cleaned {:.0} % of the reachable floor", percent(value)),
        DecisionKind::CoveredByMap => BY_MAP.to_owned(),
        DecisionKind::DoubtMap => "Doubts its map".to_owned(),
        DecisionKind::Bounce => "Bounced to get out of this place".to_owned(),
        DecisionKind::Squeeze => "Tried to pass a narrow gap".to_owned(),
        DecisionKind::Approach => "Approached the dock".to_owned(),
        DecisionKind::WaitForCurrent => "Waited for current from the dock".to_owned(),
        DecisionKind::DockTravel => "Set out for the dock".to_owned(),
        DecisionKind::ForgetObstructions => "Forgot the obstacles of this job".to_owned(),
        DecisionKind::PlaceWay | DecisionKind::DockWay => format!("Route planned, {value:.0} m"),
        DecisionKind::DockSearch => "Began to search for the dock".to_owned(),
        DecisionKind::DockSearchTurn => "Turned to where it had not searched yet".to_owned(),
        DecisionKind::DockScan => "Looked round for the beams of the dock".to_owned(),
        DecisionKind::DockLine => "Turned towards the middle of the dock's beams".to_owned(),
        DecisionKind::DockWiggle => "Shifted on the dock to find the contacts".to_owned(),
        DecisionKind::DockRetry => "Backed away from the dock to try again".to_owned(),
        DecisionKind::DockFound => "Stored the position of the dock".to_owned(),
        DecisionKind::Rest => "Stood still for a moment".to_owned(),
        DecisionKind::Refuse => "Refused".to_owned(),
        DecisionKind::Depart => "Left the dock backwards".to_owned(),
        DecisionKind::EscapeBackOut => "Backed out and turned".to_owned(),
        DecisionKind::EscapeWiggle => "Shook its wheels to come free".to_owned(),
        DecisionKind::EscapeReverse => "Backed as far as it knew the ground, and turned round".to_owned(),
        DecisionKind::EscapeEdgeLeft => "Looked for a way out, with the edge on its left".to_owned(),
        DecisionKind::EscapeEdgeRight => "Looked for a way out, with the edge on its right".to_owned(),
        DecisionKind::EscapeWait => "Waited for somebody to leave or to open a door".to_owned(),
        DecisionKind::Free => came_free(value),
        DecisionKind::StateDisconnected => "Lost the connection".to_owned(),
        DecisionKind::StateIdle => "Stood still, without a job".to_owned(),
        DecisionKind::StateStarting => "Announced that it will move".to_owned(),
        DecisionKind::StateCleaning => "Cleaning started".to_owned(),
        DecisionKind::StateSpot => "Spot cleaning started".to_owned(),
        DecisionKind::StateGoing => "Set out for the place".to_owned(),
        DecisionKind::StateDocking => "Returning to the dock".to_owned(),
        DecisionKind::StateDocked => "Rested on its dock".to_owned(),
        DecisionKind::StateManual => "Manual control started".to_owned(),
        DecisionKind::StatePaused => "Paused".to_owned(),
        DecisionKind::StateStuck => "Gave up and waits for help".to_owned(),
        DecisionKind::StateError => "Stopped with a fault".to_owned(),
    }
}

fn came_free(tries: f64) -> String {
    if tries < 1.5 {
        "Came free at the first try".to_owned()
    } else {
        format!("Came free after {tries:.0} tries")
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
    use brain::{Decision, DecisionCause, DecisionKind, Reason};

    use super::{Diary, KEPT};

    fn decision(kind: DecisionKind, reason: Reason, value: f64) -> Decision {
        Decision {
            kind,
            cause: DecisionCause::Reason(reason),
            value,
        }
    }

    #[test]
    fn a_turn_is_reported_with_its_cause() {
        let mut diary = Diary::default();
        let entry = diary.write(2_500_000, &decision(DecisionKind::BackOff, Reason::BumpLeft, 0.8));
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
    fn strange_numbers_do_not_reach_people() {
        let mut diary = Diary::default();
        let planned = |value| decision(DecisionKind::Plan, Reason::UnsweptFloor, value);
        for value in [f64::NAN, f64::INFINITY] {
            let entry = diary.write(0, &planned(value));
            assert_eq!(entry.value, 0.0);
            assert!(entry.text.starts_with("Route planned, 1 min"), "{}", entry.text);
        }
    }

    #[test]
    fn the_newest_are_kept_and_numbers_go_on() {
        let mut diary = Diary::default();
        for _ in 0..KEPT + 3 {
            diary.write(0, &decision(DecisionKind::BackOff, Reason::BumpLeft, 1.0));
        }
        let numbers: Vec<u64> = diary.entries().map(|entry| entry.number).collect();
        assert_eq!(
            (numbers.len(), numbers[0], numbers[KEPT - 1]),
            (KEPT, 4, KEPT as u64 + 3)
        );
    }
}
