//! The seam between the state machine and everything that knows how to drive: strategies, spot cleaning, docking.

use core::fmt::Debug;

use super::Situation;
use crate::mapping::Map;
use crate::model::action::{Decision, Motion};
use crate::model::geometry::Point2;
use crate::model::random::Random;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;

/// What a task may use besides its eyes.
#[derive(Debug)]
pub(crate) struct Mind {
    pub(crate) random: Random,
    pub(crate) journal: Vec<Decision>,
}

impl Mind {
    pub(crate) fn decide(&mut self, what: &'static str, reason: Reason, value: f64) {
        self.journal.push(Decision {
            what,
            reason: reason.name(),
            value,
        });
    }

    /// Decides against what somebody asked for, by the name of a refusal or an error.
    pub(crate) fn refuse(&mut self, what: &'static str, reason: &'static str) {
        self.journal.push(Decision {
            what,
            reason,
            value: 0.0,
        });
    }
}

/// What a task wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Plan {
    /// Move so.
    Go(Motion),
    /// It cannot go on by its own means: the recovery ladder's turn.
    Trouble(Reason),
    /// It is done.
    Finished(Reason),
}

/// Something that drives the robot while the state machine lets it. Coverage strategies are tasks; a new one is a new
/// implementation and a new [`crate::StrategyName`].
pub(crate) trait Task: Debug + Send {
    /// What to do now. A task never asks to drive towards a pressed bumper or a cliff.
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan;

    /// The robot was moved by somebody else (a person, the recovery ladder) or stood still: half-done manoeuvres are void.
    fn interrupted(&mut self);

    /// Corners of the way that it means to drive from here on, for people who look; none where it decides as it goes.
    fn way(&self) -> Vec<Point2> {
        Vec::new()
    }

    /// How much of the floor that it wants it has swept; `None` where it does not know what there is to sweep.
    fn swept_share(&self, _map: &Map) -> Option<SweptShare> {
        None
    }
}
