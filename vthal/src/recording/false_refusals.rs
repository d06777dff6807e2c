//! What earlier brains answered to edits of the map: they admitted each edit a second time, against the map that had it already. So the
//! removal of a no-go zone, for instance, was followed by the decision `refuse`, though it was made.

use brain::{Actions, Decision, DecisionCause, DecisionKind, EditError};

use super::format::{Answered, AnsweredNames, DecisionNames};

/// What a brain was asked in one step.
#[derive(Clone, Debug)]
pub(super) struct ReplayedStep {
    /// What it answered.
    pub(super) actions: Actions,
    /// Edits of the map that it was given.
    pub(super) edits: usize,
}

impl ReplayedStep {
    /// Whether an earlier brain, which said `recorded`, answered the same but for one `refuse` at most for each edit.
    pub(super) fn is_without_false_refusals(&self, recorded: &[u8]) -> bool {
        self.with_false_refusals(recorded)
            .and_then(|actions| written(&actions).ok())
            .is_some_and(|answer| answer == recorded)
    }

    /// The answer with the additional refusals that were recorded.
    fn with_false_refusals(&self, recorded: &[u8]) -> Option<Actions> {
        let AnsweredNames { decisions: names } = serde_json::from_slice(recorded).ok()?;
        let mut ours = self.actions.decisions.iter().peekable();
        let mut edits = self.edits;
        let mut decisions = Vec::new();
        for DecisionNames { what, reason } in names {
            if let Some(same) = ours.next_if(|ours| ours.kind.name() == what && ours.cause.name() == reason) {
                decisions.push(*same);
            } else {
                edits = edits
                    .checked_sub(1)
                    .filter(|_| what == DecisionKind::Refuse.name())?;
                decisions.push(Decision {
                    kind: DecisionKind::Refuse,
                    cause: DecisionCause::Edit(EditError::from_name(&reason)?),
                    value: 0.0,
                });
            }
        }
        ours.next().is_none().then(|| Actions {
            decisions,
            ..self.actions.clone()
        })
    }
}

/// An answer as recordings have it.
pub(super) fn written(actions: &Actions) -> serde_json::Result<Vec<u8>> {
    serde_json::to_vec(&Answered::from(actions))
}

#[cfg(test)]
mod tests {
    use brain::{Actions, Decision, DecisionCause, DecisionKind, EditError, JobRefusal, Motion, Reason};

    use super::ReplayedStep;

    fn actions(decisions: &[(DecisionKind, DecisionCause)]) -> Actions {
        let decisions = decisions.iter().map(|&(kind, cause)| Decision {
            kind,
            cause,
            value: 0.0,
        });
        Actions {
            motion: Motion::Rest,
            cleaners: false,
            arm: None,
            tones: Vec::new(),
            decisions: decisions.collect(),
            edits: Vec::new(),
        }
    }

    fn are_equal_but_for_refusals(
        edits: usize,
        ours: &[(DecisionKind, DecisionCause)],
        recorded: &[(DecisionKind, DecisionCause)],
    ) -> bool {
        let recorded = super::written(&actions(recorded)).expect("plain");
        let actions = actions(ours);
        ReplayedStep { actions, edits }.is_without_false_refusals(&recorded)
    }

    #[test]
    fn nothing_but_a_refusal_of_an_edit_is_left_out() {
        let halt = (DecisionKind::StateIdle, DecisionCause::Reason(Reason::Command));
        let removed = (DecisionKind::Refuse, DecisionCause::Edit(EditError::NoSuchNoGo));
        let no_job = (DecisionKind::Refuse, DecisionCause::Refusal(JobRefusal::NoJob));
        assert!(are_equal_but_for_refusals(1, &[halt], &[removed, halt]));
        assert!(are_equal_but_for_refusals(2, &[], &[removed, removed]));
        assert!(!are_equal_but_for_refusals(0, &[halt], &[removed, halt]));
        assert!(!are_equal_but_for_refusals(1, &[halt], &[removed, removed, halt]));
        assert!(!are_equal_but_for_refusals(1, &[halt], &[removed]));
        assert!(!are_equal_but_for_refusals(1, &[], &[halt]));
        assert!(!are_equal_but_for_refusals(1, &[], &[no_job]));
    }
}
