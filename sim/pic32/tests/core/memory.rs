//! The map of memory as the core sees it.

use crate::bench::{Bench, ERL, FLASH, NOP, RAM, REGISTER, RETURN, STATUS, bytes, immediate};
use pic32::cpu::{Access, Exit, Width};
use pic32::memory::{BOOT_START, FLASH_START, OutsideMemory, RAM_BYTES};

/// `lw $9, 0($1)`.
const LOAD: u32 = 0x8C29_0000;
/// `sw $8, 0($1)`.
const STORE: u32 = 0xAC28_0000;

fn loaded(address: u32, status: u32) -> Option<u32> {
    let mut bench = Bench::new(&[LOAD]);
    for (address, word) in [
        (0x10, 0x1111_1111_u32),
        (FLASH_START + 0x100, 0x2222_2222),
        (BOOT_START + 0x10, 0x3333_3333),
    ] {
        bench
            .memory
            .write(address, &word.to_le_bytes())
            .expect("it is memory");
    }
    bench.bus.value = 0x4444_4444;
    bench.set(STATUS, status);
    bench.cpu.set_register(1, address);
    (bench.step() == Exit::Reached).then(|| bench.cpu.register(9))
}

#[test]
fn each_memory_is_where_it_belongs() {
    let cases = [
        (0x8000_0010, Some(0x1111_1111)),
        (0xA000_0010, Some(0x1111_1111)),
        (0x8000_7FFC, Some(0)),
        (0x8000_8000, None),
        (0x9D00_0100, Some(0x2222_2222)),
        (0xBD00_0100, Some(0x2222_2222)),
        (0x9D03_FFFC, Some(u32::MAX)),
        (0x9D04_0000, None),
        (0xBFC0_0010, Some(0x3333_3333)),
        (0x9FC0_0010, Some(0x3333_3333)),
        (0xBFC0_2FFC, Some(u32::MAX)),
        (0xBFC0_3000, None),
        (REGISTER, Some(0x4444_4444)),
        (0x0000_0010, None),
        (0x1D00_0100, None),
        (0xC000_0010, None),
        (0xFFFF_FFFC, None),
    ];
    for (address, expected) in cases {
        assert_eq!(loaded(address, 0), expected, "{address:x}");
    }
}

#[test]
fn at_error_level_the_lower_half_is_physical_memory() {
    let cases = [
        (0x0000_0010, Some(0x1111_1111)),
        (0x1D00_0100, Some(0x2222_2222)),
        (0x1FC0_0010, Some(0x3333_3333)),
        (0x1F80_0600, Some(0x4444_4444)),
        (0x4000_0010, None),
    ];
    for (address, expected) in cases {
        assert_eq!(loaded(address, ERL), expected, "{address:x}");
    }
}

#[test]
fn registers_hear_what_is_done_to_them() {
    let words = [
        immediate(0x24, 9, 1, 1),
        immediate(0x29, 8, 1, 2),
        NOP,
        immediate(0x2B, 8, 1, 0),
        immediate(0x23, 9, 1, 0),
    ];
    let mut bench = Bench::new(&words);
    bench.cpu.set_register(1, REGISTER);
    bench.cpu.set_register(8, 0xAABB_CCDD);
    bench.bus.value = 0x11;
    while bench.bus.accesses.len() < 4 {
        bench.step();
    }
    let access = |offset: u32, width, cycle, index: u32| Access {
        address: 0x1F80_0600 + offset,
        width,
        cycle,
        pc: FLASH + 4 * index,
    };
    let expected = vec![
        (access(1, Width::Byte, 0, 0), None),
        (access(2, Width::Half, 3, 1), Some(0xCCDD)),
        (access(0, Width::Word, 5, 3), Some(0xAABB_CCDD)),
        (access(0, Width::Word, 6, 4), None),
    ];
    assert_eq!(bench.bus.accesses, expected);
    assert_eq!(bench.cpu.register(9), 0xAABB_CCDD);
}

#[test]
fn a_store_may_move_the_horizon_to_itself() {
    let mut bench = Bench::new(&[STORE, NOP, NOP]);
    bench.cpu.set_register(1, REGISTER);
    bench.bus.horizon_after_store = Some(0);
    assert_eq!(bench.run(100), Exit::Horizon);
    assert_eq!((bench.cpu.pc(), bench.cpu.cycle()), (FLASH + 4, 1));
}

