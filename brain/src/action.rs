//! What the brain wants done. The shells perform it; the brain touches nothing.

/// The answer to one observation.
#[derive(Clone, Debug, PartialEq)]
pub struct Actions {
    /// What the wheels should do until the next observation.
    pub motion: Motion,
    /// Whether brushes and suction should run.
    pub cleaners: bool,
    /// Arms the firmware (clears `not-armed`, `stopped`, `button-stop`, `link-lost`); sent once when a job starts.
    pub arm: Option<Arm>,
    /// Tones to play, in order.
    pub tones: Vec<Tone>,
    /// Decisions taken in this step, each with its named reason.
    pub decisions: Vec<Decision>,
}

/// What the wheels should do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Nothing is asked: no motion command is sent, leases run out.
    Rest,
    /// Stand still now.
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
    /// Leaving the dock is meant.
    pub undock: bool,
}

/// One tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Pitch; 0 is a pause.
    pub pitch_hz: u32,
    /// Length.
    pub duration_ms: u16,
}

/// A change of mind with its reason, for the log, the recording and "why did you do that".
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// What was decided, for example `back-off`, `turn`, `state-cleaning`.
    pub what: &'static str,
    /// Named reason, for example `bump-left`, `cliff`, `command`, `wheel-drop`.
    pub reason: &'static str,
    /// A number that belongs to it, for example the angle of a turn in radians; 0 where there is none.
    pub value: f64,
}
