//! A robot that does not know where it is follows walls until it does.
//!
//! Lanes on a pose that is not believed lead nowhere, and what they sweep is written down in the wrong place. Walls tell the filter
//! most, and who goes along them comes through all rooms.

use crate::coverage::{LapStep, Perimeter};
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext, TaskStatus};

/// Way along walls after which it goes on with what it believes, metres: once around a large home, so the map may be another's.
const SEEK_MAX_M: f64 = 120.0;

/// The search for its own place.
#[derive(Debug, Default)]
pub(super) struct RelocalizationLap {
    lap: Option<Perimeter>,
    has_given_up: bool,
}

/// What a search means for whoever drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RelocalizationStep {
    /// The place is known, or was sought in vain: lanes go on.
    Idle,
    /// The search has just ended: what was planned before is void.
    Over,
    /// It is being sought.
    Driving(TaskStatus),
}

impl RelocalizationLap {
    /// The robot was moved by somebody else.
    pub(super) fn interrupted(&mut self) {
        if let Some(lap) = &mut self.lap {
            lap.interrupted();
        }
    }

    pub(super) fn step(
        &mut self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> RelocalizationStep {
        if !situation.estimate.lost {
            self.has_given_up = false;
            return match self.lap.take() {
                Some(lap) if lap.is_evading() || !situation.is_free() => {
                    self.lap = Some(lap);
                    self.follow(situation, context)
                }
                Some(_) => RelocalizationStep::Over,
                None => RelocalizationStep::Idle,
            };
        }
        if self.has_given_up {
            return RelocalizationStep::Idle;
        }
        if self.lap.is_none() {
            context.decide("follow-wall", Reason::PlaceUnknown, 0.0);
        }
        self.follow(situation, context)
    }

    fn follow(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> RelocalizationStep {
        let lap = self.lap.get_or_insert_default();
        if lap.driven_m() > SEEK_MAX_M && !lap.is_evading() && situation.is_free() {
            self.lap = None;
            self.has_given_up = true;
            context.decide("end-lap", Reason::LongLap, SEEK_MAX_M);
            return RelocalizationStep::Over;
        }
        RelocalizationStep::Driving(match lap.step(situation, context) {
            LapStep::Going(motion) => TaskStatus::Go(motion),
            LapStep::Trouble(reason) => TaskStatus::Trouble(reason),
            LapStep::Over(reason) => {
                context.decide("leave-wall", reason, lap.driven_m());
                TaskStatus::Go(lap.leave())
            }
        })
    }
}
