//! What a host says: commands of all kinds, remembered by their number.

use rvac_channel::Pcg32;
use rvac_protocol::PacketBuffer;
use rvac_protocol::binary::write_drive_with_crc;
use rvac_protocol::message::{
    Beep, Command, Drive, Inhibit, Led, LedPattern, Motor, MotorCommand, Move, Parameter, Sequence,
};
use rvac_protocol::text::write_command_with_crc;
use rvac_units::{AngularSpeed, Frequency, Length, Ratio, Speed, Throttle, Tick};

/// A host that sends its commands in one session and remembers them.
pub(crate) struct Traffic {
    session: u16,
    next: Sequence,
    sent: Vec<Option<Command>>,
}

impl Traffic {
    pub(crate) fn new(session: u16) -> Self {
        Self {
            session,
            next: Sequence(1),
            sent: vec![None; 1 << 16],
        }
    }

    /// The next packet, with its separator. Numbers rise, ticks are fresh.
    pub(crate) fn packet(&mut self, random: &mut Pcg32, now: Tick) -> Vec<u8> {
        let sequence = self.next;
        self.next = sequence.next();
        let command = draw_command(random, sequence, now);
        if command.sequence().is_some() {
            self.sent[usize::from(sequence.0)] = Some(command);
        }
        let mut buffer = PacketBuffer::new();
        let written = match &command {
            Command::Drive(drive) if random.below(2) == 0 => {
                write_drive_with_crc(drive, self.session, &mut buffer)
            }
            _ => write_command_with_crc(&command, self.session, &mut buffer),
        };
        written.expect("drawn commands are within their ranges");
        buffer.as_bytes().to_vec()
    }

    /// Whether the host has said exactly this.
    pub(crate) fn has_said(&self, command: &Command) -> bool {
        match command.sequence() {
            Some(sequence) => self.sent[usize::from(sequence.0)].as_ref() == Some(command),
            None => [BEEP, LED, Command::Info, Command::State].contains(command),
        }
    }
}

const BEEP: Command = Command::Beep(Beep {
    pitch: Frequency(880),
    duration_ms: 200,
    volume: Ratio::ONE,
});

const LED: Command = Command::Led(Led {
    led: 3,
    pattern: LedPattern::Blink,
    brightness: Ratio::ONE,
});

/// Mostly motion: that is what must not go wrong, and what a host mostly says.
fn draw_command(random: &mut Pcg32, sequence: Sequence, now: Tick) -> Command {
    let signed = |random: &mut Pcg32, limit: i32| random.below(2 * limit as u32 + 1) as i32 - limit;
    match random.below(20) {
        0..=9 => Command::Drive(Drive {
            speed: Speed(signed(random, 350) * 1_000),
            turn: AngularSpeed(signed(random, 1_500) * 1_000),
            lease_ms: 250,
            sequence,
            seen_tick: now,
        }),
        10..=14 => Command::Motor(MotorCommand {
            motor: Motor::ALL[random.below(7) as usize],
            throttle: Throttle::saturating_from_millionths(signed(random, 100) * 10_000),
            lease_ms: 250,
            sequence,
            seen_tick: now,
        }),
        15 => Command::Move(Move {
            length: Length(signed(random, 2_000) * 1_000),
            radius: (random.below(2) == 0).then(|| Length(signed(random, 1_000) * 1_000)),
            sequence,
            seen_tick: now,
        }),
        16 => Command::Arm {
            sequence,
            undock: random.below(2) == 0,
        },
        17 => Command::Clear {
            sequence,
            inhibit: Inhibit::ALL[random.below(18) as usize],
        },
        18 => Command::Set {
            sequence,
            parameter: Parameter::StatePeriod,
            value: 10 + random.below(1_000) as i32,
        },
        _ => [BEEP, LED, Command::Info, Command::State][random.below(4) as usize],
    }
}

#[cfg(test)]
mod tests {
    use rvac_channel::Pcg32;
    use rvac_protocol::crc::Direction;
    use rvac_protocol::frame::{Framed, Framer};
    use rvac_protocol::message::{Command, Sequence};
    use rvac_protocol::text::{Form, read_command};
    use rvac_units::{Speed, Tick};

    use super::Traffic;

    #[test]
    fn only_what_was_said_with_its_number_was_said() {
        let mut traffic = Traffic::new(9);
        let mut framer = Framer::new(Direction::HostToRobot);
        framer.set_session(9);
        let mut random = Pcg32::new(1);
        let mut drives = 0;
        for _ in 0..200 {
            for byte in traffic.packet(&mut random, Tick(5)) {
                let Some(Framed::Checked(text)) = framer.push(byte) else {
                    continue;
                };
                let command = read_command(text, Form::Checked).expect("traffic is well-formed");
                assert!(traffic.has_said(&command));
                if let Command::Drive(drive) = command {
                    drives += 1;
                    let mut faster = drive;
                    faster.speed = Speed(drive.speed.0 + 1);
                    assert!(!traffic.has_said(&Command::Drive(faster)));
                    let mut later = drive;
                    later.sequence = Sequence(drive.sequence.0 + 1);
                    assert!(!traffic.has_said(&Command::Drive(later)));
                }
            }
        }
        assert!(drives > 10);
    }
}
