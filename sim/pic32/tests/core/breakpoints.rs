//! Breakpoints and single steps.

use crate::bench::{BRANCH, Bench, FLASH, NOP, RAM, bytes, immediate};
use pic32::cpu::Exit;

fn counted() -> Bench {
    Bench::new(&[
        immediate(9, 2, 2, 1),
        BRANCH,
        immediate(9, 2, 2, 2),
        NOP,
        immediate(9, 2, 2, 4),
        NOP,
    ])
}

#[test]
fn a_breakpoint_stops_before_its_instruction_until_it_is_taken_away() {
    let mut bench = counted();
    bench.memory.set_breakpoint(0x1D00_0010).unwrap();
    for _ in 0..2 {
        assert_eq!(bench.run(100), Exit::Breakpoint);
        assert_eq!(
            (bench.cpu.pc(), bench.cpu.register(2), bench.cpu.cycle()),
            (FLASH + 16, 3, 3)
        );
    }
    bench.memory.clear_breakpoint(0x1D00_0010).unwrap();
    assert_eq!(bench.run(1), Exit::Reached);
    assert_eq!(bench.cpu.register(2), 7);
}

#[test]
fn a_breakpoint_survives_programming_and_can_stand_in_ram() {
    let mut bench = counted();
    bench.memory.set_breakpoint(0x1D00_0000).unwrap();
    bench.memory.write(0x1D00_0000, &bytes(&[NOP])).unwrap();
    assert_eq!(bench.run(1), Exit::Breakpoint);
    bench.memory.set_ram_code(0..0x8000);
    bench.memory.set_breakpoint(0x1004).unwrap();
    bench.cpu.set_pc(RAM | 0x1000);
    assert_eq!(bench.run(100), Exit::Breakpoint);
    assert_eq!(bench.cpu.pc(), RAM | 0x1004);
    assert!(bench.memory.set_breakpoint(0x8000).is_err());
}

#[test]
fn a_step_takes_the_delay_slot_along() {
    let mut bench = counted();
    let mut places = Vec::new();
    for _ in 0..3 {
        assert_eq!(bench.step(), Exit::Reached);
        places.push(bench.cpu.pc() - FLASH);
    }
    assert_eq!(places, [4, 16, 20]);
    assert_eq!(bench.cpu.register(2), 7);
}
