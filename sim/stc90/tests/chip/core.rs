//! What the core does that uCsim does not, or otherwise.

use crate::rig::{STAY, after, machine, ram};
use stc90::cpu::CoreFault;
use stc90::peripheral::Misuse;

/// INC AUXR1 changes between the two DPTRs and leaves the free flag alone.
#[test]
fn there_are_two_data_pointers() {
    let program = [
        0x90, 0x12, 0x34, // MOV DPTR, #0x1234
        0x05, 0xA2, // INC AUXR1
        0x90, 0x56, 0x78, // MOV DPTR, #0x5678
        0x05, 0xA2, // INC AUXR1
        0xA3, // INC DPTR
    ];
    let mut machine = machine(&[(0, &program)]);
    for _ in 0..3 {
        machine.step();
    }
    assert_eq!((machine.cpu().dptr(), machine.register(0xA2)), (0x5678, 1));
    machine.step();
    machine.step();
    assert_eq!((machine.cpu().dptr(), machine.register(0xA2)), (0x1235, 0));
    assert_eq!([machine.register(0x82), machine.register(0x83)], [0x35, 0x12]);
}

#[test]
fn a_bit_changes_the_register_bank() {
    // SETB RS1; MOV R0, #0x99; CLR RS1; MOV R0, #0x11
    let mut machine = machine(&[(0, &[0xD2, 0xD4, 0x78, 0x99, 0xC2, 0xD4, 0x78, 0x11])]);
    machine.run_until(4);
    assert_eq!([ram(&machine, 0x10), ram(&machine, 0)], [0x99, 0x11]);
}

#[test]
fn parity_is_that_of_the_accumulator() {
    // MOV A, #7; MOV PSW, #0; MOV 0x30, PSW
    let mut machine = machine(&[(0, &[0x74, 7, 0x75, 0xD0, 0, 0x85, 0xD0, 0x30])]);
    machine.run_until(5);
    assert_eq!(ram(&machine, 0x30), 1);
}

#[test]
fn faults_are_recorded_once_with_their_place() {
    let program = after(
        &[(0x81, 0xFE)],
        &[
            0xA5, // reserved
            0xC0, 0xE0, 0xC0, 0xE0, 0xC0, 0xE0, // PUSH ACC, three times: the second wraps
            0x90, 0x80, 0x00, 0x93, 0x93, // MOV DPTR, #0x8000; MOVC twice
            0x02, 0x80, 0x00, // LJMP 0x8000
        ],
    );
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(1000);
    let found: Vec<(Misuse, u16, bool)> = machine
        .misuses()
        .iter()
        .map(|record| (record.misuse, record.pc, record.count > 1))
        .collect();
    let expected = [
        (Misuse::Core(CoreFault::ReservedInstruction), 3, true),
        (Misuse::Core(CoreFault::StackWrapped), 6, false),
        (Misuse::Core(CoreFault::DataBeyondFlash), 13, true),
    ];
    assert_eq!(found, expected);
    assert_eq!(ram(&machine, 0), 0);
    assert!(machine.cpu().pc() > 0x8000);
}

#[test]
fn the_highest_stack_pointer_is_kept() {
    // LCALL 6; SJMP; PUSH ACC; POP ACC; RET
    let program = [0x12, 0, 6, 0x80, 0xFE, 0, 0xC0, 0xE0, 0xD0, 0xE0, 0x22];
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(20);
    assert_eq!((machine.cpu().sp(), machine.cpu().sp_max()), (7, 10));
    assert_eq!(machine.cpu().pc(), 3);
}

#[test]
fn passes_of_a_loop_are_counted() {
    // INC A; NOP; SJMP back: four cycles
    let mut machine = machine(&[(0, &[0x04, 0x00, 0x80, 0xFC])]);
    machine.cpu_mut().count_passes(1);
    machine.run_until(4_000);
    assert_eq!(machine.cpu().passes(), 1_000);
}

#[test]
fn a_second_is_five_million_cycles_in_the_relax() {
    let machine = machine(&[(0, &STAY)]);
    assert_eq!(machine.cycles_per_s(), 5e6);
}