#[test]
fn ram_is_executed_only_where_the_bus_matrix_allows() {
    let code = [immediate(9, 2, 0, 7), RETURN, immediate(9, 2, 2, 1)];
    for (allowed, address, expected) in [
        (0x1000..0x2000, 0x1000, 8),
        (0x1000..0x2000, 0x0FF8, 0),
        (0x1000..0x1008, 0x1000, 7),
        (0..0, 0x1000, 0),
    ] {
        let mut bench = Bench::new(&[NOP]);
        bench.memory.write(address, &bytes(&code)).unwrap();
        bench.memory.set_ram_code(allowed.clone());
        bench.cpu.set_register(31, FLASH);
        bench.cpu.set_pc(RAM | address);
        bench.run(3);
        assert_eq!(bench.cpu.register(2), expected, "{address:x} in {allowed:x?}");
    }
}

#[test]
fn a_loop_of_two_instructions_in_ram_goes_round() {
    // bne $2, $0, to itself; its slot counts down.
    let code = [immediate(5, 0, 2, 0xFFFF), immediate(9, 2, 2, 0xFFFF), NOP];
    let mut bench = Bench::new(&[NOP]);
    bench.memory.set_ram_code(0x800..0x8000);
    bench.memory.write(0x1000, &bytes(&code)).unwrap();
    bench.cpu.set_register(2, 3);
    bench.cpu.set_pc(RAM | 0x1000);
    bench.run(8);
    assert_eq!((bench.cpu.register(2), bench.cpu.pc()), (u32::MAX, RAM | 0x1008));
}

#[test]
fn code_in_ram_can_change_itself() {
    // sw $8, 4($1), then what was written.
    let mut bench = Bench::new(&[NOP]);
    bench.memory.set_ram_code(0x800..0x8000);
    bench.memory.write(0x1000, &bytes(&[STORE | 4, NOP])).unwrap();
    bench.cpu.set_register(1, 0xA000_1000);
    bench.cpu.set_register(8, immediate(9, 2, 0, 99));
    bench.cpu.set_pc(RAM | 0x1000);
    bench.run(2);
    assert_eq!(bench.cpu.register(2), 99);
}

#[test]
fn what_is_programmed_into_flash_is_executed() {
    let mut bench = Bench::new(&[NOP, NOP]);
    let other = bench.clone();
    bench
        .memory
        .write(FLASH_START + 4, &bytes(&[immediate(9, 2, 0, 5)]))
        .unwrap();
    bench.run(2);
    assert_eq!(bench.cpu.register(2), 5);
    // A clone keeps what it had.
    let mut other = other;
    other.run(2);
    assert_eq!(other.cpu.register(2), 0);
}

#[test]
fn what_lies_outside_is_neither_read_nor_written() {
    let mut bench = Bench::new(&[NOP]);
    for (address, length) in [
        (RAM_BYTES as u32 - 2, 4),
        (RAM_BYTES as u32, 1),
        (FLASH_START - 1, 2),
        (FLASH_START + 0x4_0000, 1),
        (BOOT_START + 0x2FFF, 2),
        (u32::MAX, 1),
    ] {
        let outside = Err(OutsideMemory { address, length });
        assert_eq!(bench.memory.read(address, &mut vec![0; length]), outside);
        assert_eq!(bench.memory.write(address, &vec![0; length]), outside);
    }
}

#[test]
fn the_deepest_stack_is_remembered() {
    // Two functions deep, then back, then a little deeper than nothing.
    let grow = |bytes: i16| immediate(9, 29, 29, bytes as u32);
    let mut bench = Bench::new(&[grow(-32), grow(-64), grow(64), grow(32), grow(-8)]);
    assert_eq!(bench.cpu.deepest_stack(), None);
    bench.cpu.set_register(29, 0x8000_8000);
    bench.run(5);
    assert_eq!(
        (bench.cpu.register(29), bench.cpu.deepest_stack()),
        (0x8000_7FF8, Some(0x8000_7FA0))
    );
    bench.cpu.clear_deepest_stack();
    assert_eq!(bench.cpu.deepest_stack(), None);
}
