//! Along the edge of what holds the robot, by touch alone: against it in an arc, back a little, turn a little, on. A way out
//! that is hardly wider than the body is found so, since the robot comes to every place of the edge.

use super::{Evasion, Situation};
use crate::model::action::Motion;
use crate::model::geometry::TurnSide;
use crate::model::random::Random;

/// Speed along the edge: contacts are soft.
const SPEED_M_PER_S: f64 = 0.2;
/// Radius of the arcs toward the edge.
const ARC_M: f64 = 0.3;
/// An arc of so much without a contact has lost the edge.
const LOST_RAD: f64 = 5.5;
/// Way back after a touch.
const BACK_M: f64 = 0.025;
/// Way back at a cliff.
const CLIFF_BACK_M: f64 = 0.08;
/// Turns away from what was touched on the side of the edge, radians: quick, with long hops, or fine, into gaps that are hardly
/// wider than the body.
const QUICK_RAD: (f64, f64) = (0.3, 0.9);
const FINE_RAD: (f64, f64) = (0.2, 0.5);
/// The same for what was touched ahead, and at a cliff.
const AHEAD_RAD: (f64, f64) = (0.6, 1.2);
const CLIFF_RAD: (f64, f64) = (0.8, 1.3);

/// The way along an edge. It ends by its time.
#[derive(Clone, Debug)]
pub(crate) struct ContourTrace {
    side: TurnSide,
    glancing_rad: (f64, f64),
    left_s: f64,
    evasion: Option<Evasion>,
    /// Turned toward the edge since the last contact; `None` = the edge is still looked for.
    turned_rad: Option<f64>,
    random: Random,
}

impl ContourTrace {
    /// With the edge on this side, for so long.
    pub(crate) fn new(side: TurnSide, left_s: f64, random: &mut Random) -> Self {
        // A generator of its own: a movement has no mind.
        let is_fine = random.coin();
        Self {
            side,
            glancing_rad: if is_fine { FINE_RAD } else { QUICK_RAD },
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
            (false, true) => self.glancing_rad,
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
        // Where no edge is: straight on.
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
