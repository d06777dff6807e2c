//! Actions that the brain requests. The shells perform them; the brain has no side effects.

use super::decision::Decision;
use super::edit_error::EditError;

/// The answer to one observation.
#[derive(Clone, Debug, PartialEq)]
pub struct Actions {
    /// Motion of the wheels until the next observation.
    pub motion: Motion,
    /// Whether brushes and suction should run.
    pub cleaners: bool,
    /// Arms the firmware (clears `not-armed`, `stopped`, `button-stop`, `link-lost`); sent once when a job starts.
    pub arm: Option<Arm>,
    /// Tones to play, in order.
    pub tones: Vec<Tone>,
    /// Decisions taken in this step, each with its named cause.
    pub decisions: Vec<Decision>,
    /// What became of each edit of the map among the commands of this step, in their order.
    pub edits: Vec<Result<(), EditError>>,
}

/// Motion of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// No motion command is sent, leases run out.
    Rest,
    /// Stop now.
    Halt,
    /// Drive; the shell gives it a lease and repeats it.
    Drive {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate, counter-clockwise positive.
        turn_rad_per_s: f64,
    },
}

/// How to arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arm {
    /// The robot is about to leave the dock.
    pub undock: bool,
}

/// One tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Pitch; 0 is a pause.
    pub pitch_hz: u32,
    /// Duration.
    pub duration_ms: u16,
}
