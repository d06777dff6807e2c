//! Full turns on the spot beside a straight wall, which measure the scale of the gyro.
//!
//! A wall that is beside the robot before and after has not turned: what the gyro counted beyond whole turns is its error.
//! Line SLAM fits the wall before and the wall after like any other two observations of one wall. This module only makes
//! the turns happen where a wall was beside the robot long enough for its direction to be known.

use core::f64::consts::TAU;

use crate::coverage::parameters::WHOLE_TURNS;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{ManoeuvreStep, Situation, TaskContext, Turn};

/// The turns of one lap.
#[derive(Debug, Default)]
pub(super) struct WholeTurns {
    turn: Option<Turn>,
    /// Angle of the current turn, and of whole turns that are over, radians.
    spun_rad: f64,
    made_rad: f64,
    /// Distance along the wall, and how much the robot turned meanwhile.
    wall_m: f64,
    turned_rad: f64,
    /// Once in a lap: if the turns did not help, something else is wrong, and the lap itself still measures the scale.
    has_begun: bool,
}

impl WholeTurns {
    /// Discards unfinished turns.
    pub(super) fn interrupted(&mut self) {
        if self.turn.take().is_some() {
            self.made_rad += TAU * libm::round(self.spun_rad / TAU);
        }
        self.spun_rad = 0.0;
        self.wall_m = 0.0;
    }

    /// Whole turns made since the last call, radians.
    pub(super) fn take_made_rad(&mut self) -> f64 {
        core::mem::take(&mut self.made_rad)
    }

    /// What to do to calibrate the gyro, if anything. `is_beside_wall`: a wall has been beside the robot since the last
    /// step.
    pub(super) fn step(
        &mut self,
        situation: &Situation<'_>,
        is_beside_wall: bool,
        context: &mut TaskContext,
    ) -> Option<Motion> {
        if let Some(turn) = &mut self.turn {
            self.spun_rad += situation.advance.turn_rad;
            match turn.step(situation) {
                ManoeuvreStep::Going(motion) if situation.is_free() => return Some(motion),
                _ => self.interrupted(),
            }
        }
        self.count(situation, is_beside_wall);
        let turns = self.due(situation)?;
        self.has_begun = true;
        self.turn = Some(Turn::by(turns * TAU));
        context.decide(DecisionKind::Turn, Reason::GyroScale, turns);
        Some(Motion::Halt)
    }

    fn count(&mut self, situation: &Situation<'_>, is_beside_wall: bool) {
        let advance = situation.advance;
        let driven_m = advance.distance_m.max(0.0);
        self.turned_rad += advance.turn_rad;
        if is_beside_wall && self.turned_rad.abs() < WHOLE_TURNS.straight_rad {
            self.wall_m += driven_m;
        } else {
            self.wall_m = 0.0;
            self.turned_rad = 0.0;
        }
    }

    /// Number of turns that are due.
    fn due(&self, situation: &Situation<'_>) -> Option<f64> {
        let sigma = situation
            .gyro_scale_sigma
            .filter(|sigma| *sigma > WHOLE_TURNS.worth_sigma)?;
        let is_due = !self.has_begun && self.wall_m > WHOLE_TURNS.wall_m && situation.is_free();
        is_due.then(|| {
            libm::floor(WHOLE_TURNS.miscounted_max_rad / (TAU * sigma)).clamp(1.0, WHOLE_TURNS.turns_max)
        })
    }
}
