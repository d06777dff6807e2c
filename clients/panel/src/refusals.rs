//! Refusals by the page itself, and how long they are shown.

use leptos::prelude::*;
use panel_logic::Wait;
use rvac_api::{Failure, Status};

use crate::language::words;
use crate::press::NO_ANSWER;
use crate::store::Store;

/// The reason code of a button that waits. No robot gives it.
const NOT_NOW: &str = "not-now";
/// The reason code of an edit of the map that cannot be made.
pub(crate) const NOT_DRAWN: &str = "edit";

impl Store {
    /// Whether the robot itself refused, and not this page.
    pub(crate) fn robot_refused(self) -> bool {
        self.refusal.with(|refusal| {
            let is_robots = |told: &Failure| !matches!(told.reason.as_str(), NOT_NOW | NOT_DRAWN | NO_ANSWER);
            refusal.as_ref().is_some_and(is_robots)
        })
    }

    /// Tells why what a person pressed is not possible now: a touch shows no tooltip.
    pub(crate) fn tell_why_not(self, why: Wait) {
        self.refusal.set(Some(Failure {
            id: None,
            reason: NOT_NOW.to_owned(),
            text: why.text(words()).to_owned(),
        }));
    }

    /// What was not possible in another state may be now, and a press without an answer has come after all.
    pub(crate) fn forget_why_not(self, status: &Status) {
        let was_told = self.refusal.with_untracked(|refusal| {
            let passes = |told: &Failure| matches!(told.reason.as_str(), NOT_NOW | NO_ANSWER);
            refusal.as_ref().is_some_and(passes)
        });
        let is_other = self
            .status
            .with_untracked(|now| now.as_ref().is_none_or(|now| now.state != status.state));
        if was_told && is_other {
            self.refusal.set(None);
        }
    }
}
