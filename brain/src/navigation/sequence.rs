//! A few legs one after the other, for escapes and for leaving the dock.

use super::leg::RESERVE_M;
use super::{BackOff, EdgeTrace, Leg, Situation, Turn};
use crate::model::action::Motion;

/// Speed of a swing.
const SWING_M_PER_S: f64 = -0.1;
/// Turn rate of a swing.
const SWING_RAD_PER_S: f64 = 1.2;

/// One leg of a sequence.
#[derive(Clone, Debug)]
pub(crate) enum Part {
    /// Straight back.
    Back(BackOff),
    /// Turn on the spot.
    Turn(Turn),
    /// Back in an arc for a time: shakes wheels free.
    Swing {
        /// +1 turns left, -1 right.
        sign: f64,
        /// Seconds left.
        left_s: f64,
    },
    /// Along an edge.
    Edge(EdgeTrace),
    /// Stand still for a time, unless something touches the robot.
    Wait {
        /// Seconds left.
        left_s: f64,
    },
}

/// Legs that end one after the other. What it takes is bounded by the sum of the legs' times.
#[derive(Clone, Debug)]
pub(crate) struct Sequence {
    parts: Vec<Part>,
    /// Index of the leg that runs.
    current: usize,
}

impl Sequence {
    pub(crate) fn new(parts: Vec<Part>) -> Self {
        Self { parts, current: 0 }
    }

    /// The motion to make now; `None` when all legs are done. Touching something ends a turn early and straightens a swing.
    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> Option<Motion> {
        while let Some(part) = self.parts.get_mut(self.current) {
            let leg = match part {
                Part::Back(back) => back.step(situation),
                Part::Turn(_) if situation.touching || situation.at_cliff => Leg::Arrived,
                Part::Turn(turn) => turn.step(situation),
                Part::Swing { sign, left_s } => swing(*sign, left_s, situation),
                Part::Edge(edge) => edge.step(situation).map_or(Leg::Arrived, Leg::Going),
                Part::Wait { left_s } => wait(left_s, situation),
            };
            if let Leg::Going(motion) = leg {
                return Some(motion);
            }
            self.current += 1;
        }
        None
    }
}

fn wait(left_s: &mut f64, situation: &Situation<'_>) -> Leg {
    *left_s -= situation.advance.time_s;
    if *left_s <= 0.0 || !situation.is_free() {
        Leg::Arrived
    } else {
        Leg::Going(Motion::Halt)
    }
}

fn swing(sign: f64, left_s: &mut f64, situation: &Situation<'_>) -> Leg {
    *left_s -= situation.advance.time_s;
    if *left_s <= 0.0 {
        return Leg::Arrived;
    }
    if situation.is_free() {
        let spares = situation.way_back_m < RESERVE_M;
        return Leg::Going(Motion::Drive {
            speed_m_per_s: if spares { 0.0 } else { SWING_M_PER_S },
            turn_rad_per_s: sign * SWING_RAD_PER_S,
        });
    }
    if situation.way_back_m <= 0.0 {
        return Leg::Arrived;
    }
    Leg::Going(Motion::Drive {
        speed_m_per_s: SWING_M_PER_S,
        turn_rad_per_s: 0.0,
    })
}
