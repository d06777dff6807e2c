//! The robot's end.

mod answers;
mod event_queue;
mod hand;
mod inbound;
mod outbound;

pub use hand::{HAND_LEASE_MS_MAX, HAND_SPEED_MAX, HAND_TURN_MAX};

use heapless::Deque;
use rvac_units::Tick;

use self::answers::Answers;
use self::event_queue::EventQueue;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::crc::Direction;
use crate::frame::{Framer, Poison};
use crate::message::{
    Acknowledgement, BinaryKinds, Command, Description, Event, HostHello, LinkCounters, Name, Refusal,
    Report, ResetCause, Sequence,
};
use crate::session::{BAD_IN_ROW_MAX, FLUSH_AFTER_MS};

/// Identity of the robot; constant after a reset.
#[derive(Clone, Debug)]
pub struct RobotIdentity {
    /// Device, for example `sr8730`.
    pub device: Name,
    /// Firmware version.
    pub firmware: Name,
    /// Starts since the firmware was written, as far as the board counts them.
    pub boot_count: u32,
    /// Why it started.
    pub reset_cause: ResetCause,
    /// Any value that differs between starts (boot count, noise of an analogue input, memory after power-on). Session
    /// numbers are derived from it and from the time of the `hello`.
    pub session_seed: u32,
    /// Binary kinds the firmware can read and write.
    pub binary: BinaryKinds,
    /// Content of `describe`.
    pub description: Description,
}

/// Who may send commands, and with which limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// A person may type without CRCs; motion is slow: 0.1 m/s, 0.5 rad/s, a quarter of the wheels' throttle, leases of
    /// at most 500 ms, moves of at most 5 cm. The session clamps the values in the packet; the firmware limits the
    /// speed of a `move` ([`HAND_SPEED_MAX`], [`HAND_TURN_MAX`]).
    Hand,
    /// Only the host of this session commands, and every packet has a CRC.
    Checked,
}

/// Why a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SessionEnd {
    /// `{"c":"hand"}` was commanded.
    Hand,
    /// No valid checked packet for 2 s.
    Silence,
}

/// An event that the firmware must handle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RobotEvent {
    /// Execute this command. It is checked: well-formed, in range, with the CRC that the mode requires, fresh, no
    /// repeat, and clamped in hand mode. Never `Hello`, `Hand`, `Describe`, `Ping` or `Seen`, which the session handles
    /// itself.
    ///
    /// A command that must arrive ([`Command::must_arrive`]) requires one call of [`RobotSession::answer`], and so does
    /// a refused `drive` or `motor`. `Info` and `State` require a report.
    Command(Command),
    /// A host has opened a session: earlier leases are void.
    SessionOpened,
    /// Back to hand mode: earlier leases are void.
    SessionClosed(SessionEnd),
}

/// A session ends after this long without a valid checked packet.
pub const SESSION_SILENCE_MS: u32 = 2_000;
/// Motion whose `t` is older is refused.
pub const FRESHNESS_MS: u32 = 400;
/// Answers that wait for room on the line. Further ones are dropped; the host repeats its command.
const REPLIES: usize = 8;

/// The robot's end of the link.
#[derive(Clone, Debug)]
pub struct RobotSession {
    framer: Framer,
    core: RobotCore,
}

/// Everything but the receiver, so that a packet can be read in the receiver's buffer while the session changes.
#[derive(Clone, Debug)]
struct RobotCore {
    identity: RobotIdentity,
    mode: Mode,
    session: u16,
    now: Tick,
    counters: LinkCounters,
    /// When the last valid checked packet came.
    heard: Tick,
    /// The `hello` that opened the session, until another checked packet comes: a repeat of it does not open another
    /// session.
    opened_by: Option<HostHello>,
    motion: Option<(Sequence, Tick)>,
    answers: Answers,
    events: EventQueue,
    replies: Deque<Reply, REPLIES>,
    binary: BinaryKinds,
    binary_left: bool,
    bad_in_row: u8,
    sent: Option<Tick>,
}

#[derive(Clone, Copy, Debug)]
enum Reply {
    Hello,
    Row(u8),
    Answer(Acknowledgement),
}

