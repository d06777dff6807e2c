//! The robot's end.

use rvac_units::Tick;

use crate::buffer::{PacketBuffer, EncodeError};
use crate::frame::Framer;
use crate::message::{
    BinaryKinds, Command, Description, EdgeKind, LinkCounters, Name, Refusal, Report, ResetCause, Sequence,
};
use crate::seal::Direction;

/// Who the robot is; fixed from reset on.
#[derive(Clone, Debug)]
pub struct RobotIdentity {
    /// Device, for example `sr8730`.
    pub device: Name,
    /// Firmware version.
    pub firmware: Name,
    /// Starts since the firmware was written, as far as the board can count.
    pub boot_count: u32,
    /// Why it started.
    pub reset_cause: ResetCause,
    /// Anything that differs from start to start (boot count, noise of an analogue input, memory after power-on): session
    /// numbers grow from it and from the moment of the `hello`.
    pub session_seed: u32,
    /// Binary kinds the firmware can read and write.
    pub binary: BinaryKinds,
    /// What `describe` tells.
    pub description: Description,
}

/// Who may command, and how far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// A person may type without seals; motion is slow: 0.1 m/s, 0.5 rad/s, a quarter of the wheels' throttle, leases of at
    /// most 500 ms. The session has clamped what it can see; the speed of a `move` is the firmware's part.
    Hand,
    /// Only the host of this session, sealed.
    Sealed,
}

/// Why a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SessionEnd {
    /// `{"c":"hand"}` was commanded.
    Hand,
    /// No valid sealed packet for 2 s.
    Silence,
}

/// What the firmware has to act upon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RobotEvent {
    /// Carry this out. It is checked: well-formed, in range, sealed as the mode wants it, fresh, not seen before, and in
    /// hand mode clamped. Never `Hello`, `Hand`, `Describe`, `Ping` or `Seen`, which the session handles itself.
    ///
    /// A command that must arrive ([`Command::must_arrive`]) wants one call of [`RobotSession::answer`], a refused `drive`
    /// or `motor` too. `Info` and `State` want a report.
    Command(Command),
    /// A host has opened a session: leases of before are void.
    SessionOpened,
    /// Back to hand mode: leases of before are void.
    SessionClosed(SessionEnd),
}

/// The robot's end of the link.
#[derive(Clone, Debug)]
pub struct RobotSession {
    framer: Framer,
    identity: RobotIdentity,
    mode: Mode,
    counters: LinkCounters,
}

impl RobotSession {
    /// A session after reset, in hand mode. The first packets are a separator and an unasked `hello`.
    #[must_use]
    pub fn new(identity: RobotIdentity, now: Tick) -> Self {
        let _ = now;
        Self {
            framer: Framer::new(Direction::HostToRobot),
            identity,
            mode: Mode::Hand,
            counters: LinkCounters::default(),
        }
    }

    /// Takes one received byte.
    #[must_use]
    pub fn receive(&mut self, byte: u8, now: Tick) -> Option<RobotEvent> {
        let _ = (now, self.framer.push(byte), &self.identity);
        None
    }

    /// The receiver saw a wrong stop bit.
    pub fn framing_error(&mut self) {
        self.counters.framing = self.counters.framing.wrapping_add(1);
    }

    /// The receiver lost bytes.
    pub fn overrun(&mut self) {
        self.counters.overrun = self.counters.overrun.wrapping_add(1);
    }

    /// Lets time pass: silence ends a session, unconfirmed edges become due again. Cheap; call it in every pass of the main
    /// loop or at [`next_poll`](Self::next_poll).
    #[must_use]
    pub fn poll(&mut self, now: Tick) -> Option<RobotEvent> {
        let _ = now;
        None
    }

    /// When `poll` has something to do at the latest.
    #[must_use]
    pub fn next_poll(&self) -> Tick {
        Tick(0)
    }

    /// Writes the next packet that the session itself wants sent (handshake, acknowledgements, rows of the description,
    /// edges) into `buffer`, replacing its content. `false` = nothing to send.
    #[must_use]
    pub fn next_packet(&mut self, buffer: &mut PacketBuffer) -> bool {
        buffer.clear();
        false
    }

    /// Writes a report of the firmware (`State`, `Info`, `Log`) into `buffer`, replacing its content: sealed, in binary if
    /// that is agreed, with a separator before it if the line was silent.
    ///
    /// # Errors
    /// [`EncodeError`] if the report does not fit a packet; the buffer is empty then. No `State`, `Info` or `Log` is too long.
    pub fn encode(&mut self, report: &Report, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
        let _ = report;
        buffer.clear();
        Ok(())
    }

    /// Answers a numbered command: done (`None`) or refused.
    pub fn answer(&mut self, sequence: Sequence, refusal: Option<Refusal>) {
        let _ = (sequence, refusal);
    }

    /// Queues an edge. The session numbers it and repeats it until the host confirms it.
    pub fn queue_edge(&mut self, kind: EdgeKind, tick: Tick) {
        let _ = (kind, tick);
    }

    /// Hand or sealed mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Totals since reset.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        self.counters
    }
}
