//! Packets from the host.

use rvac_units::Tick;

use super::answers::{Known, MEMORY_MS};
use super::{BAD_IN_ROW_MAX, FRESHNESS_MS, Mode, Reply, RobotCore, RobotEvent, SessionEnd, count, hand};
use crate::binary;
use crate::crc::{Direction, packet_crc};
use crate::frame::{Framed, Poison};
use crate::message::{Acknowledgement, Command, HostHello, ProtocolVersion, Refusal, Sequence};
use crate::session::BAUD_RATE_PATTERN;
use crate::text::{Form, RefusedCommand, is_stop, read_command};

/// Whether the packet carried the right CRC.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PacketTrust {
    Checked,
    Unchecked,
}

impl RobotCore {
    pub(super) fn take(&mut self, framed: Framed<'_>, now: Tick) -> Option<RobotEvent> {
        self.now = now;
        match framed {
            Framed::Checked(text) => self.take_checked(text),
            Framed::Binary { kind, body } => self.take_binary(kind, body),
            Framed::Unchecked(text) => self.take_unchecked(text),
            Framed::BadCrc { text, crc } => self.take_bad_crc(text, crc),
            Framed::BinaryBadCrc => {
                count(&mut self.counters.bad_crc);
                self.bad()
            }
            Framed::Poisoned(poison) => {
                if matches!(poison, Poison::TooLong | Poison::ControlByte) {
                    count(&mut self.counters.malformed);
                }
                count(&mut self.counters.resync);
                self.bad()
            }
        }
    }

    fn take_checked(&mut self, text: &[u8]) -> Option<RobotEvent> {
        self.good();
        match read_command(text, self.form(PacketTrust::Checked)) {
            Ok(command) => {
                // A host that agreed on a binary form and sends text has stopped using it, and so does the robot.
                self.binary_left |= self.binary.drive && matches!(command, Command::Drive(_));
                self.accept(command, PacketTrust::Checked)
            }
            Err(refused) => self.refuse(refused),
        }
    }

    fn take_binary(&mut self, kind: u8, body: &[u8]) -> Option<RobotEvent> {
        self.good();
        if kind != binary::DRIVE || !self.binary.drive {
            return self.refuse_with(None, Refusal::Unknown);
        }
        match binary::read_drive(body) {
            Ok(drive) => self.accept(Command::Drive(drive), PacketTrust::Checked),
            Err(refusal) => self.refuse_with(None, refusal),
        }
    }

    fn take_unchecked(&mut self, text: &[u8]) -> Option<RobotEvent> {
        if text.iter().all(|byte| *byte == BAUD_RATE_PATTERN) {
            return None;
        }
        if is_stop(text) {
            return self.accept(Command::Stop, PacketTrust::Unchecked);
        }
        if self.mode == Mode::Checked {
            self.bad();
            return self.refuse_with(None, Refusal::NoCrc);
        }
        match read_command(text, self.form(PacketTrust::Unchecked)) {
            Ok(command) => self.accept(command, PacketTrust::Unchecked),
            Err(refused) => self.refuse(refused),
        }
    }

    /// The CRC is not that of this session. `stop` counts anyway, and a `hello` always has the CRC of session 0.
    fn take_bad_crc(&mut self, text: &[u8], found: u32) -> Option<RobotEvent> {
        if is_stop(text) {
            return self.accept(Command::Stop, PacketTrust::Unchecked);
        }
        if self.session != 0
            && found == packet_crc(Direction::HostToRobot, 0, text)
            && let Ok(command @ Command::Hello(_)) = read_command(text, self.form(PacketTrust::Checked))
        {
            return self.accept(command, PacketTrust::Checked);
        }
        count(&mut self.counters.bad_crc);
        self.bad()
    }

    fn form(&self, trust: PacketTrust) -> Form {
        let now = self.now;
        match (self.mode, trust) {
            (Mode::Checked, _) => Form::Checked,
            (Mode::Hand, PacketTrust::Checked) => Form::SealedHand { now },
            (Mode::Hand, PacketTrust::Unchecked) => Form::Hand { now },
        }
    }

    fn accept(&mut self, command: Command, trust: PacketTrust) -> Option<RobotEvent> {
        match command {
            Command::Hello(hello) => self.greet(hello, trust),
            Command::Hand => {
                self.accepted();
                (self.mode == Mode::Checked).then(|| self.close(SessionEnd::Hand))
            }
            Command::Describe { row } => self.describe(row),
            Command::Ping { sequence } => {
                self.accepted();
                self.reply_answer(Some(sequence), None);
                None
            }
            Command::Seen { event } => {
                self.accepted();
                self.events.confirm(event);
                None
            }
            Command::Drive(drive) => {
                let outcome = self.fresh(drive.sequence, drive.seen_tick);
                self.act(command, outcome)
            }
            Command::Motor(motor) => {
                let outcome = self.fresh(motor.sequence, motor.seen_tick);
                self.act(command, outcome)
            }
            Command::Move(_)
            | Command::Arm { .. }
            | Command::Clear { .. }
            | Command::Set { .. }
            | Command::Charge { .. }
            | Command::Probe(_) => self.accept_once(command),
            Command::Info | Command::State | Command::Stop | Command::Beep(_) | Command::Led(_) => {
                self.act(command, Ok(()))
            }
        }
    }

