//! The interface between the state machine and everything that drives: strategies, spot cleaning, docking.

use core::fmt::Debug;

use super::Situation;
use crate::mapping::Map;
use crate::model::action::Motion;
use crate::model::decision::{Decision, DecisionCause, DecisionKind};
use crate::model::edit_error::EditError;
use crate::model::geometry::Point2;
use crate::model::job_refusal::JobRefusal;
use crate::model::random::Random;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;

/// What a task may use besides its inputs.
#[derive(Debug)]
pub(crate) struct TaskContext {
    pub(crate) random: Random,
    pub(crate) journal: Vec<Decision>,
}

impl TaskContext {
    pub(crate) fn decide(&mut self, kind: DecisionKind, reason: Reason, value: f64) {
        self.journal.push(Decision {
            kind,
            cause: DecisionCause::Reason(reason),
            value,
        });
    }

    /// Notes that a job command was refused.
    pub(crate) fn refuse_job(&mut self, refusal: JobRefusal) {
        self.journal.push(Decision {
            kind: DecisionKind::Refuse,
            cause: DecisionCause::Refusal(refusal),
            value: 0.0,
        });
    }

    /// Notes that a map edit was refused.
    pub(crate) fn refuse_edit(&mut self, error: EditError) {
        self.journal.push(Decision {
            kind: DecisionKind::EditRefused,
            cause: DecisionCause::Edit(error),
            value: 0.0,
        });
    }
}

/// What a task reports after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TaskStatus {
    /// It drives with this motion.
    Go(Motion),
    /// It cannot go on: recovery takes over.
    Trouble(Reason),
    /// It is done.
    Finished(Reason),
}

/// Something that drives the robot under the state machine. Coverage strategies are tasks; a new one is a new
/// implementation and a new [`crate::StrategyName`].
pub(crate) trait Task: Debug + Send {
    /// What to do now. A task never drives towards a pressed bumper or a cliff.
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus;

    /// Somebody else moved the robot (a person, recovery) or it stood still: unfinished manoeuvres are void.
    fn interrupted(&mut self);

    /// Corners of the planned path from here on, for display; none where the task decides as it goes.
    fn planned_path(&self) -> Vec<Point2> {
        Vec::new()
    }

    /// Whether floor that was within reach earlier in this job is shut off now: somebody stands in a door, or has shut it.
    fn is_floor_shut_off(&self) -> bool {
        false
    }

    /// The robot sets out from its dock once more for what it could not reach: what stood in the way may be gone.
    fn looks_again(&mut self) {}

    /// How much of its target floor is swept; `None` where the task does not know the floor.
    fn swept_share(&self, _map: &Map) -> Option<SweptShare> {
        None
    }
}
