//! The host's end.

use rvac_units::Tick;

use crate::buffer::{PacketBuffer, EncodeError};
use crate::frame::Framer;
use crate::message::{
    BinaryKinds, Command, CommandNames, Description, LinkCounters, ProtocolVersion, Refusal, Report,
    RobotHello, Sequence,
};
use crate::quality::LinkQuality;
use crate::seal::Direction;

/// What the host learns.
#[derive(Clone, Debug, PartialEq)]
pub enum HostEvent {
    /// A session is open; commands can be sent.
    Opened(RobotHello),
    /// The robot has told everything about itself. Comes some packets after `Opened`.
    Described(Description),
    /// `Info`, `State`, `Log`, or an `Edge` that was not delivered before. Edges come in order and once.
    Report(Report),
    /// The robot has answered a numbered command: carried out (`None`) or refused. Refused `drive` and `motor` are
    /// answered too.
    Answered {
        /// The number that [`HostSession::send`] gave; `None` if the robot could not read it.
        sequence: Option<Sequence>,
        /// Why it was refused.
        refusal: Option<Refusal>,
    },
    /// A command that must arrive was not answered in time. It may or may not have been carried out.
    Unanswered(Sequence),
    /// Edges were lost: the robot's queue overflowed. Levels are in the next `State`.
    EdgesLost {
        /// How many.
        count: u16,
    },
    /// The session is over: the robot was reset, or it went back to hand mode. The session opens a new one by itself.
    Closed(RobotHello),
    /// Nothing valid came for 2 s. The session opens a new one by itself, for ever.
    Silent,
    /// No common version. `hello`, `info`, `log` and `stop` still work.
    Incompatible {
        /// Oldest version of the robot.
        version_min: ProtocolVersion,
        /// Newest version of the robot.
        version_max: ProtocolVersion,
    },
}

/// Why a command was not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SendError {
    /// No session is open.
    NotOpen,
    /// Too many commands wait for their answer (at most 8).
    Busy,
    /// A number is outside of what the wire allows.
    Range,
    /// `Hello`, `Hand`, `Ping` and `Seen` are the session's own.
    Reserved,
}

impl From<EncodeError> for SendError {
    fn from(_: EncodeError) -> Self {
        Self::Range
    }
}

/// The host's end of the link. `now` is the host's own millisecond clock; its zero does not matter.
#[derive(Clone, Debug)]
pub struct HostSession {
    framer: Framer,
    binary: BinaryKinds,
    counters: LinkCounters,
}

impl HostSession {
    /// A session that is about to send `U`, a separator and its `hello`. `binary` are the kinds to agree upon.
    #[must_use]
    pub fn new(binary: BinaryKinds, now: Tick) -> Self {
        let _ = now;
        Self {
            framer: Framer::new(Direction::RobotToHost),
            binary,
            counters: LinkCounters::default(),
        }
    }

    /// Takes one received byte.
    #[must_use]
    pub fn receive(&mut self, byte: u8, now: Tick) -> Option<HostEvent> {
        let _ = (now, self.framer.push(byte), self.binary);
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

    /// Lets time pass; call until it gives `None`.
    #[must_use]
    pub fn poll(&mut self, now: Tick) -> Option<HostEvent> {
        let _ = now;
        None
    }

    /// When `poll` has something to do at the latest.
    #[must_use]
    pub fn next_poll(&self) -> Tick {
        Tick(0)
    }

    /// Writes the next packet that the session itself wants sent (handshake, repeats, confirmations, keep-alive) into
    /// `buffer`, replacing its content. `false` = nothing to send. Call it after `receive`, `poll` and `send`.
    #[must_use]
    pub fn next_packet(&mut self, buffer: &mut PacketBuffer) -> bool {
        buffer.clear();
        false
    }

    /// Writes `command` into `buffer`, replacing its content, with the session's own `sequence` and `seen_tick` whatever
    /// the caller put there. Commands that must arrive are repeated until they are answered. Gives the number, if the
    /// command carries one. `Stop` can be sent at any time, open session or not.
    ///
    /// # Errors
    /// See [`SendError`]; the buffer is empty then.
    pub fn send(
        &mut self,
        command: Command,
        now: Tick,
        buffer: &mut PacketBuffer,
    ) -> Result<Option<Sequence>, SendError> {
        let _ = (command, now);
        buffer.clear();
        Err(SendError::NotOpen)
    }

    /// Whether a session is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        false
    }

    /// What the robot understands, as far as its description has come; empty before.
    #[must_use]
    pub fn understood(&self) -> CommandNames {
        CommandNames::NONE
    }

    /// The robot's clock: newest tick heard and when that was on the host's clock.
    #[must_use]
    pub fn robot_tick(&self) -> Option<(Tick, Tick)> {
        None
    }

    /// Quality of the link over the last 5 s.
    #[must_use]
    pub fn quality(&self) -> LinkQuality {
        LinkQuality::default()
    }

    /// Totals of what this end received.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        self.counters
    }
}
