//! What came of a run, from the reasons that the brain named.

use rvac_api::{RunAsker, RunJob, RunResult};

use crate::diary::because;

/// What came of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Ending {
    pub(super) result: RunResult,
    pub(super) reason: String,
    pub(super) text: String,
}

/// What is known when a job is gone.
#[derive(Clone, Copy, Debug)]
pub(super) struct LastWords<'a> {
    /// What was asked for.
    pub(super) job: &'a RunJob,
    /// Why the job is gone.
    pub(super) reason: &'a str,
    /// Why a cleaning job had turned home, if it had.
    pub(super) turned_home: Option<&'a str>,
    /// Why the robot stopped and could not continue by itself, if it did.
    pub(super) trouble: Option<&'a str>,
    /// Who ordered the end, if somebody did.
    pub(super) by: Option<&'a RunAsker>,
}

impl Ending {
    /// The most that is known while a run is in progress.
    pub(super) fn cut_short() -> Self {
        Self {
            result: RunResult::CutShort,
            reason: "cut-short".to_owned(),
            text: "Cut short: vthal or its board stopped without notice; what is shown was known shortly before."
                .to_owned(),
        }
    }

    pub(super) fn daemon_ended() -> Self {
        Self {
            result: RunResult::DaemonEnded,
            reason: "ending".to_owned(),
            text: "Ended because vthal was shut down.".to_owned(),
        }
    }

    pub(super) fn other_robot() -> Self {
        Self {
            result: RunResult::OtherRobot,
            reason: "other-robot".to_owned(),
            text: "Ended because another robot was attached.".to_owned(),
        }
    }

    pub(super) fn stopped(by: Option<&RunAsker>) -> Self {
        Self {
            result: RunResult::Stopped,
            reason: "command".to_owned(),
            text: format!("Stopped by {}.", name_or_somebody(by)),
        }
    }

    /// The ending of a job that somebody stopped or replaced. One that was done already, and on its way home, is finished.
    pub(super) fn replaced(turned_home: Option<&str>, by: Option<&RunAsker>) -> Self {
        match turned_home {
            Some(home) if is_done(home) => Self::finished(home),
            _ => Self::stopped(by),
        }
    }

    /// The ending of a job that the brain has no more.
    pub(super) fn of(words: LastWords<'_>) -> Self {
        let LastWords {
            job,
            reason,
            turned_home,
            trouble,
            by,
        } = words;
        match (reason, turned_home) {
            ("command", home) => match (trouble, home) {
                (Some(trouble), _) => Self::gave_up(trouble),
                (None, home) => Self::replaced(home, by),
            },
            ("docked", None) => Self::finished("docked"),
            ("docked", Some("command")) => Self {
                text: format!("Sent to its dock by {}.", name_or_somebody(by)),
                ..Self::stopped(by)
            },
            ("docked", Some(home)) if is_done(home) => Self::finished(home),
            ("docked", Some(home)) => Self::gave_up(home),
            (reason, _) if is_done(reason) && *job != RunJob::Dock => Self::finished(reason),
            (reason, Some(home)) if is_done(home) => Self {
                result: RunResult::Finished,
                reason: reason.to_owned(),
                text: format!("Finished, but did not come home: {}.", because(reason)),
            },
            (reason, _) => Self::gave_up(reason),
        }
    }

    fn finished(reason: &str) -> Self {
        let text = match reason {
            "finished" | "docked" => "Finished.".to_owned(),
            _ => format!("Finished: {}.", because(reason)),
        };
        Self {
            result: RunResult::Finished,
            reason: reason.to_owned(),
            text,
        }
    }

    fn gave_up(reason: &str) -> Self {
        Self {
            result: RunResult::GaveUp,
            reason: reason.to_owned(),
            text: format!("Gave up: {}.", because(reason)),
        }
    }
}

/// Reasons for which a cleaning job is over because nothing is left to do.
fn is_done(reason: &str) -> bool {
    matches!(
        reason,
        "finished" | "rest-out-of-reach" | "not-worth-the-time" | "by-statistics" | "crumbs-left"
    )
}

/// Whoever commands, within a sentence.
pub(super) fn asker_name(asker: &RunAsker) -> String {
    match asker {
        RunAsker::Client(name) => name.clone(),
        RunAsker::Button => "the button on the robot".to_owned(),
        RunAsker::Schedule { name, .. } => format!("the schedule {name}"),
        RunAsker::Robot => "the robot".to_owned(),
    }
}

fn name_or_somebody(asker: Option<&RunAsker>) -> String {
    asker.map_or_else(|| "somebody".to_owned(), asker_name)
}
