//! `bounce`: drive until the robot hits something or comes to forbidden floor, back off, turn away by a random angle, drive on.
//!
//! Terms. *Straight*: the straight drive between two encounters. *Pocket*: a place where one straight after another is
//! short. There the robot backs off further, turns more and always to the same side. That leads out of corners and from
//! between chair legs, where a fresh coin toss each time would keep it in.

mod parameters;
mod pocket;

use super::recent_coverage::{RecentContacts, TurnRange};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::TurnSide;
use crate::model::reason::Reason;
use crate::navigation::parameters::{CHASSIS, EVASION};
use crate::navigation::{
    Evasion, Situation, Task, TaskContext, TaskStatus, enters_forbidden, turn_off_forbidden_rad,
};
use parameters::BOUNCE;
use pocket::Pocket;

/// The strategy.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bounce {
    evasion: Option<Evasion>,
    straight_m: f64,
    pocket: Pocket,
    /// Steers free turns towards floor that was not swept recently; `None` = turns are random.
    recent_contacts: Option<RecentContacts>,
}

impl Task for Bounce {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let evades = self.evasion.is_some();
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return TaskStatus::Go(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return TaskStatus::Trouble(reason);
            }
            None => {}
        }
        if evades {
            self.straight_m = 0.0;
        }
        self.drive(situation, context)
    }

    fn interrupted(&mut self) {
        self.evasion = None;
        self.straight_m = 0.0;
    }
}

/// A contact, and the side to which the robot would turn in the open.
#[derive(Clone, Copy)]
struct Encounter {
    reason: Reason,
    side: TurnSide,
}

impl Bounce {
    /// Bounces towards floor that was not swept recently.
    pub(super) fn towards_new_floor() -> Self {
        Self {
            recent_contacts: Some(RecentContacts::default()),
            ..Self::default()
        }
    }

    /// Whether an evasion is in progress.
    pub(crate) fn is_evading(&self) -> bool {
        self.evasion.is_some()
    }

    /// Distance driven since the last encounter, metres.
    pub(crate) fn straight_m(&self) -> f64 {
        self.straight_m
    }

    fn drive(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.straight_m += situation.advance.distance_m.max(0.0);
        let Some((reason, evasion)) = self.encounter(situation, context) else {
            return TaskStatus::Go(ahead(situation));
        };
        if self.pocket.is_closed() {
            self.pocket = Pocket::default();
            return TaskStatus::Trouble(Reason::BoxedIn);
        }
        context.decide(DecisionKind::BackOff, reason, self.straight_m);
        self.evasion = Some(evasion);
        TaskStatus::Go(Motion::Halt)
    }

    /// Turn away from a contact, radians. Positive is to the left.
    fn turn_rad(&self, encounter: Encounter, situation: &Situation<'_>, context: &mut TaskContext) -> f64 {
        let Encounter { reason, side } = encounter;
        let range_rad = self.pocket.turn_range_rad(reason);
        match &self.recent_contacts {
            Some(recent_contacts) if self.pocket.is_open() => {
                let side = (reason != Reason::BumpFront).then_some(side);
                recent_contacts.turn_rad(TurnRange { range_rad, side }, situation, context)
            }
            _ => self.pocket.side().unwrap_or(side).sign() * context.random.within(range_rad),
        }
    }

    fn encounter(
        &mut self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> Option<(Reason, Evasion)> {
        if !situation.is_free()
            && let Some(recent_contacts) = &mut self.recent_contacts
        {
            recent_contacts.note(situation);
        }
        if situation.at_cliff {
            let reason = Reason::of_cliffs(situation.observation.cliffs).unwrap_or(Reason::CliffFront);
            let side = self.side(reason, context);
            self.pocket.enter(self.straight_m, side);
            let turn_rad = side.sign() * context.random.within(&BOUNCE.cliff_turn_rad);
            return Some((reason, Evasion::from_cliff(EVASION.cliff_back_m, turn_rad)));
        }
        if situation.touching {
            let reason = Reason::of_contacts(situation.observation.contacts).unwrap_or(Reason::BumpFront);
            let side = self.side(reason, context);
            self.pocket.enter(self.straight_m, side);
            let turn_rad = self.turn_rad(Encounter { reason, side }, situation, context);
            return Some((reason, Evasion::from_contact(self.pocket.back_m(), turn_rad)));
        }
        if enters_forbidden(situation) {
            let reason = Reason::NoGoAhead;
            let side = self.side(reason, context);
            self.pocket.enter(self.straight_m, side);
            let least_rad = turn_off_forbidden_rad(side, situation);
            let drawn_rad = context.random.within(self.pocket.turn_range_rad(reason));
            let turn_rad = least_rad.signum() * drawn_rad.max(least_rad.abs());
            return Some((reason, Evasion::from_contact(0.0, turn_rad)));
        }
        (self.straight_m > BOUNCE.straight_max_m).then(|| {
            let side = self.side(Reason::LongRun, context);
            let turn_rad = side.sign() * context.random.within(&BOUNCE.long_straight_turn_rad);
            (
                Reason::LongRun,
                Evasion::from_contact(self.pocket.back_m(), turn_rad),
            )
        })
    }

    /// The side to turn to, away from the obstacle.
    fn side(&self, reason: Reason, context: &mut TaskContext) -> TurnSide {
        match reason {
            Reason::BumpLeft | Reason::CliffLeft => TurnSide::Right,
            Reason::BumpRight | Reason::CliffRight => TurnSide::Left,
            _ if context.random.coin() => TurnSide::Left,
            _ => TurnSide::Right,
        }
    }
}

/// Straight ahead, slower when an obstacle is near.
fn ahead(situation: &Situation<'_>) -> Motion {
    let proximity = &situation.observation.proximity;
    // The middle third of the sensors faces ahead; a single sensor faces sideways.
    let third = (proximity.len() / 3).max(1);
    let front = proximity
        .get(third..proximity.len().saturating_sub(third))
        .unwrap_or_default();
    let cruise_m_per_s = situation.config.speeds.cruise_m_per_s;
    let near = front.iter().any(|level| *level > CHASSIS.near_level);
    let speed_m_per_s = if near {
        cruise_m_per_s.min(CHASSIS.near_m_per_s)
    } else {
        cruise_m_per_s
    };
    Motion::Drive {
        speed_m_per_s,
        turn_rad_per_s: 0.0,
    }
}
