//! The binary forms of `state` and `drive`: same meaning as the text, an eighth of the bytes.
//!
//! A packet is its kind byte, the body below, and the CRC of both, little endian. All integers are little endian. The
//! bytes 0x1D, 0x1E and 0x1F are stuffed on the line; here they are unstuffed.

use heapless::Vec;
use rvac_units::{Angle, AngularSpeed, Current, Speed, Tick, Voltage};

use crate::buffer::{EncodeError, PacketBuffer};
use crate::crc::Direction;
use crate::message::{
    Bumpers, ChargeState, Cliffs, Currents, Drive, Gyro, Inhibits, MotionPhase, PackReading, Refusal,
    Sequence, State, WheelDrops,
};
use crate::span::{self, Span};

/// Kind byte of `drive`.
pub const DRIVE: u8 = 0x81;
/// Kind byte of `state`.
pub const STATE: u8 = 0x82;
/// Bytes of a `drive` body.
pub const DRIVE_BYTES: usize = 16;
/// Bytes of a `state` body.
pub const STATE_BYTES: usize = 50;

/// Kind and body of a packet.
pub(crate) type Packet = Vec<u8, { STATE_BYTES + 1 }>;

/// Reads the body of a `drive`.
///
/// # Errors
/// [`Refusal::Syntax`] for a wrong length, [`Refusal::Range`] for a number that text would not allow either.
#[inline]
pub fn read_drive(body: &[u8]) -> Result<Drive, Refusal> {
    let mut reader = BodyReader::new::<DRIVE_BYTES>(body)?;
    Ok(Drive {
        speed: Speed(within(reader.i32(), span::SPEED)?),
        turn: AngularSpeed(within(reader.i32(), span::TURN)?),
        lease_ms: within(reader.u16(), span::LEASE)?,
        sequence: Sequence(reader.u16()),
        seen_tick: Tick(reader.u32()),
    })
}

/// Kind and body of a `drive`; `None` if a number is out of range.
#[must_use]
pub fn write_drive(drive: &Drive) -> Option<[u8; DRIVE_BYTES + 1]> {
    within(drive.speed.0, span::SPEED).ok()?;
    within(drive.turn.0, span::TURN).ok()?;
    within(drive.lease_ms, span::LEASE).ok()?;
    let [v0, v1, v2, v3] = drive.speed.0.to_le_bytes();
    let [w0, w1, w2, w3] = drive.turn.0.to_le_bytes();
    let [l0, l1] = drive.lease_ms.to_le_bytes();
    let [n0, n1] = drive.sequence.0.to_le_bytes();
    let [t0, t1, t2, t3] = drive.seen_tick.0.to_le_bytes();
    Some([
        DRIVE, v0, v1, v2, v3, w0, w1, w2, w3, l0, l1, n0, n1, t0, t1, t2, t3,
    ])
}

/// Appends a `drive` with its CRC for `session`, and a separator.
///
/// # Errors
/// [`EncodeError::Range`] if a number is out of range; the buffer is then unchanged.
pub fn write_drive_with_crc(
    drive: &Drive,
    session: u16,
    buffer: &mut PacketBuffer,
) -> Result<(), EncodeError> {
    let packet = write_drive(drive).ok_or(EncodeError::Range)?;
    buffer.push_binary(&packet, Direction::HostToRobot, session)
}

/// Appends a `state` with its CRC for `session`, and a separator.
///
/// # Errors
/// [`EncodeError::TooLong`] if the buffer is full.
pub fn write_state_with_crc(
    state: &State,
    session: u16,
    buffer: &mut PacketBuffer,
) -> Result<(), EncodeError> {
    buffer.push_binary(&write_state(state), Direction::RobotToHost, session)
}

fn within<T: Copy + Into<i64>>(value: T, span: Span) -> Result<T, Refusal> {
    if span.contains(value.into()) {
        Ok(value)
    } else {
        Err(Refusal::Range)
    }
}

/// Bits of the flags in a `state` body, from bit 0.
fn flags(state: &State) -> u16 {
    let bits = [
        state.bumpers.left,
        state.bumpers.right,
        state.cliffs.left,
        state.cliffs.middle,
        state.cliffs.right,
        state.wheel_drops.left,
        state.wheel_drops.right,
        state.dust_box == Some(true),
        state.docked,
        state.cleaners & 1 != 0,
        state.cleaners & 2 != 0,
        state.cleaners & 4 != 0,
        state.gyro.is_some(),
        state.dust_box.is_none(),
        state.currents.is_none(),
        state.pack.is_none(),
    ];
    bits.into_iter()
        .enumerate()
        .fold(0, |flags, (bit, set)| flags | u16::from(set) << bit)
}

