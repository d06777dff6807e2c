//! Lights that show a person beside the robot what it does.

use brain::BehaviorState;

/// Which lights are on; at most one of them is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lights {
    /// It waits for a start.
    pub ready: bool,
    /// It cleans, drives home, or is driven by hand.
    pub working: bool,
    /// It needs somebody: it is stuck, has a fault, or does not answer.
    pub attention: bool,
}

impl Lights {
    /// What is lit in a state.
    #[must_use]
    pub fn of(state: BehaviorState) -> Self {
        let dark = Self::default();
        match state {
            BehaviorState::Idle | BehaviorState::Docked | BehaviorState::Paused => {
                Self { ready: true, ..dark }
            }
            BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Going
            | BehaviorState::Docking
            | BehaviorState::Manual => Self {
                working: true,
                ..dark
            },
            BehaviorState::Stuck | BehaviorState::Error | BehaviorState::Disconnected => Self {
                attention: true,
                ..dark
            },
        }
    }
}
