//! Sessions: the state of each end beyond single packets.
//!
//! Both ends are state machines without I/O and without a clock: bytes and the present time go in, events and bytes
//! come out. [`RobotSession`] runs in the firmware, [`HostSession`] in the daemon and in tools. Both are driven the
//! same way:
//!
//! ```text
//! every received byte    -> receive(byte, now)          -> Option<event>
//! receiver hardware      -> framing_error(), overrun()
//! from time to time      -> poll(now)                   -> Option<event>   (at next_poll() at the latest)
//! whenever there is room -> next_packet(&mut buffer)    -> whether there is something to send
//! ```

#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod host;
mod robot;

pub use host::{HostEvent, HostSession, SendError};
pub use robot::{
    FRESHNESS_MS, HAND_LEASE_MS_MAX, HAND_SPEED_MAX, HAND_TURN_MAX, Mode, RobotEvent, RobotIdentity,
    RobotSession, SESSION_SILENCE_MS, SessionEnd,
};

/// After this long without sending, a separator goes before the next packet.
const FLUSH_AFTER_MS: u32 = 100;
/// Bad packets in a row that make either side leave the binary forms.
const BAD_IN_ROW_MAX: u8 = 3;
/// Most commands that wait for their answer at a time.
const COMMANDS_UNDER_WAY: usize = 8;
/// Ten edges at the bit rate, for a robot that measures the baud rate. A packet of only this byte is empty.
const BAUD_RATE_PATTERN: u8 = b'U';
/// Events that wait for confirmation. A further event drops the oldest; the host sees the gap in the numbers.
const EVENTS_WAITING: usize = 16;
