//! Follows the contour of an enclosing obstacle by touch alone: an arc against it, back a little, turn a little, and on.
//! The robot reaches every part of the contour, so it finds an exit that is hardly wider than the body.

use crate::navigation::parameters::{CONTOUR_TRACE, EVASION};
use core::ops::Range;

use super::{Evasion, Situation};
use crate::model::action::Motion;
use crate::model::geometry::TurnSide;
use crate::model::random::Random;

/// The drive along a contour. It ends by time.
#[derive(Clone, Debug)]
pub(crate) struct ContourTrace {
    side: TurnSide,
    side_turn_rad: Range<f64>,
    left_s: f64,
    evasion: Option<Evasion>,
    /// Turned towards the contour since the last contact; `None` = the contour is not found yet.
    turned_rad: Option<f64>,
    random: Random,
}

impl ContourTrace {
    /// With the contour on this side, for this time.
    pub(crate) fn new(side: TurnSide, left_s: f64, random: &mut Random) -> Self {
        // A manoeuvre is stepped without a task context, so it has its own generator.
        let is_fine = random.coin();
        Self {
            side,
            side_turn_rad: if is_fine {
                CONTOUR_TRACE.fine_turn_rad
            } else {
                CONTOUR_TRACE.coarse_turn_rad
            },
            left_s,
            evasion: None,
            turned_rad: None,
            random: Random::from_state(random.state()),
        }
    }

    /// The motion to make now; `None` when the time is over or the robot is held.
    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> Option<Motion> {
        self.left_s -= situation.advance.time_s;
        if self.left_s <= 0.0 {
            return None;
        }
        if let Some(step) = Evasion::pursue(&mut self.evasion, situation) {
            return step.ok();
        }
        if !situation.is_free() {
            self.evade(situation);
            return Some(Motion::Halt);
        }
        Some(self.drive(situation))
    }

    fn evade(&mut self, situation: &Situation<'_>) {
        self.turned_rad = Some(0.0);
        let contacts = situation.observation.contacts;
        let on_edge = match self.side {
            TurnSide::Left => contacts.left && !contacts.right,
            TurnSide::Right => contacts.right && !contacts.left,
        };
        let range_rad = match (situation.at_cliff, on_edge) {
            (true, _) => &CONTOUR_TRACE.cliff_turn_rad,
            (false, true) => &self.side_turn_rad,
            (false, false) => &CONTOUR_TRACE.ahead_turn_rad,
        };
        let turn_rad = -self.side.sign() * self.random.within(range_rad);
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(EVASION.cliff_back_m, turn_rad)
        } else {
            Evasion::from_contact(CONTOUR_TRACE.back_m, turn_rad)
        });
    }

    fn drive(&mut self, situation: &Situation<'_>) -> Motion {
        let speed_m_per_s = CONTOUR_TRACE
            .speed_m_per_s
            .min(situation.config.speeds.cruise_m_per_s);
        // Straight on until the contour is found.
        let Some(turned_rad) = &mut self.turned_rad else {
            return Motion::Drive {
                speed_m_per_s,
                turn_rad_per_s: 0.0,
            };
        };
        *turned_rad += self.side.sign() * situation.advance.turn_rad;
        if *turned_rad > CONTOUR_TRACE.lost_rad {
            self.turned_rad = None;
        }
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: self.side.sign() * speed_m_per_s / CONTOUR_TRACE.arc_radius_m,
        }
    }
}