    /// A command that must arrive: executed once, answered for each repeat.
    fn accept_once(&mut self, command: Command) -> Option<RobotEvent> {
        let sequence = command.sequence()?;
        if self.mode == Mode::Checked {
            match self.answers.note(sequence, self.now) {
                Known::New => {}
                Known::Pending => {
                    self.accepted();
                    return None;
                }
                Known::Answered(refusal) => {
                    self.accepted();
                    self.reply_answer(Some(sequence), refusal);
                    return None;
                }
                Known::Forgotten => return self.refuse_with(Some(sequence), Refusal::Old),
            }
        }
        let outcome = match command {
            Command::Move(movement) => self.fresh(movement.sequence, movement.seen_tick),
            _ => Ok(()),
        };
        if let Err(refusal) = outcome {
            self.answers.give(sequence, Some(refusal));
        }
        self.act(command, outcome)
    }

    fn act(&mut self, command: Command, outcome: Result<(), Refusal>) -> Option<RobotEvent> {
        if let Err(refusal) = outcome {
            return self.refuse_with(command.sequence(), refusal);
        }
        self.accepted();
        Some(RobotEvent::Command(match self.mode {
            Mode::Hand => hand::clamp(command),
            Mode::Checked => command,
        }))
    }

    /// Whether motion is fresh. Numbers are compared with those of the last seconds only: ticks exclude older packets,
    /// and after hours without motion the counter may have advanced by half its range.
    fn fresh(&mut self, sequence: Sequence, seen: Tick) -> Result<(), Refusal> {
        if self.now.since(seen) > FRESHNESS_MS {
            return Err(Refusal::Stale);
        }
        if self.mode == Mode::Hand {
            return Ok(());
        }
        if let Some((last, when)) = self.motion
            && self.now.since(when) < MEMORY_MS
            && !sequence.is_newer_than(last)
        {
            return Err(Refusal::Old);
        }
        self.motion = Some((sequence, self.now));
        Ok(())
    }

    fn greet(&mut self, hello: HostHello, trust: PacketTrust) -> Option<RobotEvent> {
        self.accepted();
        self.reply(Reply::Hello);
        let common =
            hello.version_min <= ProtocolVersion::CURRENT && hello.version_max >= ProtocolVersion::MIN;
        let repeated = self.opened_by == Some(hello);
        if trust == PacketTrust::Unchecked || !common || repeated {
            return None;
        }
        self.session = self.new_session_number();
        self.mode = Mode::Checked;
        self.binary = hello.binary.common(self.identity.binary);
        self.binary_left = false;
        self.motion = None;
        self.answers.clear();
        self.events.restart();
        self.good();
        self.opened_by = Some(hello);
        Some(RobotEvent::SessionOpened)
    }

    /// Differs from the last one and, very likely, from those before the reset.
    fn new_session_number(&self) -> u16 {
        let [s0, s1, s2, s3] = self.identity.session_seed.to_le_bytes();
        let [t0, t1, t2, t3] = self.now.0.to_le_bytes();
        let mixed = packet_crc(
            Direction::RobotToHost,
            self.session,
            &[s0, s1, s2, s3, t0, t1, t2, t3],
        );
        let number = (mixed ^ mixed >> 16) as u16;
        if number == 0 || number == self.session {
            self.session.wrapping_add(1).max(1)
        } else {
            number
        }
    }

    pub(super) fn close(&mut self, end: SessionEnd) -> RobotEvent {
        self.session = 0;
        self.mode = Mode::Hand;
        self.binary = crate::message::BinaryKinds::NONE;
        self.opened_by = None;
        self.motion = None;
        self.answers.clear();
        self.reply(Reply::Hello);
        RobotEvent::SessionClosed(end)
    }

    fn describe(&mut self, row: u8) -> Option<RobotEvent> {
        if row >= super::outbound::ROWS {
            return self.refuse_with(None, Refusal::Range);
        }
        self.accepted();
        self.reply(Reply::Row(row));
        None
    }

    fn accepted(&mut self) {
        count(&mut self.counters.accepted);
    }

    fn refuse(&mut self, refused: RefusedCommand) -> Option<RobotEvent> {
        self.refuse_with(refused.sequence, refused.refusal)
    }

    fn refuse_with(&mut self, sequence: Option<Sequence>, refusal: Refusal) -> Option<RobotEvent> {
        count(&mut self.counters.refused);
        self.reply_answer(sequence, Some(refusal));
        None
    }

    pub(super) fn reply_answer(&mut self, sequence: Option<Sequence>, refusal: Option<Refusal>) {
        self.reply(Reply::Answer(Acknowledgement { sequence, refusal }));
    }

    pub(super) fn reply(&mut self, reply: Reply) {
        // A full queue drops the answer; the host repeats its command.
        self.replies.push_back(reply).ok();
    }

    /// A valid checked packet.
    fn good(&mut self) {
        self.heard = self.now;
        self.bad_in_row = 0;
        self.opened_by = None;
    }

    fn bad(&mut self) -> Option<RobotEvent> {
        self.bad_in_row = self.bad_in_row.saturating_add(1);
        if self.bad_in_row >= BAD_IN_ROW_MAX {
            self.binary_left = true;
        }
        None
    }
}
