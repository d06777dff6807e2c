//! External memory: 1,024 bytes on the chip, and nothing beyond.

use crate::rig::machine;
use stc90::cpu::External;
use stc90::peripheral::Misuse;

/// MOV DPTR, #address; MOVX @DPTR, A; CLR A; MOVX A, @DPTR
fn round_trip(high: u8, low: u8) -> Vec<u8> {
    vec![0x74, 0x5A, 0x90, high, low, 0xF0, 0xE4, 0xE0]
}

#[test]
fn it_ends_after_a_kilobyte() {
    let mut inside = machine(&[(0, &round_trip(3, 0xFF))]);
    inside.run_until(9);
    assert_eq!((inside.cpu().a(), inside.xram()[0x3FF]), (0x5A, 0x5A));
    assert_eq!(inside.misuses(), []);

    let mut outside = machine(&[(0, &round_trip(4, 0))]);
    outside.run_until(9);
    assert_eq!(outside.cpu().a(), 0xFF);
    let [record] = outside.misuses() else {
        panic!("{:?}", outside.misuses());
    };
    assert_eq!(record.misuse, Misuse::ExternalBus(External::Long(0x400)));
    assert_eq!((record.pc, record.count), (5, 2));
}

/// EXTRAM hands all addresses to the pins.
#[test]
fn it_can_be_switched_off() {
    let mut program = vec![0x75, 0x8E, 0x02];
    program.extend(round_trip(0, 0));
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(11);
    assert_eq!((machine.cpu().a(), machine.xram()[0]), (0xFF, 0));
    assert_eq!(
        machine.misuses()[0].misuse,
        Misuse::ExternalBus(External::Long(0))
    );
}

/// P2 drives motors and lamps, so it says nothing about an address.
#[test]
fn short_addresses_do_not_depend_on_a_port() {
    // MOV P2, #3; MOV R1, #0x10; MOV A, #7; MOVX @R1, A
    let mut machine = machine(&[(0, &[0x75, 0xA0, 3, 0x79, 0x10, 0x74, 7, 0xF3])]);
    machine.run_until(6);
    assert_eq!((machine.xram()[0x10], machine.xram()[0x310]), (7, 0));
    assert_eq!(machine.outputs().0[2], 3);
}
