//! The serial line to the host.

use crate::rig::{STAY, pass_ms, program, robot, robot_with, world};
use rvac_channel::FaultRates;
use rvac_protocol::message::ResetCause;
use stc90::board::{EmulatedRelax, HostRate, RelaxSettings};

/// Timer 2 makes 38,265 of 38,400; the UART receives.
const SETUP: [(u8, u8); 4] = [(0xCB, 0xFF), (0xCA, 0xCF), (0xC8, 0x34), (0x98, 0x50)];
/// JNB RI, self; CLR RI; MOV SBUF, SBUF; SJMP back: each byte comes back.
const ECHO: [u8; 10] = [0x30, 0x98, 0xFD, 0xC2, 0x98, 0x85, 0x99, 0x99, 0x80, 0xF6];

fn echo(settings: RelaxSettings) -> EmulatedRelax {
    let mut robot = robot_with(&program(&SETUP, &ECHO), world(2.0, 1.5), settings);
    pass_ms(&mut robot, 2);
    robot
}

/// The chip is a little slower than the host, so an echo without a buffer can answer single bytes only.
fn talk(robot: &mut EmulatedRelax, bytes: &[u8]) -> Vec<u8> {
    let mut heard = Vec::new();
    for byte in bytes {
        assert_eq!(robot.send(&[*byte]), 1);
        heard.extend(pass_ms(robot, 1));
    }
    heard
}

#[test]
fn bytes_come_back() {
    let mut robot = echo(RelaxSettings::default());
    let sent: Vec<u8> = (0..=255).collect();
    assert_eq!(talk(&mut robot, &sent), sent);
    assert_eq!((robot.machine().overruns(), robot.machine().unheard()), (0, 0));
    assert_eq!(robot.machine().misuses(), []);
}

#[test]
fn another_rate_is_not_understood() {
    let mut robot = echo(RelaxSettings {
        rate: HostRate { baud: 57_600 },
        seed: 1,
    });
    robot.send(b"hello");
    let heard = pass_ms(&mut robot, 50);
    assert_ne!(heard, b"hello");
}

#[test]
fn damage_follows_from_a_seed() {
    let heard = |seed| {
        let mut robot = echo(RelaxSettings {
            seed,
            ..RelaxSettings::default()
        });
        robot.set_line_rates(FaultRates {
            bit_error: 0.01,
            ..FaultRates::NONE
        });
        robot.send(&[0x5A; 300]);
        let heard = pass_ms(&mut robot, 200);
        (heard, robot.state_hash())
    };
    assert_eq!(heard(1), heard(1));
    assert_ne!(heard(1), heard(2));
    assert_ne!(heard(1).0, [0x5A; 300]);
}

/// A dead host takes its unsent bytes along; a reset is no end.
#[test]
fn hosts_and_chips_can_die() {
    let mut robot = echo(RelaxSettings::default());
    assert_eq!(robot.send(&[0x41; 5000]), 4096);
    assert_eq!(robot.line_room(), 0);
    robot.host_died();
    assert_eq!(pass_ms(&mut robot, 20), b"");
    robot.reset(ResetCause::Watchdog);
    assert_eq!(robot.resets(), 1);
    pass_ms(&mut robot, 2);
    assert_eq!(talk(&mut robot, b"again"), b"again");
}

/// A program that holds its line low says nothing.
#[test]
fn a_held_line_is_silent() {
    let mut held = robot(&program(
        &[(0xB0, 0xFD)],
        &program(&SETUP, &program(&[(0x99, 0x41)], &STAY)),
    ));
    assert_eq!(pass_ms(&mut held, 20), b"");
}

#[test]
fn a_held_line_carries_later_and_a_cut_one_never() {
    let mut robot = echo(RelaxSettings::default());
    robot.hold_line(10);
    robot.send(b"x");
    assert_eq!(pass_ms(&mut robot, 10), b"");
    assert_eq!(pass_ms(&mut robot, 3), b"x");
    robot.cut_line(10);
    robot.send(b"y");
    assert_eq!(pass_ms(&mut robot, 13), b"");
    assert_eq!(talk(&mut robot, b"z"), b"z");
}
