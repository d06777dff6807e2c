//! Ports as latches and levels.

use crate::rig::{STAY, after, edge, machine, pin, ram};
use stc90::pins::{Level, Levels};

/// An instruction that writes a port back reads its latch; any other its pins.
#[test]
fn latches_and_pins_are_told_apart() {
    // INC P1; MOV 0x30, P1; MOV C, P1.0 into 0x20.0; SETB P1.7
    let program = after(
        &[(0x90, 0x7F)],
        &[
            0x05, 0x90, 0x85, 0x90, 0x30, 0xA2, 0x90, 0x92, 0x00, 0xD2, 0x97, 0x80, 0xFE,
        ],
    );
    let mut machine = machine(&[(0, &program)]);
    machine.set_input(pin("P1.7"), Level::Low);
    machine.set_input(pin("P1.0"), Level::Low);
    machine.run_until(20);
    assert_eq!(machine.outputs().0[1], 0x80);
    assert_eq!(ram(&machine, 0x30), 0);
    assert_eq!(ram(&machine, 0x20) & 1, 0);
    assert_eq!(machine.level(pin("P1.7")), Level::Low);
    machine.set_input(pin("P1.7"), Level::High);
    assert_eq!(machine.level(pin("P1.7")), Level::High);
}

#[test]
fn all_ports_are_high_after_a_reset() {
    let mut machine = machine(&[(0, &STAY)]);
    machine.run_until(10);
    assert_eq!(machine.outputs(), Levels::HIGH);
    assert_eq!(machine.levels(), Levels::HIGH);
}

/// A square wave by CPL: an edge every three cycles, none of a pin that nobody watches.
#[test]
fn watched_pins_tell_their_edges() {
    // CPL P2.3; CPL P2.4; SJMP
    let mut machine = machine(&[(0, &[0xB2, 0xA3, 0xB2, 0xA4, 0x80, 0xFA])]);
    machine.watch(pin("P2.3"));
    machine.run_until(12);
    let edges = machine.take_edges();
    let expected = [
        edge(1, "P2.3", Level::Low),
        edge(5, "P2.3", Level::High),
        edge(9, "P2.3", Level::Low),
    ];
    assert_eq!(edges, expected);
    assert_eq!(machine.take_edges(), []);
}

/// P4 is at 0xE8 and can be addressed bit by bit.
#[test]
fn there_is_a_fifth_port() {
    let mut machine = machine(&[(0, &[0xC2, 0xE9, 0x80, 0xFE])]);
    machine.run_until(5);
    assert_eq!(machine.outputs().0, [0xFF, 0xFF, 0xFF, 0xFF, 0xFD]);
}

#[test]
fn all_inputs_can_be_set_at_once() {
    let mut machine = machine(&[(0, &after(&[(0x90, 0xF0)], &STAY))]);
    machine.run_until(4);
    machine.set_inputs(Levels([0xFF, 0x3C, 0, 0xFB, 0xFF]));
    assert_eq!(machine.levels().0, [0xFF, 0x30, 0, 0xFB, 0xFF]);
    // INT0 is low: its flag follows.
    assert_eq!(machine.register(0x88) & 2, 2);
    machine.set_inputs(Levels::HIGH);
    assert_eq!(machine.levels(), machine.outputs());
    assert_eq!(machine.register(0x88) & 2, 0);
}

#[test]
fn inputs_change_in_their_cycle() {
    // MOV A, P0; JNZ back: leaves when P0 is low. MOV 0x30, TL0
    let program = after(
        &[(0x89, 1), (0x88, 0x10)],
        &[0xE5, 0x80, 0x70, 0xFC, 0x85, 0x8A, 0x30, 0x80, 0xFE],
    );
    let mut machine = machine(&[(0, &program)]);
    for bit in 0..8 {
        machine.schedule_input(edge(100, &format!("P0.{bit}"), Level::Low));
    }
    machine.run_until(200);
    let seen = u64::from(ram(&machine, 0x30)) + 3;
    assert!((101..107).contains(&seen), "{seen}");
}
