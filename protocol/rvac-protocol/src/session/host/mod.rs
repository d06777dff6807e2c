//! The host's end.

mod delivery;
mod description;
mod event_order;
mod inbound;
mod outbound;
mod robot_clock;

use heapless::Deque;
use rvac_units::Tick;

use self::delivery::Delivery;
use self::description::Gathering;
use self::event_order::EventOrder;
use self::robot_clock::RobotClock;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::crc::Direction;
use crate::frame::{Framer, PACKET_BYTES_MAX, Poison};
use crate::message::{
    Battery, BinaryKinds, Command, CommandNames, Description, LinkCounters, ProtocolVersion, Refusal, Report,
    RobotHello, Sequence,
};
use crate::quality::{Arrivals, LinkQuality, QualityWindow};

/// An event for the host.
#[derive(Clone, Debug, PartialEq)]
pub enum HostEvent {
    /// A session is open; commands can be sent.
    Opened(RobotHello),
    /// The robot's description is complete. Comes some packets after `Opened`.
    Described(Description),
    /// `Info`, `Log`, a `State` that is newer than all before, or an `Event` that was not delivered before. Events come in
    /// order and once.
    Report(Report),
    /// The robot has answered a numbered command: executed (`None`) or refused. Refused `drive` and `motor` are
    /// answered too.
    Answered {
        /// The number that [`HostSession::send`] gave; `None` if the robot could not read it.
        sequence: Option<Sequence>,
        /// Why it was refused.
        refusal: Option<Refusal>,
    },
    /// A command that must arrive was not answered in time. It may or may not have been executed.
    Unanswered(Sequence),
    /// Events were lost: the robot's queue overflowed. Levels are in the next `State`.
    EventsLost {
        /// How many.
        count: u16,
    },
    /// The session is over: the robot was reset or returned to hand mode. A new one is opened automatically.
    Closed(RobotHello),
    /// Nothing valid came for 2 s. A new session is tried automatically, without end.
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
    /// A number is out of range, or the packet is longer than this robot accepts.
    Range,
    /// Only the session itself sends `Hello`, `Hand`, `Describe`, `Ping` and `Seen`.
    Reserved,
}

impl From<EncodeError> for SendError {
    fn from(_: EncodeError) -> Self {
        Self::Range
    }
}

/// Pause between greetings.
const GREETING_MS: u32 = 250;
/// Pause between greetings if there is no common version.
const GREETING_INCOMPATIBLE_MS: u32 = 5_000;
/// Pause between pings, which keep the session alive and measure the round trip.
const PING_MS: u32 = 500;
/// The link is dead after this long without a valid packet.
const SILENCE_MS: u32 = 2_000;
/// If the newest tick of the robot is older than this, motion would soon be refused as stale: ask for a `state`.
const TICK_OLD_MS: u32 = 150;
/// Events that wait for `poll`.
const EVENTS: usize = 12;

/// The host's end of the link. `now` is the host's own millisecond clock; its zero does not matter.
#[derive(Clone, Debug)]
pub struct HostSession {
    framer: Framer,
    core: HostCore,
}

/// Everything but the receiver, so that a packet can be read in the receiver's buffer while the session changes.
#[derive(Clone, Debug)]
struct HostCore {
    binary_wanted: BinaryKinds,
    phase: HostPhase,
    session: u16,
    /// Longest command that the robot accepts, in bytes without the separator.
    packet_max: usize,
    now: Tick,
    counters: LinkCounters,
    heard: Tick,
    next_sequence: Sequence,
    clock: RobotClock,
    arrivals: Arrivals,
    delivery: Delivery,
    gathering: Gathering,
    event_order: EventOrder,
    ping: Ping,
    state_wanted: bool,
    info_battery: Option<Battery>,
    info_link: LinkCounters,
    inbound: QualityWindow,
    outbound: QualityWindow,
    round_trip_ms: Option<u32>,
    binary: BinaryKinds,
    binary_left: bool,
    bad_in_row: u8,
    sent: Option<Tick>,
    events: Deque<HostEvent, EVENTS>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HostPhase {
    Greeting { due: Tick, reported_incompatible: bool },
    Open,
}

#[derive(Clone, Copy, Debug)]
struct Ping {
    due: Tick,
    under_way: Option<(Sequence, Tick)>,
}

impl HostSession {
    /// A session that is about to send `U`, a separator and its `hello`. `binary` are the kinds to agree upon.
    #[must_use]
    pub fn new(binary: BinaryKinds, now: Tick) -> Self {
        let mut inbound = QualityWindow::default();
        inbound.turn(now);
        let core = HostCore {
            binary_wanted: binary,
            phase: HostPhase::Greeting {
                due: now,
                reported_incompatible: false,
            },
            session: 0,
            packet_max: PACKET_BYTES_MAX,
            now,
            counters: LinkCounters::default(),
            heard: now,
            next_sequence: Sequence(1),
            clock: RobotClock::default(),
            arrivals: Arrivals::default(),
            delivery: Delivery::default(),
            gathering: Gathering::default(),
            event_order: EventOrder::default(),
            ping: Ping {
                due: now,
                under_way: None,
            },
            state_wanted: false,
            info_battery: None,
            info_link: LinkCounters::default(),
            inbound,
            outbound: inbound,
            round_trip_ms: None,
            binary: BinaryKinds::NONE,
            binary_left: false,
            bad_in_row: 0,
            sent: None,
            events: Deque::new(),
        };
        Self {
            framer: Framer::new(Direction::RobotToHost),
            core,
        }
    }

