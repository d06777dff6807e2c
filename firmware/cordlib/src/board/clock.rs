//! Time of the board.

use rvac_units::Tick;

/// The millisecond clock that everything in the firmware is scheduled by.
pub trait Clock {
    /// Milliseconds since reset, modulo 2^32. Never goes backwards except for that wrap.
    fn tick(&mut self) -> Tick;

    /// Microseconds that have passed within the present tick, 0..=999. A board whose timer is no finer returns 0.
    fn microseconds(&mut self) -> u16 {
        0
    }
}
