//! Data flash through the registers ISP_*.

use crate::rig::{after, machine, set};
use stc90::machine::Machine;
use stc90::peripheral::{LineFrame, Misuse, ResetSource};

const DATA: u8 = 0xE2;
const HIGH: u8 = 0xE3;
const LOW: u8 = 0xE4;
const COMMAND: u8 = 0xE5;
const TRIGGER: u8 = 0xE6;
const CONTROL: u8 = 0xE7;
const START: [(u8, u8); 2] = [(TRIGGER, 0x46), (TRIGGER, 0xB9)];

fn operation(command: u8, address: u16, data: u8) -> Vec<u8> {
    let [high, low] = address.to_be_bytes();
    let mut pairs = vec![
        (CONTROL, 0x80),
        (DATA, data),
        (HIGH, high),
        (LOW, low),
        (COMMAND, command),
    ];
    pairs.extend(START);
    set(&pairs)
}

/// The cycles that a program takes to its end, without its moves.
fn run(program: &[u8]) -> (Machine, u64) {
    let mut machine = machine(&[(0, program)]);
    while usize::from(machine.cpu().pc()) < program.len() || machine.is_stalled() {
        machine.step();
    }
    let moves = program.len() as u64 / 3 * 2;
    let waited = machine.cycle() - moves;
    (machine, waited)
}

#[test]
fn bytes_are_written_read_and_erased() {
    let mut program = operation(2, 0x8123, 0x5A);
    program.extend(operation(2, 0x8123, 0xF0));
    program.extend(operation(1, 0x8123, 0));
    let (machine, waited) = run(&program);
    // Writing clears bits only.
    assert_eq!(machine.register(DATA), 0x50);
    assert_eq!(machine.data_flash()[0x123], 0x50);
    assert_eq!(waited, 240 + 240 + 43);

    program.extend(operation(2, 0x8200, 0));
    program.extend(operation(3, 0x81FF, 0));
    let (machine, _) = run(&program);
    assert_eq!(machine.data_flash()[0x123], 0xFF);
    assert_eq!(machine.data_flash()[0x200], 0);
    assert_eq!(machine.misuses(), []);
}

/// While the core waits, time passes in pieces like any other, and the UART hears on.
#[test]
fn an_erasure_can_be_watched() {
    let mut program = set(&[(0xCB, 0xFF), (0xCA, 0xCF), (0xC8, 0x34), (0x98, 0x50)]);
    program.extend(operation(3, 0x8000, 0));
    program.extend([0x04, 0x80, 0xFD]);
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(1_000);
    assert!(machine.is_stalled());
    assert_eq!((machine.cycle(), machine.cpu().a()), (1_000, 0));
    machine.hear(LineFrame::byte(1_100, 784, 0x5A));
    machine.run_until(40_000);
    assert_eq!((machine.register(0x99), machine.register(0x98)), (0x5A, 0x55));
    machine.run_until(44_000);
    assert!(!machine.is_stalled() && machine.cpu().a() > 0);
}

/// The watchdog does not wait for the flash.
#[test]
fn an_erasure_can_be_too_long_for_the_watchdog() {
    // A loop of 32,960 cycles, then an erasure of 43,769: together more than 65,536.
    let mut program = set(&[(0xE1, 0x30)]);
    program.extend([0x7F, 0x40, 0x7E, 0x00, 0xDE, 0xFE, 0xDF, 0xFA]);
    program.extend(operation(3, 0x8000, 0));
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(40_000);
    assert!(machine.is_stalled());
    machine.run_until(67_000);
    let [event] = machine.resets() else {
        panic!("{:?}", machine.resets());
    };
    assert_eq!((event.source, event.cycle), (ResetSource::Watchdog, 1 + 65_536));
}

/// The program keeps its flash over a reset.
#[test]
fn a_reset_erases_nothing() {
    let (mut machine, _) = run(&operation(2, 0xF7FF, 1));
    machine.reset(ResetSource::PowerOn);
    assert_eq!(machine.data_flash().last(), Some(&1));
}

#[test]
fn wrong_operations_change_nothing() {
    let (machine, _) = run(&operation(3, 0x7FFF, 0));
    assert_eq!(machine.misuses()[0].misuse, Misuse::FlashAddress(0x7FFF));
    let (machine, _) = run(&operation(2, 0xF800, 0));
    assert_eq!(machine.misuses()[0].misuse, Misuse::FlashAddress(0xF800));
    let (machine, _) = run(&operation(7, 0x8000, 0));
    assert_eq!(machine.misuses()[0].misuse, Misuse::FlashCommand(7));
    let (machine, _) = run(&set(&START));
    assert_eq!(machine.misuses()[0].misuse, Misuse::FlashNotEnabled);
    // The trigger must be written without anything in between.
    let torn = after(
        &[
            (CONTROL, 0x80),
            (HIGH, 0x80),
            (COMMAND, 2),
            (DATA, 0),
            (TRIGGER, 0x46),
        ],
        &set(&[(DATA, 0), (TRIGGER, 0xB9)]),
    );
    let (machine, _) = run(&torn);
    assert!(machine.data_flash().iter().all(|byte| *byte == 0xFF));
}
