//! What comes from a bad line or a stale buffer moves nothing (S2, S3), and noise of any kind does no harm (S22).

use crate::rig::{Phases, Rig, drive, motor};
use cordlib::board::Received;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{Command, Inhibit, Motor};

/// The bytes of a command with its CRC, not yet on the line.
fn with_crc(rig: &mut Rig, command: Command) -> Vec<u8> {
    let mut packet = PacketBuffer::new();
    let now = rig.host_now();
    rig.host.send(command, now, &mut packet).expect("sending");
    packet.as_bytes().to_vec()
}

#[test]
fn s2_a_damaged_command_moves_nothing() {
    let mut rig = Rig::armed(0);
    let mut phases = Phases(2);
    for round in 0..3_000 {
        let command = match round % 3 {
            0 => drive(0.3, 0.0),
            1 => drive(-0.2, 1.0),
            _ => motor(Motor::WheelLeft, 1.0),
        };
        let mut bytes = with_crc(&mut rig, command);
        // Separators are no part of the packet: without one, or with two, it is still whole.
        let mut place = phases.below(bytes.len() as u32) as usize;
        while bytes[place] == 0x1F {
            place = phases.below(bytes.len() as u32) as usize;
        }
        match phases.below(3) {
            0 => bytes[place] ^= 1 << phases.below(8),
            1 => drop(bytes.remove(place)),
            _ => bytes.insert(place, bytes[place]),
        }
        rig.deliver(&bytes);
        rig.deliver(&[0x1F]);
        rig.run(5);
        assert!(
            rig.wheels_off(),
            "round {round}: {}",
            String::from_utf8_lossy(&bytes)
        );
    }
    assert!(rig.cord.is_armed());
}

#[test]
fn s3_commands_of_a_stale_buffer_are_refused() {
    let mut phases = Phases(3);
    for _ in 0..200 {
        let mut rig = Rig::armed(u32::MAX - phases.below(6_000));
        let old = with_crc(&mut rig, drive(0.3, 0.0));
        rig.run(450 + phases.below(4_500));
        rig.deliver(&old);
        for _ in 0..50 {
            rig.run(1);
            assert!(rig.wheels_off());
        }
    }
}

#[test]
fn s3_commands_of_before_a_reset_are_refused() {
    let mut before = Rig::driving(0);
    let old = with_crc(&mut before, drive(0.3, 0.0));
    let mut reset = Rig::switched_on(0);
    reset.host_dead = true;
    let received = old.into_iter().map(Received::Byte);
    reset.cord.board_mut().link.to_robot.extend(received);
    reset.run(100);
    assert!(reset.wheels_off() && reset.has(Inhibit::NotArmed));
}

#[test]
fn s22_noise_neither_moves_nor_harms() {
    let mut phases = Phases(22);
    let mut rig = Rig::armed(7);
    for _ in 0..20_000 {
        let noise = (0..phases.below(23)).map(|_| match phases.below(50) {
            0 => Received::FramingError,
            1 => Received::Overrun,
            2 | 3 => Received::Byte(0x1F),
            4 => Received::Byte(b'{'),
            _ => Received::Byte(phases.below(256) as u8),
        });
        let noise: Vec<Received> = noise.collect();
        rig.cord.board_mut().link.to_robot.extend(noise);
        rig.run(1);
        assert!(rig.wheels_off() && rig.cleaners_off());
    }
    rig.run(100);
    rig.connect();
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Ok(()), "{:?}", rig.names());
}
