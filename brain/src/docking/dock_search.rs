//! Searches the dock when its place is unknown. Docks stand at walls, and following the walls leads through all rooms. So
//! the robot follows the walls and listens until it is back where it started. If that fails it roams, and then follows the
//! next unknown wall.

use super::parameters::DOCKING;
use super::roam::Roam;
use crate::coverage::{LapStep, Perimeter};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext, TaskStatus, enters_forbidden};

/// The search. It keeps what it has seen across failed approaches.
#[derive(Debug, Default)]
pub(super) struct DockSearch {
    lap: Perimeter,
    roam: Roam,
    /// Distance left to roam; `None` = along walls.
    roam_left_m: Option<f64>,
}

impl DockSearch {
    /// Whether an evasion is in progress.
    pub(super) fn is_evading(&self) -> bool {
        if self.roam_left_m.is_some() {
            self.roam.is_evading()
        } else {
            self.lap.is_evading()
        }
    }

    /// Somebody else moved the robot.
    pub(super) fn interrupted(&mut self) {
        self.lap.interrupted();
        self.roam.interrupted();
    }

    /// Records where the robot is, whoever drives it.
    pub(super) fn note(&mut self, situation: &Situation<'_>) {
        self.roam.note(situation);
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let Some(left_m) = self.roam_left_m else {
            return self.follow_walls(situation, context);
        };
        if left_m <= 0.0 && !situation.is_free() && !self.roam.is_evading() {
            context.decide(DecisionKind::FollowWall, Reason::DockUnknown, 0.0);
            self.roam_left_m = None;
            self.lap.begin_again();
            return self.follow_walls(situation, context);
        }
        self.roam_left_m = Some(left_m - situation.advance.distance_m.max(0.0));
        self.roam.step(situation, context)
    }

    fn follow_walls(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if !self.lap.is_evading() && situation.is_free() && enters_forbidden(situation) {
            context.decide(DecisionKind::LeaveWall, Reason::NoGoAhead, self.lap.driven_m());
            self.interrupted();
            self.roam_left_m = Some(DOCKING.roam_m);
            return self.roam.step(situation, context);
        }
        match self.lap.step(situation, context) {
            LapStep::Going(motion) => TaskStatus::Go(motion),
            LapStep::Trouble(reason) => TaskStatus::Trouble(reason),
            LapStep::Over(reason) => {
                context.decide(DecisionKind::LeaveWall, reason, self.lap.driven_m());
                self.roam.interrupted();
                self.roam_left_m = Some(DOCKING.roam_m);
                TaskStatus::Go(Motion::Halt)
            }
        }
    }
}
