//! Backing off and turning on the spot.

use super::Situation;
use crate::model::action::Motion;

/// Reverse speed after a contact.
const BACK_M_PER_S: f64 = 0.15;
/// Reverse speed at a cliff; the firmware allows 0.1 m/s (S8).
pub(crate) const BACK_AT_CLIFF_M_PER_S: f64 = 0.08;
/// A robot that is free keeps this much of its way back: what it meets while it turns, it must come free from again.
pub(super) const RESERVE_M: f64 = 0.04;
/// Slowest turn that is still a turn for a motor with a dead band.
const TURN_MIN_RAD_PER_S: f64 = 0.4;
/// Turn rate asked for each radian that is left: the robot brakes over the last part.
const TURN_GAIN_PER_S: f64 = 4.0;
/// Closer than this a turn counts as made.
const TURN_DONE_RAD: f64 = 0.03;
/// Time a leg may take beyond what its length needs.
const GRACE_S: f64 = 1.0;
/// Backing that makes no way for this long is over: something stands behind.
const BLOCKED_S: f64 = 0.4;
/// Share of the commanded speed below which no way is made.
const BLOCKED_SHARE: f64 = 0.2;

/// State of a leg after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ManoeuvreStep {
    /// Not there yet.
    Going(Motion),
    /// There.
    Arrived,
    /// Time is over, or the known ground behind the robot.
    Aborted,
}

/// Straight back until the way is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BackOff {
    left_m: f64,
    speed_m_per_s: f64,
    left_s: f64,
    blocked_s: f64,
    /// Way back that is left alone while nothing is met.
    reserve_m: f64,
}

impl BackOff {
    /// After a contact.
    pub(crate) fn from_contact(length_m: f64) -> Self {
        Self::at_speed(length_m, BACK_M_PER_S)
    }

    /// At a cliff: a turn too near to the edge would see it again, so nothing is spared.
    pub(crate) fn from_cliff(length_m: f64) -> Self {
        Self {
            reserve_m: 0.0,
            ..Self::at_speed(length_m, BACK_AT_CLIFF_M_PER_S)
        }
    }

    /// Off the dock, as far as the known ground reaches.
    pub(crate) fn from_dock(length_m: f64) -> Self {
        Self {
            reserve_m: 0.0,
            ..Self::from_contact(length_m)
        }
    }

    fn at_speed(length_m: f64, speed_m_per_s: f64) -> Self {
        Self {
            left_m: length_m,
            speed_m_per_s,
            left_s: 2.0 * length_m / speed_m_per_s + GRACE_S,
            blocked_s: 0.0,
            reserve_m: RESERVE_M,
        }
    }

    /// Adds to the way.
    pub(crate) fn lengthen(&mut self, length_m: f64) {
        self.left_m += length_m;
        self.left_s += 2.0 * length_m / self.speed_m_per_s;
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> ManoeuvreStep {
        let advance = situation.advance;
        self.left_m += advance.distance_m.min(0.0);
        self.left_s -= advance.time_s;
        let speed_m_per_s = self.speed_m_per_s.min(slow_m_per_s(situation));
        let is_moving = -advance.distance_m > BLOCKED_SHARE * speed_m_per_s * advance.time_s;
        self.blocked_s = if is_moving {
            0.0
        } else {
            self.blocked_s + advance.time_s
        };
        let keeps_reserve = situation.is_free() && situation.reverse_budget_m < self.reserve_m;
        if self.left_m <= 0.0 || keeps_reserve {
            ManoeuvreStep::Arrived
        } else if self.left_s <= 0.0 || self.blocked_s > BLOCKED_S || situation.reverse_budget_m <= 0.0 {
            ManoeuvreStep::Aborted
        } else {
            ManoeuvreStep::Going(Motion::Drive {
                speed_m_per_s: -speed_m_per_s,
                turn_rad_per_s: 0.0,
            })
        }
    }
}

/// Fastest that pays: near the end of the known ground a robot creeps, so that little of it goes into stopping.
fn slow_m_per_s(situation: &Situation<'_>) -> f64 {
    if situation.reverse_budget_m < RESERVE_M {
        BACK_AT_CLIFF_M_PER_S
    } else {
        BACK_M_PER_S
    }
}

/// A turn on the spot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    left_rad: f64,
    left_s: f64,
}

impl Turn {
    /// By an angle, counter-clockwise positive; more than a full turn is possible.
    pub(crate) fn by(angle_rad: f64) -> Self {
        Self {
            left_rad: angle_rad,
            left_s: 2.0 * angle_rad.abs() / TURN_MIN_RAD_PER_S.max(1.0) + GRACE_S,
        }
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> ManoeuvreStep {
        let before_rad = self.left_rad;
        self.left_rad -= situation.advance.turn_rad;
        self.left_s -= situation.advance.time_s;
        let passed = before_rad * self.left_rad <= 0.0;
        if passed || self.left_rad.abs() < TURN_DONE_RAD {
            return ManoeuvreStep::Arrived;
        }
        if self.left_s <= 0.0 {
            return ManoeuvreStep::Aborted;
        }
        let fastest = situation.config.speeds.turn_max_rad_per_s.max(TURN_MIN_RAD_PER_S);
        let rate = (TURN_GAIN_PER_S * self.left_rad.abs()).clamp(TURN_MIN_RAD_PER_S, fastest);
        ManoeuvreStep::Going(Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: rate.copysign(self.left_rad),
        })
    }
}
