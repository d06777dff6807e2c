//! Coming free on one side of the front, where backing straight does not help or is not allowed any more.
//!
//! From a contact on one side the robot turns on the spot, so that the pressed side swings back: the firmware allows that (S6), and it needs
//! no floor behind. From an edge on one side it backs round the wheel of that side, so that the front swings away from the edge. Backing
//! straight along an edge does not leave it; here no wheel goes forward (S8), the wheel beside the edge stands, and the middle backs by less
//! than 0.12 m a radian.

use super::{ManoeuvreStep, Situation};
use crate::model::action::Motion;
use crate::model::geometry::TurnSide;
use crate::navigation::parameters::{CHASSIS, TURN_FREE};

/// The side to turn to, away from what holds the robot; `None` = it is free, or both sides are held, or both by a contact and by an edge.
pub(crate) fn free_side(situation: &Situation<'_>) -> Option<TurnSide> {
    let observation = situation.observation;
    let (left, right) = match (situation.touching, situation.at_cliff) {
        (true, false) => (observation.contacts.left, observation.contacts.right),
        (false, true) => (observation.cliffs.left, observation.cliffs.right),
        _ => return None,
    };
    match (left, right) {
        (true, false) => Some(TurnSide::Right),
        (false, true) => Some(TurnSide::Left),
        _ => None,
    }
}

/// Whether the robot may still turn away: from an edge it backs meanwhile.
fn has_room(situation: &Situation<'_>) -> bool {
    !situation.at_cliff || situation.reverse_budget_m > 0.0
}

/// The turn to this side that the firmware allows while something holds the robot.
fn away_motion(side: TurnSide, situation: &Situation<'_>) -> Motion {
    if situation.at_cliff {
        let speed_m_per_s = -0.5 * CHASSIS.back_at_cliff_m_per_s;
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: side.sign() * round_wheel_rad_per_s(speed_m_per_s, situation),
        }
    } else {
        Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: side.sign() * CHASSIS.turn_min_rad_per_s,
        }
    }
}

/// The fastest turn of a robot that backs at this speed with no wheel going forward, rad/s.
pub(crate) fn round_wheel_rad_per_s(speed_m_per_s: f64, situation: &Situation<'_>) -> f64 {
    TURN_FREE.wheel_share * 2.0 * (-speed_m_per_s).max(0.0) / situation.config.body.track_m
}

/// A turn away from one held side, until that is free.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurnFree {
    side: TurnSide,
    left_rad: f64,
    left_s: f64,
}

impl TurnFree {
    /// Away from what holds the robot on one side; `None` where that leads nowhere.
    pub(crate) fn of(situation: &Situation<'_>) -> Option<Self> {
        let side = free_side(situation)?;
        has_room(situation).then_some(Self {
            side,
            left_rad: TURN_FREE.turn_max_rad,
            left_s: TURN_FREE.time_max_s,
        })
    }

    /// Goes on. It has arrived when nothing holds the robot.
    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> ManoeuvreStep {
        self.left_rad -= self.side.sign() * situation.advance.turn_rad;
        self.left_s -= situation.advance.time_s;
        if situation.is_free() {
            return ManoeuvreStep::Arrived;
        }
        let is_blocked = free_side(situation).is_some_and(|side| side != self.side);
        if self.left_rad <= 0.0 || self.left_s <= 0.0 || !has_room(situation) || is_blocked {
            return ManoeuvreStep::Aborted;
        }
        ManoeuvreStep::Going(away_motion(self.side, situation))
    }
}
