//! Cleaning a disc of one metre: a spiral outwards from the robot's position.
//!
//! A radius of curvature that grows evenly with the angle turned draws the involute of a circle: its turns are evenly
//! spaced and its centre stays put, without knowing a pose.

use core::f64::consts::TAU;

use crate::coverage::parameters::SPOT;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::TurnSide;
use crate::model::order::SPOT_RADIUS_M;
use crate::model::reason::Reason;
use crate::navigation::parameters::EVASION;
use crate::navigation::{
    Evasion, EvasionStep, Situation, Task, TaskContext, TaskStatus, enters_forbidden, turn_off_forbidden_rad,
};

/// The task.
#[derive(Clone, Debug)]
pub(crate) struct Spot {
    side: TurnSide,
    /// Angle turned since the start, to the spiral's side.
    turned_rad: f64,
    encounters: u32,
    evasion: Option<Evasion>,
}

impl Default for Spot {
    fn default() -> Self {
        Self {
            side: TurnSide::Left,
            turned_rad: 0.0,
            encounters: 0,
            evasion: None,
        }
    }
}

impl Task for Spot {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if let Some(evasion) = &mut self.evasion {
            match evasion.step(situation) {
                EvasionStep::Going(motion) => return TaskStatus::Go(motion),
                EvasionStep::Free => self.evasion = None,
                EvasionStep::Held(reason) => {
                    self.evasion = None;
                    return TaskStatus::Trouble(reason);
                }
            }
        } else {
            self.turned_rad += (self.side.sign() * situation.advance.turn_rad).max(0.0);
        }
        self.spiral(situation, context)
    }

    fn interrupted(&mut self) {
        self.evasion = None;
    }
}

impl Spot {
    fn spiral(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if !situation.is_free() || enters_forbidden(situation) {
            return self.evade(situation, context);
        }
        let config = situation.config;
        let widening_m_per_rad = SPOT.spacing * config.body.swath_m / TAU;
        let outermost_m = SPOT_RADIUS_M - 0.5 * config.body.swath_m;
        let radius_m = (SPOT.radius_start_m + widening_m_per_rad * self.turned_rad).min(outermost_m);
        // One more turn at the outermost radius closes the disc.
        if self.turned_rad > (outermost_m - SPOT.radius_start_m) / widening_m_per_rad + TAU {
            return TaskStatus::Finished(Reason::Finished);
        }
        let speeds = config.speeds;
        let speed_m_per_s = speeds
            .cruise_m_per_s
            .min(SPOT.turn_share * speeds.turn_max_rad_per_s * radius_m);
        TaskStatus::Go(Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: self.side.sign() * speed_m_per_s / radius_m,
        })
    }

    /// Evades the obstacle, or turns before forbidden floor, and spirals on in the other direction, so that the rest of the disc lies ahead.
    fn evade(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.encounters += 1;
        if self.encounters > SPOT.encounters_max {
            return TaskStatus::Finished(Reason::Obstructed);
        }
        let observation = situation.observation;
        let contact = Reason::of_cliffs(observation.cliffs).or(Reason::of_contacts(observation.contacts));
        let reason = match contact {
            Some(contact) => contact,
            None if situation.is_free() => Reason::NoGoAhead,
            None => Reason::BumpFront,
        };
        let turn_to = match reason {
            Reason::BumpLeft | Reason::CliffLeft => TurnSide::Right,
            Reason::BumpRight | Reason::CliffRight => TurnSide::Left,
            _ => self.side.opposite(),
        };
        context.decide(DecisionKind::BackOff, reason, self.turned_rad);
        if reason == Reason::NoGoAhead {
            return self.turn_off(turn_off_forbidden_rad(turn_to, situation));
        }
        self.side = turn_to;
        let turn_rad = turn_to.sign() * context.random.within(&SPOT.away_rad);
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(EVASION.cliff_back_m, turn_rad)
        } else {
            Evasion::from_contact(SPOT.contact_back_m, turn_rad)
        });
        TaskStatus::Go(Motion::Halt)
    }

    /// Turns where it stands, and spirals on to the side to which it has turned.
    fn turn_off(&mut self, turn_rad: f64) -> TaskStatus {
        self.side = if turn_rad > 0.0 {
            TurnSide::Left
        } else {
            TurnSide::Right
        };
        self.evasion = Some(Evasion::from_contact(0.0, turn_rad));
        TaskStatus::Go(Motion::Halt)
    }
}
