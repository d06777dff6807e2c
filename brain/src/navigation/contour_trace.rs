//! Follows the contour of an enclosing obstacle by touch alone: an arc against it, back a little, turn a little, and on.
//! The robot reaches every part of the contour, so it finds an exit that is hardly wider than the body.

use super::{Evasion, Situation};
use crate::model::action::Motion;
use crate::model::geometry::TurnSide;
use crate::model::random::Random;

/// Speed along the contour, for soft contacts.
const SPEED_M_PER_S: f64 = 0.2;
/// Radius of the arcs towards the contour.
const ARC_M: f64 = 0.3;
/// After this turn without a contact the contour is lost.
const LOST_RAD: f64 = 5.5;
/// Distance to back off after a touch.
const BACK_M: f64 = 0.025;
/// Distance to back off at a cliff.
const CLIFF_BACK_M: f64 = 0.08;
/// Turns away from a contact on the side of the contour, radians: large, for long steps, or fine, into gaps that are hardly
/// wider than the body.
const COARSE_RAD: (f64, f64) = (0.3, 0.9);
const FINE_RAD: (f64, f64) = (0.2, 0.5);
/// The same for a contact ahead, and at a cliff.
const AHEAD_RAD: (f64, f64) = (0.6, 1.2);
const CLIFF_RAD: (f64, f64) = (0.8, 1.3);

/// The drive along a contour. It ends by time.
#[derive(Clone, Debug)]
pub(crate) struct ContourTrace {
    side: TurnSide,
    side_turn_rad: (f64, f64),
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
            side_turn_rad: if is_fine { FINE_RAD } else { COARSE_RAD },
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
        let (low_rad, high_rad) = match (situation.at_cliff, on_edge) {
            (true, _) => CLIFF_RAD,
            (false, true) => self.side_turn_rad,
            (false, false) => AHEAD_RAD,
        };
        let turn_rad = -self.side.sign() * self.random.between(low_rad, high_rad);
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(CLIFF_BACK_M, turn_rad)
        } else {
            Evasion::from_contact(BACK_M, turn_rad)
        });
    }

    fn drive(&mut self, situation: &Situation<'_>) -> Motion {
        let speed_m_per_s = SPEED_M_PER_S.min(situation.config.speeds.cruise_m_per_s);
        // Straight on until the contour is found.
        let Some(turned_rad) = &mut self.turned_rad else {
            return Motion::Drive {
                speed_m_per_s,
                turn_rad_per_s: 0.0,
            };
        };
        *turned_rad += self.side.sign() * situation.advance.turn_rad;
        if *turned_rad > LOST_RAD {
            self.turned_rad = None;
        }
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: self.side.sign() * speed_m_per_s / ARC_M,
        }
    }
}
