//! Several manoeuvres one after the other, for recovery and for leaving the dock.

use super::{BackOff, ContourTrace, ManoeuvreStep, Situation, Turn};
use crate::model::action::Motion;
use crate::navigation::parameters::MANOEUVRE;

/// One manoeuvre of a sequence.
#[derive(Clone, Debug)]
pub(crate) enum Manoeuvre {
    /// Straight back.
    Back(BackOff),
    /// Turn on the spot.
    Turn(Turn),
    /// Back in an arc for a time, to shake the wheels free.
    Swing {
        /// +1 turns left, -1 right.
        sign: f64,
        /// Seconds left.
        left_s: f64,
    },
    /// Along a contour.
    Contour(ContourTrace),
    /// Stand still for a time, unless something touches the robot.
    Wait {
        /// Seconds left.
        left_s: f64,
    },
}

/// Manoeuvres that run one after the other. The sum of their times bounds the sequence.
#[derive(Clone, Debug)]
pub(crate) struct ManoeuvreSequence {
    manoeuvres: Vec<Manoeuvre>,
    /// Index of the current manoeuvre.
    current: usize,
}

impl ManoeuvreSequence {
    pub(crate) fn new(manoeuvres: Vec<Manoeuvre>) -> Self {
        Self {
            manoeuvres,
            current: 0,
        }
    }

    /// The motion to make now; `None` when all manoeuvres are done. A contact ends a turn early and straightens a swing.
    pub(crate) fn step(&mut self, situation: &Situation<'_>) -> Option<Motion> {
        while let Some(manoeuvre) = self.manoeuvres.get_mut(self.current) {
            let step = match manoeuvre {
                Manoeuvre::Back(back) => back.step(situation),
                Manoeuvre::Turn(_) if situation.touching || situation.at_cliff => ManoeuvreStep::Arrived,
                Manoeuvre::Turn(turn) => turn.step(situation),
                Manoeuvre::Swing { sign, left_s } => swing(*sign, left_s, situation),
                Manoeuvre::Contour(trace) => trace
                    .step(situation)
                    .map_or(ManoeuvreStep::Arrived, ManoeuvreStep::Going),
                Manoeuvre::Wait { left_s } => wait(left_s, situation),
            };
            if let ManoeuvreStep::Going(motion) = step {
                return Some(motion);
            }
            self.current += 1;
        }
        None
    }
}

fn wait(left_s: &mut f64, situation: &Situation<'_>) -> ManoeuvreStep {
    *left_s -= situation.advance.time_s;
    if *left_s <= 0.0 || !situation.is_free() {
        ManoeuvreStep::Arrived
    } else {
        ManoeuvreStep::Going(Motion::Halt)
    }
}

fn swing(sign: f64, left_s: &mut f64, situation: &Situation<'_>) -> ManoeuvreStep {
    *left_s -= situation.advance.time_s;
    if *left_s <= 0.0 {
        return ManoeuvreStep::Arrived;
    }
    if situation.is_free() {
        let keeps_reserve = situation.reverse_budget_m < MANOEUVRE.reserve_m;
        return ManoeuvreStep::Going(Motion::Drive {
            speed_m_per_s: if keeps_reserve {
                0.0
            } else {
                MANOEUVRE.swing_m_per_s
            },
            turn_rad_per_s: sign * MANOEUVRE.swing_rad_per_s,
        });
    }
    if situation.reverse_budget_m <= 0.0 {
        return ManoeuvreStep::Arrived;
    }
    ManoeuvreStep::Going(Motion::Drive {
        speed_m_per_s: MANOEUVRE.swing_m_per_s,
        turn_rad_per_s: 0.0,
    })
}
