//! Reset record, watchdog and hardware faults.

use rvac_protocol::message::ResetCause;

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
