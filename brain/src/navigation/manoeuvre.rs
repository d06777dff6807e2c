//! Single manoeuvres: backing off and turning on the spot.

use super::Situation;
use crate::model::action::Motion;
use crate::navigation::parameters::{CHASSIS, MANOEUVRE};

/// State of a manoeuvre after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ManoeuvreStep {
    /// It goes on.
    Going(Motion),
    /// It is finished.
    Arrived,
    /// The time or the reverse budget is used up.
    Aborted,
}

/// Straight back for a distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BackOff {
    left_m: f64,
    speed_m_per_s: f64,
    left_s: f64,
    blocked_s: f64,
    /// Part of the reverse budget that is left unused while the robot is free.
    reserve_m: f64,
}

impl BackOff {
    /// After a contact.
    pub(crate) fn from_contact(length_m: f64) -> Self {
        Self::at_speed(length_m, CHASSIS.back_m_per_s)
    }

    /// At a cliff. A turn too close to the edge would detect it again, so no reverse budget is kept.
    pub(crate) fn from_cliff(length_m: f64) -> Self {
        Self {
            reserve_m: 0.0,
            ..Self::at_speed(length_m, CHASSIS.back_at_cliff_m_per_s)
        }
    }

    /// Off the dock, as far as the reverse budget reaches.
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
            left_s: 2.0 * length_m / speed_m_per_s + MANOEUVRE.grace_s,
            blocked_s: 0.0,
            reserve_m: MANOEUVRE.reserve_m,
        }
    }

    /// Adds to the distance.
    pub(crate) fn lengthen(&mut self, length_m: f64) {
        self.left_m += length_m;
        self.left_s += 2.0 * length_m / self.speed_m_per_s;
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> ManoeuvreStep {
        let advance = situation.advance;
        self.left_m += advance.distance_m.min(0.0);
        self.left_s -= advance.time_s;
        let speed_m_per_s = self.speed_m_per_s.min(slow_m_per_s(situation));
        let is_moving = -advance.distance_m > MANOEUVRE.blocked_share * speed_m_per_s * advance.time_s;
        self.blocked_s = if is_moving {
            0.0
        } else {
            self.blocked_s + advance.time_s
        };
        let keeps_reserve = situation.is_free() && situation.reverse_budget_m < self.reserve_m;
        if self.left_m <= 0.0 || keeps_reserve {
            ManoeuvreStep::Arrived
        } else if self.left_s <= 0.0
            || self.blocked_s > MANOEUVRE.blocked_s
            || situation.reverse_budget_m <= 0.0
        {
            ManoeuvreStep::Aborted
        } else {
            ManoeuvreStep::Going(Motion::Drive {
                speed_m_per_s: -speed_m_per_s,
                turn_rad_per_s: 0.0,
            })
        }
    }
}

/// Highest useful speed: near the end of the reverse budget the robot creeps, so that stopping uses little of it.
fn slow_m_per_s(situation: &Situation<'_>) -> f64 {
    if situation.reverse_budget_m < MANOEUVRE.reserve_m {
        CHASSIS.back_at_cliff_m_per_s
    } else {
        CHASSIS.back_m_per_s
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
            left_s: 2.0 * angle_rad.abs() / CHASSIS.turn_min_rad_per_s.max(1.0) + MANOEUVRE.grace_s,
        }
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> ManoeuvreStep {
        let before_rad = self.left_rad;
        self.left_rad -= situation.advance.turn_rad;
        self.left_s -= situation.advance.time_s;
        let passed = before_rad * self.left_rad <= 0.0;
        if passed || self.left_rad.abs() < MANOEUVRE.turn_done_rad {
            return ManoeuvreStep::Arrived;
        }
        if self.left_s <= 0.0 {
            return ManoeuvreStep::Aborted;
        }
        let fastest = situation
            .config
            .speeds
            .turn_max_rad_per_s
            .max(CHASSIS.turn_min_rad_per_s);
        let rate = (CHASSIS.turn_gain_per_s * self.left_rad.abs()).clamp(CHASSIS.turn_min_rad_per_s, fastest);
        ManoeuvreStep::Going(Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: rate.copysign(self.left_rad),
        })
    }
}
