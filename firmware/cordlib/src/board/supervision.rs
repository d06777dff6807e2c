//! Reset record, watchdog and hardware faults.

use rvac_protocol::message::{Inhibit, ResetCause};

/// What the chip knows about its start.
pub trait ResetRecord {
    /// Why it started.
    fn cause(&mut self) -> ResetCause;

    /// Starts since the firmware was written, as far as the board can count.
    fn boot_count(&mut self) -> u32;

    /// Consecutive resets, other than power-on, since the last call of [`Self::forget_recent`]. Stored where a reset does
    /// not clear it, and counted by the board's start-up code.
    fn recent(&mut self) -> u8;

    /// Sets [`Self::recent`] to 0: the firmware has run long enough.
    fn forget_recent(&mut self);
}

/// The hardware watchdog, which resets the chip 128 to 256 ms after it was fed last (S5).
pub trait Watchdog {
    /// Feeds it. Called from the main loop only, and only when every supervisor has checked in.
    fn feed(&mut self);
}

/// A fault that the board's own checks found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HardwareFault {
    /// The oscillator failed, or two clocks disagree (S20).
    Clock,
    /// Flash, memory or stack failed a check (S21).
    Memory,
    /// A trap that returned, or any other impossible state.
    Internal,
}

impl HardwareFault {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Clock, Self::Memory, Self::Internal];

    /// The name under which it is latched.
    #[must_use]
    pub const fn inhibit(self) -> Inhibit {
        match self {
            Self::Clock => Inhibit::Clock,
            Self::Memory => Inhibit::Memory,
            Self::Internal => Inhibit::InternalFault,
        }
    }
}

/// The board's own checks of clock, memory and registers (S20, S21).
pub trait HardwareChecks {
    /// Whether the cause of this fault is present now. Asked in every pass. A fault that stands is latched, switches
    /// everything off, and cannot be cleared. A board that finds a fault which leaves no trace reports it once, by
    /// [`Cord::hardware_fault`](crate::Cord::hardware_fault).
    fn stands(&mut self, fault: HardwareFault) -> bool;
}
