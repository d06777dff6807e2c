//! Damaged packets of motion for a cord that is armed: none of them may move anything.

use crate::host::{HostedCord, from_hex, hex};
use anyhow::{Context, bail};
use rvac_protocol::PacketBuffer;
use rvac_protocol::binary::write_drive_with_crc;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Motor, MotorCommand, Sequence};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_protocol::text::write_command_with_crc;
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};

/// Packets that the cord gets before it is asked what it did.
const BATCH: u64 = 16;
/// Batches between two sound packets, which show that the robot is ready to move.
const SOUND_EACH: u64 = 500;
/// Milliseconds in which the handshake is done.
const CONNECT_MS: u64 = 3_000;
/// A lease ends within so many empty packets, of a millisecond each.
const STILL_MS: u64 = 300;
const LEASE_MS: u16 = 250;
/// Flipped bits of a packet, at most.
const FLIPS_MOST: u64 = 8;

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corrupted {
    /// Damaged packets.
    pub packets: u64,
    /// Milliseconds in which a motor was on because of them.
    pub wrong_actuation_ms: u64,
    /// Sound packets in between, and how many of them moved the robot, as all must.
    pub sound: u64,
    /// Of them.
    pub sound_moved: u64,
}

impl Corrupted {
    /// Whether it is as it must be.
    #[must_use]
    pub const fn is_right(&self) -> bool {
        self.wrong_actuation_ms == 0 && self.sound > 0 && self.sound == self.sound_moved
    }
}

/// An armed cord and its session.
struct Target {
    cord: HostedCord,
    session: u16,
    tick: u32,
    number: u16,
    random: u64,
}

/// Sends so many damaged packets to a cord; `seed` is not 0.
///
/// # Errors
/// When a sanitizer has ended the cord, or it does not let itself be armed.
pub fn corrupt(cord: HostedCord, packets: u64, seed: u64) -> anyhow::Result<Corrupted> {
    let mut target = Target::armed(cord, seed)?;
    let mut found = Corrupted::default();
    let mut batches = 0;
    while found.packets < packets {
        if batches % SOUND_EACH == 0 {
            found.sound += 1;
            found.sound_moved += u64::from(target.moves_by_a_sound_one()?);
        }
        batches += 1;
        let count = BATCH.min(packets - found.packets);
        found.wrong_actuation_ms += target.damage(count)?;
        found.packets += count;
    }
    found.sound += 1;
    found.sound_moved += u64::from(target.moves_by_a_sound_one()?);
    Ok(found)
}

impl Target {
    /// Opens a session with both binary kinds, and arms.
    fn armed(mut cord: HostedCord, seed: u64) -> anyhow::Result<Self> {
        let kinds = BinaryKinds {
            state: true,
            drive: true,
        };
        let mut host = HostSession::new(kinds, Tick(0));
        let mut number = None;
        for ms in 0..CONNECT_MS {
            let now = Tick(ms as u32);
            let mut bytes = Vec::new();
            let mut packet = PacketBuffer::new();
            while host.poll(now).is_some() {}
            while host.next_packet(&mut packet) {
                bytes.extend_from_slice(packet.as_bytes());
            }
            let line = format!("S 0 0 0 0 0 {}", hex(&bytes));
            let answers = cord.ask(&[line])?;
            let sent = answers.iter().filter_map(|answer| answer.split(' ').nth(3));
            for byte in sent.flat_map(from_hex).collect::<Vec<_>>() {
                if let Some(HostEvent::Described(_)) = host.receive(byte, now) {
                    number = Some(0);
                }
            }
        }
        let mut target = Self {
            cord,
            session: host.session(),
            tick: 0,
            number: number.context("the cord does not describe itself")?,
            random: seed,
        };
        // Far above the numbers of the handshake.
        target.number = 1_000;
        target.pass(&[])?;
        let sequence = target.next_number();
        let arm = target.text(&Command::Arm {
            sequence,
            undock: false,
        })?;
        target.pass(&arm)?;
        Ok(target)
    }

