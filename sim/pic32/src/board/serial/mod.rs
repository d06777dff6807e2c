//! The serial line between host and robot, as levels at cycles.
//!
//! [`Sender`] is the host's UART: it turns bytes into edges on the robot's pin. [`BitReceiver`] is a UART that samples in the
//! middle of each bit, as the host's does with the robot's edges. Both run at the host's own rate, which is a little
//! beside the nominal one when the host's crystal is.

mod host;
mod receiver;
mod sender;

pub use host::HostPort;
pub use receiver::BitReceiver;
pub use sender::Sender;

use super::CYCLES_PER_S;

/// Bits of a byte on the line: start, eight, stop.
const FRAME_BITS: u32 = 10;

/// How fast the host's UART runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostRate {
    /// Nominal bits per second, 300 to 1,000,000.
    pub baud: u32,
    /// How much faster the host's crystal makes it, in parts per thousand; -20 to 20 is what UARTs must bear.
    pub error_permille: f64,
}

impl HostRate {
    /// This rate, exactly.
    #[must_use]
    pub const fn exact(baud: u32) -> Self {
        Self {
            baud,
            error_permille: 0.0,
        }
    }

    /// Cycles of a bit.
    #[must_use]
    pub fn bit_cycles(self) -> f64 {
        let baud = f64::from(self.baud.max(1)) * (1.0 + self.error_permille / 1000.0);
        CYCLES_PER_S as f64 / baud
    }
}