impl RobotSession {
    /// A session after reset, in hand mode. The first packets are a separator and an unrequested `hello`.
    #[must_use]
    pub fn new(identity: RobotIdentity, now: Tick) -> Self {
        let mut core = RobotCore {
            identity,
            mode: Mode::Hand,
            session: 0,
            now,
            counters: LinkCounters::default(),
            heard: now,
            opened_by: None,
            motion: None,
            answers: Answers::default(),
            events: EventQueue::default(),
            replies: Deque::new(),
            binary: BinaryKinds::NONE,
            binary_left: false,
            bad_in_row: 0,
            sent: None,
        };
        core.reply(Reply::Hello);
        Self {
            framer: Framer::new(Direction::HostToRobot),
            core,
        }
    }

    /// Takes one received byte.
    #[must_use]
    #[inline]
    pub fn receive(&mut self, byte: u8, now: Tick) -> Option<RobotEvent> {
        let framed = self.framer.push(byte)?;
        let event = self.core.take(framed, now);
        self.framer.set_session(self.core.session);
        event
    }

    /// The receiver saw a wrong stop bit.
    pub fn framing_error(&mut self) {
        count(&mut self.core.counters.framing);
        self.framer.poison(Poison::FramingError);
    }

    /// The receiver lost bytes.
    pub fn overrun(&mut self) {
        count(&mut self.core.counters.overrun);
        self.framer.poison(Poison::Overrun);
    }

    /// Handles time: silence ends a session, unconfirmed events become due again. Cheap; call it in every pass of the
    /// main loop or at [`next_poll`](Self::next_poll).
    #[must_use]
    pub fn poll(&mut self, now: Tick) -> Option<RobotEvent> {
        self.core.now = now;
        let silent = now.since(self.core.heard) > SESSION_SILENCE_MS;
        if self.core.mode == Mode::Hand || !silent {
            return None;
        }
        let event = self.core.close(SessionEnd::Silence);
        self.framer.set_session(self.core.session);
        Some(event)
    }

    /// The latest time of the next call of `poll` or [`next_packet`](Self::next_packet).
    #[must_use]
    pub fn next_poll(&self) -> Tick {
        if self.core.events.is_empty() && self.core.mode == Mode::Checked {
            self.core.heard.after(SESSION_SILENCE_MS + 1)
        } else {
            self.core.now.after(event_queue::REPEAT_MS)
        }
    }

    /// Writes the next packet of the session itself (handshake, acknowledgements, rows of the description,
    /// events) into `buffer`, replacing its content. `false` = nothing to send.
    #[must_use]
    pub fn next_packet(&mut self, buffer: &mut PacketBuffer) -> bool {
        buffer.clear();
        let Some(report) = self.core.next_report() else {
            return false;
        };
        self.core.write(&report, buffer).is_ok()
    }

    /// Writes a report of the firmware (`State`, `Info`, `Log`) into `buffer`, replacing its content: with its CRC, in
    /// binary if that is agreed, with a separator before it if the line was silent.
    ///
    /// # Errors
    /// [`EncodeError`] if the report does not fit; the buffer is empty then. Every `State`, `Info` and `Log` fits.
    pub fn encode(&mut self, report: &Report, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
        buffer.clear();
        self.core.write(report, buffer).inspect_err(|_| buffer.clear())
    }

    /// Answers a numbered command: executed (`None`) or refused.
    pub fn answer(&mut self, sequence: Sequence, refusal: Option<Refusal>) {
        self.core.answers.give(sequence, refusal);
        if refusal.is_some() {
            count(&mut self.core.counters.refused);
        }
        self.core.reply_answer(Some(sequence), refusal);
    }

    /// Queues an event. The session numbers it and repeats it until the host confirms it.
    pub fn queue_event(&mut self, kind: Event, tick: Tick) {
        self.core.events.queue(kind, tick);
    }

    /// Hand or checked mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.core.mode
    }

    /// Number of the open session, 0 = none.
    #[must_use]
    pub fn session(&self) -> u16 {
        self.core.session
    }

    /// Totals since reset.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        self.core.counters
    }
}

fn count(total: &mut u32) {
    *total = total.wrapping_add(1);
}