    fn next_number(&mut self) -> Sequence {
        self.number = self.number.wrapping_add(1);
        Sequence(self.number)
    }

    fn text(&self, command: &Command) -> anyhow::Result<Vec<u8>> {
        let mut packet = PacketBuffer::new();
        write_command_with_crc(command, self.session, &mut packet)
            .map_err(|error| anyhow::anyhow!("{error:?}"))?;
        Ok(packet.as_bytes().to_vec())
    }

    /// Milliseconds with a motor on.
    fn pass(&mut self, packet: &[u8]) -> anyhow::Result<u64> {
        let answers = self.cord.ask(&[format!("D {}", hex(packet))])?;
        self.read(&answers)
    }

    fn read(&mut self, answers: &[String]) -> anyhow::Result<u64> {
        let mut on_ms = 0;
        for answer in answers {
            let mut words = answer.split(' ').map(str::parse::<u64>);
            let (Some(Ok(on)), Some(Ok(tick))) = (words.next(), words.next()) else {
                bail!("the cord says {answer}");
            };
            on_ms += on;
            self.tick = tick as u32;
        }
        Ok(on_ms)
    }

    fn random(&mut self, bound: u64) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random % bound.max(1)
    }

    /// A sound packet of motion: `drive` as binary or text, or `motor`.
    fn motion(&mut self) -> anyhow::Result<Vec<u8>> {
        let sequence = self.next_number();
        let seen_tick = Tick(self.tick);
        let drive = Drive {
            speed: Speed::from_m_per_s(0.15),
            turn: AngularSpeed::from_rad_per_s(0.3),
            lease_ms: LEASE_MS,
            sequence,
            seen_tick,
        };
        let motor = MotorCommand {
            motor: Motor::BrushMain,
            throttle: Throttle::FULL,
            lease_ms: LEASE_MS,
            sequence,
            seen_tick,
        };
        match self.random(3) {
            0 => self.text(&Command::Drive(drive)),
            1 => self.text(&Command::Motor(motor)),
            _ => {
                let mut packet = PacketBuffer::new();
                write_drive_with_crc(&drive, self.session, &mut packet)
                    .map_err(|error| anyhow::anyhow!("{error:?}"))?;
                Ok(packet.as_bytes().to_vec())
            }
        }
    }

    /// A packet of motion with flipped, lost or foreign bytes.
    fn damaged(&mut self) -> anyhow::Result<Vec<u8>> {
        let sound = self.motion()?;
        let mut packet = sound.clone();
        while packet == sound {
            for _ in 0..=self.random(FLIPS_MOST) {
                let at = self.random(packet.len().saturating_sub(1) as u64) as usize;
                let (kind, bit, byte) = (self.random(8), self.random(8), self.random(256) as u8);
                match packet.get_mut(at) {
                    Some(place) if kind == 0 => *place = byte,
                    Some(_) if kind == 1 => drop(packet.remove(at)),
                    Some(place) => *place ^= 1 << bit,
                    None => {}
                }
            }
        }
        Ok(packet)
    }

    /// A batch of damaged packets, with a sound `ping` behind it that keeps the session open.
    fn damage(&mut self, count: u64) -> anyhow::Result<u64> {
        let mut lines = Vec::new();
        for _ in 0..count {
            lines.push(format!("D {}", hex(&self.damaged()?)));
        }
        let sequence = self.next_number();
        let ping = self.text(&Command::Ping { sequence })?;
        // What the last packet left without an end is ended first.
        lines.push(format!("D 1f{}", hex(&ping)));
        let answers = self.cord.ask(&lines)?;
        self.read(&answers)
    }

    /// Whether a sound packet moves the robot; it stands again when this returns.
    fn moves_by_a_sound_one(&mut self) -> anyhow::Result<bool> {
        let packet = self.motion()?;
        let mut on_ms = self.pass(&packet)?;
        for _ in 0..STILL_MS {
            on_ms += self.pass(&[])?;
        }
        if self.pass(&[])? > 0 {
            bail!("a lease of {LEASE_MS} ms did not end in {STILL_MS} ms");
        }
        Ok(on_ms > 0)
    }
}
