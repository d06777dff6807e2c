//! Evading a hazard: back off until it is released, then turn away. What holds one side only and is not left by backing straight is left by a
//! turn.

use super::{BackOff, ManoeuvreStep, Situation, Turn, TurnFree};
use crate::model::action::Motion;
use crate::model::reason::Reason;
use crate::navigation::parameters::EVASION;

/// What the robot evades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EvasionCause {
    Contact,
    Cliff,
}

/// Back off, then turn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evasion {
    phase: EvasionPhase,
    cause: EvasionCause,
    turn_rad: f64,
    /// Distance backed straight so far.
    backed_m: f64,
    /// Distance that may still be added to the back-off.
    extra_m: f64,
    contacts_left: u32,
}

#[derive(Clone, Copy, Debug)]
enum EvasionPhase {
    Back(BackOff),
    Free(TurnFree),
    Turn(Turn),
}

/// State of an evasion after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum EvasionStep {
    /// It goes on.
    Going(Motion),
    /// The robot is free and has turned away.
    Free,
    /// The contact or the cliff does not release.
    Held(Reason),
}

impl Evasion {
    /// Away from a contact: `back_m` back, then a turn.
    pub(crate) fn from_contact(back_m: f64, turn_rad: f64) -> Self {
        Self {
            phase: EvasionPhase::Back(BackOff::from_contact(back_m)),
            cause: EvasionCause::Contact,
            turn_rad,
            backed_m: 0.0,
            extra_m: EVASION.contact_extra_max_m,
            contacts_left: EVASION.turn_contacts_max,
        }
    }

    /// Away from a cliff: `back_m` back, then a turn.
    pub(crate) fn from_cliff(back_m: f64, turn_rad: f64) -> Self {
        Self {
            phase: EvasionPhase::Back(BackOff::from_cliff(back_m)),
            cause: EvasionCause::Cliff,
            extra_m: (EVASION.cliff_back_max_m - back_m).max(0.0),
            ..Self::from_contact(back_m, turn_rad)
        }
    }

    /// Continues the evasion in progress, and drops it when the robot is free. Gives the motion to make, or why the robot
    /// is held. `None` = no evasion is in progress any more.
    pub(crate) fn pursue(
        in_progress: &mut Option<Self>,
        situation: &Situation<'_>,
    ) -> Option<Result<Motion, Reason>> {
        match in_progress.as_mut()?.step(situation) {
            EvasionStep::Going(motion) => Some(Ok(motion)),
            EvasionStep::Held(reason) => Some(Err(reason)),
            EvasionStep::Free => {
                *in_progress = None;
                None
            }
        }
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> EvasionStep {
        match self.phase {
            EvasionPhase::Back(mut back) => {
                let step = back.step(situation);
                self.backed_m -= situation.advance.distance_m;
                self.phase = EvasionPhase::Back(back);
                self.after_back(step, situation)
            }
            EvasionPhase::Free(mut free) => {
                let step = free.step(situation);
                self.phase = EvasionPhase::Free(free);
                self.after_free(step, situation)
            }
            EvasionPhase::Turn(mut turn) => {
                let step = turn.step(situation);
                self.phase = EvasionPhase::Turn(turn);
                self.after_turn(step, situation)
            }
        }
    }

    fn after_back(&mut self, step: ManoeuvreStep, situation: &Situation<'_>) -> EvasionStep {
        if let ManoeuvreStep::Going(motion) = step {
            let drives_along_edge = situation.at_cliff && self.has_backed_straight(situation);
            return match drives_along_edge.then(|| TurnFree::of(situation)).flatten() {
                Some(free) => self.turn_free(free),
                None => EvasionStep::Going(motion),
            };
        }
        if situation.at_cliff && self.cause == EvasionCause::Contact {
            *self = Self::from_cliff(EVASION.extra_m, self.turn_rad);
        }
        let held = if self.cause == EvasionCause::Cliff {
            situation.at_cliff
        } else {
            situation.touching
        };
        if !held {
            self.phase = EvasionPhase::Turn(Turn::by(self.turn_rad));
            return EvasionStep::Going(Motion::Halt);
        }
        if step == ManoeuvreStep::Aborted || self.extra_m <= 0.0 {
            return match TurnFree::of(situation) {
                Some(free) => self.turn_free(free),
                None => EvasionStep::Held(self.held_reason()),
            };
        }
        self.extra_m -= EVASION.extra_m;
        let EvasionPhase::Back(back) = &mut self.phase else {
            return EvasionStep::Held(self.held_reason());
        };
        back.lengthen(EVASION.extra_m);
        match back.step(situation) {
            ManoeuvreStep::Going(motion) => EvasionStep::Going(motion),
            ManoeuvreStep::Arrived | ManoeuvreStep::Aborted => EvasionStep::Going(Motion::Halt),
        }
    }

    /// Whether backing straight has had its chance: farther, the distance is needed for the turn away from the edge.
    fn has_backed_straight(&self, situation: &Situation<'_>) -> bool {
        self.backed_m >= EVASION.straight_m || situation.reverse_budget_m < EVASION.straight_m
    }

    fn turn_free(&mut self, free: TurnFree) -> EvasionStep {
        self.phase = EvasionPhase::Free(free);
        EvasionStep::Going(Motion::Halt)
    }

    fn after_free(&mut self, step: ManoeuvreStep, situation: &Situation<'_>) -> EvasionStep {
        match step {
            ManoeuvreStep::Going(motion) => EvasionStep::Going(motion),
            _ if situation.is_free() => {
                self.phase = EvasionPhase::Turn(Turn::by(self.turn_rad));
                EvasionStep::Going(Motion::Halt)
            }
            _ => EvasionStep::Held(self.held_reason()),
        }
    }

    fn after_turn(&mut self, step: ManoeuvreStep, situation: &Situation<'_>) -> EvasionStep {
        if !situation.touching && !situation.at_cliff {
            return match step {
                ManoeuvreStep::Going(motion) => EvasionStep::Going(motion),
                // A turn that ran out of time is as good: any direction but the old one will do.
                ManoeuvreStep::Arrived | ManoeuvreStep::Aborted => EvasionStep::Free,
            };
        }
        if self.contacts_left == 0 {
            return EvasionStep::Held(self.held_reason());
        }
        let contacts_left = self.contacts_left - 1;
        *self = if situation.at_cliff {
            Self::from_cliff(EVASION.extra_m, self.turn_rad)
        } else {
            Self::from_contact(EVASION.extra_m, self.turn_rad)
        };
        self.contacts_left = contacts_left;
        EvasionStep::Going(Motion::Halt)
    }

    fn held_reason(&self) -> Reason {
        match self.cause {
            EvasionCause::Contact => Reason::ContactHeld,
            EvasionCause::Cliff => Reason::CliffHeld,
        }
    }
}
