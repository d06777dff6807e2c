//! The serial line as levels on pins, and that runs repeat themselves.

use pic32::board::EmulatedSettings;
use pic32::board::serial::HostRate;
use rvac_channel::FaultRates;

use crate::program::{NOP, T0, T1, T2, branch, li, lw, store, sw};
use crate::rig::{AD1PCFG, LAT, PORT, TRISB, TRISC, pass_ms, robot_with, stores, world};

/// Copies RC13 (from the host) to RB7 (to the host), for ever.
fn echo() -> Vec<u32> {
    let srl = |to: u32, from: u32, by: u32| from << 16 | to << 11 | by << 6 | 2;
    let andi = |to: u32, from: u32, value: u32| 0x3000_0000 | from << 21 | to << 16 | value;
    let mut code = stores(&[
        (AD1PCFG, 0xFFFF),
        (TRISB + LAT, 1 << 7),
        (TRISB, 0xFFFF & !(1 << 7)),
    ]);
    code.extend(li(T0, TRISC + PORT));
    code.extend(li(T2, TRISB + LAT));
    let body = [
        lw(T1, 0, T0),
        NOP,
        srl(T1, T1, 6),
        andi(T1, T1, 1 << 7),
        sw(T1, 0, T2),
    ];
    code.extend(body);
    code.extend([branch(-(body.len() as i16) - 1), NOP]);
    code
}

fn settings(rate: HostRate, seed: u64) -> EmulatedSettings {
    EmulatedSettings {
        rate,
        seed,
        ..EmulatedSettings::default()
    }
}

/// What comes back of `sent`, at this rate.
fn echoed(rate: HostRate, seed: u64, faults: FaultRates, sent: &[u8]) -> Vec<u8> {
    let mut robot = robot_with(&echo(), world(None), &settings(rate, seed));
    pass_ms(&mut robot, 2);
    robot.set_line_rates(faults);
    let mut heard = Vec::new();
    for chunk in sent.chunks(64) {
        robot.send(chunk);
        heard.extend(pass_ms(&mut robot, 20));
    }
    heard.extend(pass_ms(&mut robot, 50));
    heard
}

#[test]
fn bytes_come_back_through_both_pins_at_every_rate_and_off_by_two_percent() {
    let sent: Vec<u8> = (0..=255).rev().collect();
    for baud in [9_600, 38_400, 115_200, 230_400] {
        for error_permille in [-20.0, 0.0, 20.0] {
            let rate = HostRate { baud, error_permille };
            let wait = if baud == 9_600 { &sent[..32] } else { &sent[..] };
            assert_eq!(echoed(rate, 1, FaultRates::NONE, wait), wait, "{rate:?}");
        }
    }
}

#[test]
fn flipped_bits_lost_and_doubled_bytes_are_of_the_line() {
    let rate = HostRate::exact(115_200);
    let sent = vec![b'x'; 2048];
    let count = |faults: FaultRates| {
        let heard = echoed(rate, 5, faults, &sent);
        (heard.len(), heard.iter().filter(|byte| **byte != b'x').count())
    };
    let bit_error = FaultRates {
        bit_error: 1e-3,
        ..FaultRates::NONE
    };
    let (_, wrong) = count(bit_error);
    assert!(wrong > 10, "{wrong} wrong bytes");
    let lost = FaultRates {
        lost_byte: 0.05,
        ..FaultRates::NONE
    };
    let (length, wrong) = count(lost);
    // Both ways lose 5 %.
    assert!((1_780..1_900).contains(&length) && wrong == 0, "{length} {wrong}");
    let doubled = FaultRates {
        doubled_byte: 0.05,
        ..FaultRates::NONE
    };
    assert!(count(doubled).0 > 2_150);
}

#[test]
fn a_held_line_is_late_and_a_cut_one_silent() {
    let mut robot = robot_with(&echo(), world(None), &settings(HostRate::exact(115_200), 1));
    pass_ms(&mut robot, 2);
    robot.hold_line(20);
    robot.send(b"late");
    assert_eq!(pass_ms(&mut robot, 15), b"");
    assert_eq!(pass_ms(&mut robot, 15), b"late");
    robot.cut_line(20);
    robot.send(b"lost");
    assert_eq!(pass_ms(&mut robot, 40), b"");
    robot.send(b"x");
    robot.host_died();
    assert_eq!(robot.line_room(), 4096);
}

#[test]
fn a_chip_that_does_not_drive_its_line_yet_says_nothing() {
    let mut robot = robot_with(
        &[store(0xA000_0000, 1), crate::program::FOREVER.to_vec()].concat(),
        world(None),
        &settings(HostRate::exact(115_200), 1),
    );
    assert_eq!(pass_ms(&mut robot, 50), b"");
}

#[test]
fn the_same_seed_is_the_same_run() {
    let hash = |seed| {
        let mut robot = robot_with(&echo(), world(None), &settings(HostRate::exact(115_200), seed));
        robot.set_line_rates(FaultRates {
            bit_error: 1e-2,
            ..FaultRates::NONE
        });
        for _ in 0..20 {
            robot.send(b"once more");
            pass_ms(&mut robot, 10);
        }
        robot.state_hash()
    };
    assert_eq!(hash(1), hash(1));
    assert_ne!(hash(1), hash(2));
}