/// Kind and body of a `state`. Measurements beyond their span are written as its nearest value, as in text.
#[must_use]
pub fn write_state(state: &State) -> Vec<u8, { STATE_BYTES + 1 }> {
    let gyro = state.gyro.unwrap_or_default();
    let currents = state.currents.unwrap_or_default();
    let pack = state.pack.unwrap_or_default();
    let mut packet = Packet::new();
    // The parts add up to the capacity, so none is left out.
    let mut put = |bytes: &[u8]| packet.extend_from_slice(bytes).ok();
    let current = |current: Current| (span::CURRENT.saturate(i64::from(current.0)) as i16).to_le_bytes();
    put(&[STATE]);
    put(&state.tick.0.to_le_bytes());
    put(&state.count_left.to_le_bytes());
    put(&state.count_right.to_le_bytes());
    put(&gyro.heading.0.to_le_bytes());
    put(&gyro.rate.0.to_le_bytes());
    put(&state.proximity);
    put(&state.dock);
    put(&flags(state).to_le_bytes());
    put(&[state.buttons]);
    put(&[charge_code(state.charge) | motion_code(state.motion) << 4]);
    put(&current(currents.wheel_left));
    put(&current(currents.wheel_right));
    put(&current(currents.brush_main));
    put(&(span::VOLTAGE.saturate(i64::from(pack.voltage.0)) as u16).to_le_bytes());
    put(&current(pack.current));
    put(&state.inhibits.bits().to_le_bytes());
    packet
}

/// Reads the body of a `state`.
///
/// # Errors
/// [`Refusal::Syntax`] for a wrong length, [`Refusal::Unknown`] for a charge or motion code of a newer robot,
/// [`Refusal::Range`] for a current that the text would not allow either.
pub fn read_state(body: &[u8]) -> Result<State, Refusal> {
    let mut reader = BodyReader::new::<STATE_BYTES>(body)?;
    let tick = Tick(reader.u32());
    let count_left = reader.i32();
    let count_right = reader.i32();
    let gyro = Gyro {
        heading: Angle(reader.i32()),
        rate: AngularSpeed(reader.i32()),
    };
    let proximity = reader.bytes();
    let dock = reader.bytes();
    let flags = reader.u16();
    let flag = |bit: u32| flags >> bit & 1 == 1;
    let [buttons, codes] = reader.bytes();
    let currents = Currents {
        wheel_left: reader.current()?,
        wheel_right: reader.current()?,
        brush_main: reader.current()?,
    };
    let pack = PackReading {
        voltage: Voltage(i32::from(reader.u16())),
        current: reader.current()?,
    };
    Ok(State {
        tick,
        count_left,
        count_right,
        gyro: flag(12).then_some(gyro),
        bumpers: Bumpers {
            left: flag(0),
            right: flag(1),
        },
        cliffs: Cliffs {
            left: flag(2),
            middle: flag(3),
            right: flag(4),
        },
        wheel_drops: WheelDrops {
            left: flag(5),
            right: flag(6),
        },
        proximity,
        dock,
        buttons,
        dust_box: (!flag(13)).then_some(flag(7)),
        currents: (!flag(14)).then_some(currents),
        pack: (!flag(15)).then_some(pack),
        charge: charge_from_code(codes & 0xF)?,
        docked: flag(8),
        inhibits: Inhibits::from_bits(reader.u32()),
        motion: motion_from_code(codes >> 4)?,
        cleaners: (flags >> 9 & 7) as u8,
    })
}

const fn charge_code(charge: ChargeState) -> u8 {
    match charge {
        ChargeState::Discharging => 0,
        ChargeState::Charging => 1,
        ChargeState::Full => 2,
        ChargeState::Fault => 3,
    }
}

fn charge_from_code(code: u8) -> Result<ChargeState, Refusal> {
    match code {
        0 => Ok(ChargeState::Discharging),
        1 => Ok(ChargeState::Charging),
        2 => Ok(ChargeState::Full),
        3 => Ok(ChargeState::Fault),
        _ => Err(Refusal::Unknown),
    }
}

const fn motion_code(motion: MotionPhase) -> u8 {
    match motion {
        MotionPhase::Idle => 0,
        MotionPhase::Drive => 1,
        MotionPhase::Move => 2,
        MotionPhase::Motor => 3,
        MotionPhase::Reflex => 4,
    }
}

fn motion_from_code(code: u8) -> Result<MotionPhase, Refusal> {
    match code {
        0 => Ok(MotionPhase::Idle),
        1 => Ok(MotionPhase::Drive),
        2 => Ok(MotionPhase::Move),
        3 => Ok(MotionPhase::Motor),
        4 => Ok(MotionPhase::Reflex),
        _ => Err(Refusal::Unknown),
    }
}

/// Reads fixed parts one after another from a body whose length was checked once.
struct BodyReader<'a> {
    rest: &'a [u8],
}

impl<'a> BodyReader<'a> {
    fn new<const LENGTH: usize>(body: &'a [u8]) -> Result<Self, Refusal> {
        if body.len() == LENGTH {
            Ok(Self { rest: body })
        } else {
            Err(Refusal::Syntax)
        }
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        match self.rest.split_first_chunk::<N>() {
            Some((bytes, rest)) => {
                self.rest = rest;
                *bytes
            }
            // The checked length covers every part that is read.
            None => [0; N],
        }
    }

    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.bytes())
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.bytes())
    }

    fn current(&mut self) -> Result<Current, Refusal> {
        within(i16::from_le_bytes(self.bytes()), span::CURRENT).map(|current| Current(i32::from(current)))
    }
}
