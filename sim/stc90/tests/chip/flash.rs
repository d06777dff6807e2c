//! Data flash through the registers ISP_*.

use crate::rig::{after, machine, set};
use stc90::machine::Machine;
use stc90::peripheral::Misuse;

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
    while usize::from(machine.cpu().pc()) < program.len() {
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

/// The program keeps its flash over a reset.
#[test]
fn a_reset_erases_nothing() {
    let (mut machine, _) = run(&operation(2, 0xF7FF, 1));
    machine.reset(stc90::peripheral::ResetSource::PowerOn);
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
