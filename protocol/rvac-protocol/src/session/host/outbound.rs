//! Packets to the robot.

use super::{HostCore, HostPhase, PING_MS, SendError, TICK_OLD_MS};
use crate::binary;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::frame::SEPARATOR;
use crate::message::{Command, HostHello, ProtocolVersion, Sequence};
use crate::session::{BAUD_RATE_PATTERN, FLUSH_AFTER_MS};
use crate::text::write_command_with_crc;

impl HostCore {
    pub(super) fn send(
        &mut self,
        command: Command,
        buffer: &mut PacketBuffer,
    ) -> Result<Option<Sequence>, SendError> {
        if is_reserved(&command) {
            return Err(SendError::Reserved);
        }
        let always = matches!(command, Command::Stop | Command::Info);
        if self.phase != HostPhase::Open && !always {
            return Err(SendError::NotOpen);
        }
        if command.must_arrive() && self.delivery.is_full() {
            return Err(SendError::Busy);
        }
        let stamped = self.stamp(command);
        self.write(&stamped, buffer)?;
        let sequence = stamped.sequence();
        if let Some(number) = sequence {
            self.take_sequence();
            if stamped.must_arrive() {
                self.delivery.sent(stamped, number, self.now);
            }
        }
        Ok(sequence)
    }

    /// Puts the session's number and the robot's newest tick into the command.
    fn stamp(&mut self, command: Command) -> Command {
        let next = self.next_sequence;
        let (tick, heard) = self.clock.newest().unwrap_or_default();
        let is_motion = matches!(command, Command::Drive(_) | Command::Motor(_) | Command::Move(_));
        self.state_wanted |= is_motion && self.now.since(heard) >= TICK_OLD_MS;
        match command {
            Command::Drive(mut drive) => {
                drive.sequence = next;
                drive.seen_tick = tick;
                Command::Drive(drive)
            }
            Command::Motor(mut motor) => {
                motor.sequence = next;
                motor.seen_tick = tick;
                Command::Motor(motor)
            }
            Command::Move(mut movement) => {
                movement.sequence = next;
                movement.seen_tick = tick;
                Command::Move(movement)
            }
            Command::Arm { undock, .. } => Command::Arm {
                sequence: next,
                undock,
            },
            Command::Clear { inhibit, .. } => Command::Clear {
                sequence: next,
                inhibit,
            },
            Command::Set { parameter, value, .. } => Command::Set {
                sequence: next,
                parameter,
                value,
            },
            Command::Ping { .. } => Command::Ping { sequence: next },
            Command::Charge { wanted, .. } => Command::Charge {
                sequence: next,
                wanted,
            },
            Command::Probe(mut probe) => {
                probe.sequence = next;
                Command::Probe(probe)
            }
            Command::Hello(_)
            | Command::Hand
            | Command::Describe { .. }
            | Command::Info
            | Command::State
            | Command::Stop
            | Command::Beep(_)
            | Command::Led(_)
            | Command::Seen { .. } => command,
        }
    }

    /// Writes a packet of the session itself: `Ok(false)` = nothing to send.
    pub(super) fn next_packet(&mut self, buffer: &mut PacketBuffer) -> Result<bool, EncodeError> {
        if let HostPhase::Greeting {
            due,
            reported_incompatible,
        } = self.phase
        {
            return self.greet(due, reported_incompatible, buffer);
        }
        let Some(command) = self.next_command() else {
            return Ok(false);
        };
        self.write(&command, buffer).map(|()| true)
    }

    fn greet(
        &mut self,
        due: rvac_units::Tick,
        reported_incompatible: bool,
        buffer: &mut PacketBuffer,
    ) -> Result<bool, EncodeError> {
        if !self.now.reached(due) {
            return Ok(false);
        }
        self.phase = HostPhase::Greeting {
            due: self.now.after(Self::greeting_pause_ms(reported_incompatible)),
            reported_incompatible,
        };
        self.sent = Some(self.now);
        buffer.push(BAUD_RATE_PATTERN)?;
        buffer.push(SEPARATOR)?;
        let hello = Command::Hello(HostHello {
            version_min: ProtocolVersion::MIN,
            version_max: ProtocolVersion::CURRENT,
            binary: self.binary_wanted,
        });
        write_command_with_crc(&hello, 0, buffer).map(|()| true)
    }

    fn next_command(&mut self) -> Option<Command> {
        if let Some(event) = self.event_order.take_confirmation() {
            return Some(Command::Seen { event });
        }
        if let Some(command) = self.delivery.take_due(self.now) {
            return Some(command);
        }
        if core::mem::take(&mut self.state_wanted) {
            return Some(Command::State);
        }
        if let Some(row) = self.gathering.take_due(self.now) {
            return Some(Command::Describe { row });
        }
        if !self.now.reached(self.ping.due) {
            return None;
        }
        let sequence = self.take_sequence();
        self.ping.under_way = Some((sequence, self.now));
        self.ping.due = self.now.after(PING_MS);
        Some(Command::Ping { sequence })
    }

    fn write(&mut self, command: &Command, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
        let silent = self
            .sent
            .is_none_or(|sent| self.now.since(sent) >= FLUSH_AFTER_MS);
        if silent {
            buffer.push(SEPARATOR)?;
        }
        let start = buffer.length();
        match command {
            Command::Drive(drive) if self.binary.drive && !self.binary_left => {
                binary::write_drive_with_crc(drive, self.session, buffer)
            }
            _ => write_command_with_crc(command, self.session, buffer),
        }?;
        // Stuffing and separator do not count towards the limit, so this may refuse slightly too early, never too late.
        if buffer.length().saturating_sub(start) > self.packet_max.saturating_add(1) {
            return Err(EncodeError::TooLong);
        }
        self.sent = Some(self.now);
        Ok(())
    }
}

/// Whether only the session itself sends it.
const fn is_reserved(command: &Command) -> bool {
    matches!(
        command,
        Command::Hello(_)
            | Command::Hand
            | Command::Describe { .. }
            | Command::Ping { .. }
            | Command::Seen { .. }
    )
}
