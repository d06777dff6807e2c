//! What can be wrong with the wires or the chip, and what the host can do wrong.

use crate::pins::Level;

/// Faults to inject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PortFaults {
    /// Identity that the chip reports in place of its own.
    pub device_id: Option<u32>,
    /// The key does not open the port: no chip, no supply, or a wire that is broken.
    pub is_deaf: bool,
    /// The chip says that it is code-protected, whatever its configuration words say.
    pub is_protected: bool,
    /// Polls of the probe that see nothing pending although something is.
    pub late_polls: u32,
    /// The data line is shorted.
    pub stuck_data: Option<Level>,
    /// One bit in so many is read wrongly; 0 for none.
    pub flip_one_in: u32,
    /// Seed of everything that is drawn.
    pub seed: u64,
}

/// What the host did wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortViolation {
    /// The key came without a short pulse of the reset line before it.
    KeyWithoutPulse,
    /// Host and chip drove the data line at once.
    BothDrive,
    /// The core worked for the probe while the chip's flash was not enabled.
    FlashNotEnabled,
    /// A command that the chip does not have.
    UnknownCommand(u8),
    /// The probe completed an access that was not pending.
    NothingPending,
}
