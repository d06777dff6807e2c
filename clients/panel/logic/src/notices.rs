//! What a person who does not look at the page is told: a job is over, the robot is stuck, the robot has a fault.

use rvac_api::{Run, Status};

use crate::codes::{Explanation, explain, state_title};
use crate::job_progress::run_summary;
use crate::words::Words;

/// What the system shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// A few words.
    pub title: String,
    /// What happened, and what to do.
    pub text: String,
}

/// Looks at what the robot says. What was so before the first word is old, and nobody is told.
#[derive(Clone, Debug, Default)]
pub struct NoticeWatch {
    state: Option<String>,
}

impl NoticeWatch {
    /// A state came.
    pub fn on_status(&mut self, words: &Words, status: &Status) -> Option<Notice> {
        let before = self.state.replace(status.state.clone());
        // A connection that comes back may bring what was told before.
        let is_new = before.is_some_and(|before| before != status.state && before != "disconnected");
        let needs_help = matches!(status.state.as_str(), "stuck" | "error");
        (is_new && needs_help).then(|| Notice {
            title: state_title(words, &status.state).to_owned(),
            text: explain(words, &status.reason).map_or_else(|| status.reason.clone(), Explanation::text),
        })
    }
}

/// A job is over; nothing of ways to the dock.
#[must_use]
pub fn run_notice(words: &Words, run: &Run) -> Option<Notice> {
    Some(Notice {
        title: words.notice.job_over.to_owned(),
        text: run_summary(words, run)?,
    })
}

#[cfg(test)]
mod tests {
    use super::NoticeWatch;
    use crate::words::Language;
    use rvac_api::Status;

    #[test]
    fn who_looks_away_is_told_once_and_of_nothing_old() {
        let words = Language::English.words();
        let mut watch = NoticeWatch::default();
        let mut told = |state: &str, reason: &str| {
            let status = Status {
                state: state.to_owned(),
                reason: reason.to_owned(),
                ..Status::default()
            };
            watch.on_status(words, &status).map(|notice| notice.text)
        };
        assert_eq!(
            told("stuck", "wheel-drop"),
            None,
            "it was so when the page was opened"
        );
        assert_eq!(told("cleaning", "command"), None);
        assert!(told("stuck", "wheel-drop").is_some_and(|text| text.contains("wheel")));
        assert_eq!(told("stuck", "wheel-drop"), None, "once");
        assert_eq!(told("disconnected", "no-server"), None);
        assert_eq!(
            told("stuck", "wheel-drop"),
            None,
            "the same trouble after a glitch"
        );
        assert_eq!(told("idle", "cleared"), None);
        assert_eq!(told("error", "of-tomorrow").as_deref(), Some("of-tomorrow"));
    }
}
