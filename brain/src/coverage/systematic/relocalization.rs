//! A lost robot follows walls until it is localized again.
//!
//! Lanes on a wrong pose lead nowhere, and what they sweep is recorded in the wrong place. Walls give the particle filter
//! most information, and following them leads through all rooms.

use super::detour::DetourStep;
use super::parameters::SYSTEMATIC;
use crate::coverage::{LapStep, Perimeter};
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext, TaskStatus};

/// The drive along walls.
#[derive(Debug, Default)]
pub(super) struct RelocalizationLap {
    lap: Option<Perimeter>,
    has_given_up: bool,
}

impl RelocalizationLap {
    /// Somebody else moved the robot.
    pub(super) fn interrupted(&mut self) {
        if let Some(lap) = &mut self.lap {
            lap.interrupted();
        }
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> DetourStep {
        if !situation.estimate.lost {
            self.has_given_up = false;
            return match self.lap.take() {
                Some(lap) if lap.is_evading() || !situation.is_free() => {
                    self.lap = Some(lap);
                    self.follow(situation, context)
                }
                Some(_) => DetourStep::Over,
                None => DetourStep::Idle,
            };
        }
        if self.has_given_up {
            return DetourStep::Idle;
        }
        if self.lap.is_none() {
            context.decide(DecisionKind::FollowWall, Reason::PlaceUnknown, 0.0);
        }
        self.follow(situation, context)
    }

    fn follow(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> DetourStep {
        let lap = self.lap.get_or_insert_default();
        if lap.driven_m() > SYSTEMATIC.relocalization_max_m && !lap.is_evading() && situation.is_free() {
            self.lap = None;
            self.has_given_up = true;
            context.decide(
                DecisionKind::EndLap,
                Reason::LongLap,
                SYSTEMATIC.relocalization_max_m,
            );
            return DetourStep::Over;
        }
        DetourStep::Driving(match lap.step(situation, context) {
            LapStep::Going(motion) => TaskStatus::Go(motion),
            LapStep::Trouble(reason) => TaskStatus::Trouble(reason),
            LapStep::Over(reason) => {
                context.decide(DecisionKind::LeaveWall, reason, lap.driven_m());
                TaskStatus::Go(lap.leave())
            }
        })
    }
}
