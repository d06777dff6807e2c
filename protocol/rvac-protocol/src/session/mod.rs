//! The conversation: what each end keeps in mind beyond single packets.
//!
//! Both ends are state machines without I/O and without a clock: bytes and the present time go in, events and bytes come
//! out. [`RobotSession`] runs in the firmware, [`HostSession`] in the daemon and in tools. Either is driven alike:
//!
//! ```text
//! every received byte   -> receive(byte, now)          -> Option<event>
//! receiver hardware     -> framing_error(), overrun()
//! from time to time     -> poll(now)                   -> Option<event>   (at next_poll() at the latest)
//! whenever there is room-> next_packet(&mut buffer)    -> whether there is something to send
//! ```

mod host;
mod robot;

pub use host::{HostEvent, HostSession, SendError};
pub use robot::{Mode, RobotEvent, RobotIdentity, RobotSession, SessionEnd};
