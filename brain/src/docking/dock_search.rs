//! Looking for the dock where nobody knows where it is. Docks stand at walls, and who goes along the walls of a home comes
//! through all of its rooms: so it follows the walls until it comes back to where it was, and listens. Where that has brought
//! nothing it roams, and follows the next wall that it does not know.

use super::roam::Roam;
use crate::coverage::{LapStep, Perimeter};
use crate::model::action::Motion;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext, TaskStatus};

/// Way of roaming between two laps, metres: across a room and through a door.
const ROAM_M: f64 = 10.0;

/// The search. What it has seen it keeps over approaches that failed.
#[derive(Debug, Default)]
pub(super) struct DockSearch {
    lap: Perimeter,
    roam: Roam,
    /// Way that it still roams; `None` = along walls.
    roam_left_m: Option<f64>,
}

impl DockSearch {
    /// Whether it is just getting away from something.
    pub(super) fn is_evading(&self) -> bool {
        if self.roam_left_m.is_some() {
            self.roam.is_evading()
        } else {
            self.lap.is_evading()
        }
    }

    /// The robot was moved by somebody else.
    pub(super) fn interrupted(&mut self) {
        self.lap.interrupted();
        self.roam.interrupted();
    }

    /// Notes where the robot is, whoever drives it.
    pub(super) fn note(&mut self, situation: &Situation<'_>) {
        self.roam.note(situation);
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let Some(left_m) = self.roam_left_m else {
            return self.follow_walls(situation, context);
        };
        if left_m <= 0.0 && !situation.is_free() && !self.roam.is_evading() {
            context.decide("follow-wall", Reason::DockUnknown, 0.0);
            self.roam_left_m = None;
            self.lap.begin_again();
            return self.follow_walls(situation, context);
        }
        self.roam_left_m = Some(left_m - situation.advance.distance_m.max(0.0));
        self.roam.step(situation, context)
    }

    fn follow_walls(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        match self.lap.step(situation, context) {
            LapStep::Going(motion) => TaskStatus::Go(motion),
            LapStep::Trouble(reason) => TaskStatus::Trouble(reason),
            LapStep::Over(reason) => {
                context.decide("leave-wall", reason, self.lap.driven_m());
                self.roam.interrupted();
                self.roam_left_m = Some(ROAM_M);
                TaskStatus::Go(Motion::Halt)
            }
        }
    }
}
