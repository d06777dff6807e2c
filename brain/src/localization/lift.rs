//! Detects from the wheels whether somebody lifts the robot.

use crate::model::advance::Advance;
use crate::model::observation::Observation;

/// A wheel that hangs for so long means that somebody holds the robot, seconds.
const LIFTED_S: f64 = 1.0;

/// State of the wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Lift {
    /// All wheels are on the floor.
    #[default]
    OnFloor,
    /// A wheel has been hanging for so long.
    Hanging { time_s: f64 },
    /// Somebody has just put the robot down.
    PutDown,
}

impl Lift {
    /// Takes whether a wheel hangs.
    pub(super) fn update(&mut self, observation: &Observation, advance: Advance) {
        let hanging_s = self.hanging_s();
        *self = if observation.wheel_drop {
            Self::Hanging {
                time_s: hanging_s + advance.time_s,
            }
        } else if hanging_s >= LIFTED_S {
            Self::PutDown
        } else {
            Self::OnFloor
        };
    }

    /// Time for which a wheel has been hanging, seconds.
    pub(super) fn hanging_s(self) -> f64 {
        match self {
            Self::Hanging { time_s } => time_s,
            Self::OnFloor | Self::PutDown => 0.0,
        }
    }

    /// Whether somebody has just put the robot down.
    pub(super) fn is_put_down(self) -> bool {
        self == Self::PutDown
    }

    /// Whether the robot was put down since the last call.
    pub(super) fn take_put_down(&mut self) -> bool {
        let is_put_down = self.is_put_down();
        if is_put_down {
            *self = Self::OnFloor;
        }
        is_put_down
    }
}