    /// Takes one received byte.
    #[must_use]
    #[inline]
    pub fn receive(&mut self, byte: u8, now: Tick) -> Option<HostEvent> {
        let framed = self.framer.push(byte)?;
        let event = self.core.take(framed, now);
        self.framer.set_session(self.core.session);
        event
    }

    /// The receiver saw a wrong stop bit.
    pub fn framing_error(&mut self) {
        self.core.counters.framing = self.core.counters.framing.wrapping_add(1);
        self.framer.poison(Poison::FramingError);
    }

    /// The receiver lost bytes.
    pub fn overrun(&mut self) {
        self.core.counters.overrun = self.core.counters.overrun.wrapping_add(1);
        self.framer.poison(Poison::Overrun);
    }

    /// Handles time; call it until it returns `None`.
    #[must_use]
    pub fn poll(&mut self, now: Tick) -> Option<HostEvent> {
        let event = self.core.poll(now);
        self.framer.set_session(self.core.session);
        event
    }

    /// The latest time of the next call of `poll` and [`next_packet`](Self::next_packet).
    #[must_use]
    pub fn next_poll(&self) -> Tick {
        self.core.next_poll()
    }

    /// Writes the next packet of the session itself (handshake, repeats, confirmations, keep-alive) into
    /// `buffer`, replacing its content. `false` = nothing to send. Call it after `receive`, `poll` and `send`.
    #[must_use]
    pub fn next_packet(&mut self, buffer: &mut PacketBuffer) -> bool {
        buffer.clear();
        self.core.next_packet(buffer).unwrap_or(false)
    }

    /// Writes `command` into `buffer`, replacing its content. The session overwrites `sequence` and `seen_tick`.
    /// Commands that must arrive are repeated until they are answered. Returns the number, if the command has one.
    /// `Stop` and `Info` can be sent at any time, with or without a session.
    ///
    /// # Errors
    /// See [`SendError`]; the buffer is empty then.
    pub fn send(
        &mut self,
        command: Command,
        now: Tick,
        buffer: &mut PacketBuffer,
    ) -> Result<Option<Sequence>, SendError> {
        self.core.now = now;
        buffer.clear();
        self.core.send(command, buffer).inspect_err(|_| buffer.clear())
    }

    /// Whether a session is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.core.phase == HostPhase::Open
    }

    /// Number of the open session, 0 = none.
    #[must_use]
    pub fn session(&self) -> u16 {
        self.core.session
    }

    /// The commands that the robot understands, as far as its description has been received.
    #[must_use]
    pub fn understood(&self) -> CommandNames {
        self.core.gathering.understood()
    }

    /// The robot's clock: newest received tick and its time on the host's clock.
    #[must_use]
    pub fn robot_tick(&self) -> Option<(Tick, Tick)> {
        self.core.clock.newest()
    }

    /// What has come from the robot since this end was made.
    #[must_use]
    pub const fn arrivals(&self) -> Arrivals {
        self.core.arrivals
    }

    /// Quality of the link over the last 5 s.
    #[must_use]
    pub fn quality(&self) -> LinkQuality {
        LinkQuality {
            inbound: self.core.inbound.totals(),
            outbound: self.core.outbound.totals(),
            round_trip_ms: self.core.round_trip_ms,
        }
    }

    /// Totals received at this end.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        self.core.counters
    }
}
