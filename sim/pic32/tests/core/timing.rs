//! The model of time: cycles of sequences.

use crate::bench::{Bench, ERET, FLASH, NOP, RAM, REGISTER, SYSCALL, bytes, immediate, special};
use pic32::memory::{FlashTiming, Prefetch};

/// `lw $9, 0($1)` with the address of RAM.
const LOAD: u32 = 0x8C29_0000;

fn cycles(words: &[u32], base: u32) -> u64 {
    let mut bench = Bench::new(words);
    bench.cpu.set_register(1, base);
    bench.cpu.set_register(2, 0x0001_0000);
    bench.cpu.set_register(3, 5);
    let end = FLASH + 4 * words.len() as u32;
    while bench.cpu.pc() != end {
        bench.step();
    }
    bench.cpu.cycle()
}

#[test]
fn sequences_take_what_the_table_says() {
    let div = |register| special(0x1A, 0, register, 3);
    let (mflo, mfhi) = (special(0x12, 9, 0, 0), special(0x10, 9, 0, 0));
    let mult = |register| special(0x18, 0, 3, register);
    let use_loaded = special(0x21, 10, 9, 0);
    let cases: [(&str, &[u32], u32, u64); 17] = [
        ("plain", &[NOP, NOP, NOP], RAM, 3),
        ("load, not used", &[LOAD, NOP, use_loaded], RAM, 3),
        ("load, used", &[LOAD, use_loaded], RAM, 3),
        ("load, stored", &[LOAD, immediate(0x2B, 9, 1, 4)], RAM, 3),
        ("load in a slot", &[0x1000_0001, LOAD, use_loaded], RAM, 3),
        ("store", &[immediate(0x2B, 9, 1, 0), NOP], RAM, 2),
        ("read of a register", &[LOAD, NOP], REGISTER, 4),
        (
            "write of a register",
            &[immediate(0x2B, 9, 1, 0), NOP],
            REGISTER,
            2,
        ),
        (
            "part of a register",
            &[immediate(0x2A, 9, 1, 2), NOP],
            REGISTER,
            2,
        ),
        ("taken branch", &[0x1000_0001, NOP, NOP], RAM, 3),
        ("short product", &[mult(3), mflo], RAM, 1 + 1),
        ("long product", &[mult(2), mflo], RAM, 1 + 2),
        ("product, read late", &[mult(2), NOP, NOP, mflo], RAM, 4),
        ("products in a row", &[mult(2), mult(2), mfhi], RAM, 1 + 2 + 2),
        ("division of a byte", &[div(3), mflo], RAM, 1 + 12),
        ("division of 24 bits", &[div(2), mflo], RAM, 1 + 26),
        ("mul", &[special(2, 9, 3, 2) | 0x1C << 26, NOP], RAM, 2 + 2),
    ];
    for (name, words, base, expected) in cases {
        assert_eq!(cycles(words, base), expected, "{name}");
    }
}

/// Cycles of a loop: `length` instructions with a branch back at the end, executed `rounds` times.
fn of_loop(length: u32, rounds: u64, timing: FlashTiming) -> u64 {
    let mut words = vec![NOP; length as usize];
    let place = words.len() - 2;
    words[place] = immediate(4, 0, 0, 0_u32.wrapping_sub(length - 1));
    let mut bench = Bench::new(&words);
    bench.memory.set_flash_timing(timing);
    for _ in 0..rounds * u64::from(length) - rounds {
        bench.step();
    }
    assert_eq!(bench.cpu.pc(), FLASH);
    bench.cpu.cycle()
}

#[test]
fn flash_is_hidden_by_the_prefetch_unit_or_not() {
    let timing = |wait_states, prefetch| FlashTiming {
        wait_states,
        prefetch,
    };
    let both = timing(2, Prefetch::Both);
    // The first line misses, jumps to it hit.
    assert_eq!(of_loop(16, 10, both), 160 + 2);
    assert_eq!(of_loop(64, 10, both), 640 + 2);
    // 17 lines do not fit.
    assert_eq!(of_loop(68, 10, both), 680 + 2 + 20);
    assert_eq!(of_loop(16, 10, timing(2, Prefetch::Cached)), 160 + 2);
    assert_eq!(of_loop(16, 10, timing(2, Prefetch::Uncached)), 480);
    assert_eq!(of_loop(16, 10, timing(7, Prefetch::Off)), 1280);
    assert_eq!(of_loop(16, 10, timing(0, Prefetch::Off)), 160);
}

#[test]
fn a_load_waits_when_what_needs_it_is_programmed_behind_it() {
    let mut bench = Bench::new(&[LOAD, NOP]);
    bench.cpu.set_register(1, RAM);
    let using = special(0x21, 10, 9, 0);
    bench
        .memory
        .write(0x1D00_0004, &bytes(&[using]))
        .expect("it is flash");
    bench.step();
    assert_eq!(bench.cpu.cycle(), 2);
}

#[test]
fn a_handler_waits_for_its_line() {
    let mut bench = Bench::new(&[SYSCALL]);
    bench
        .memory
        .write(0x1D01_0180, &bytes(&[ERET, NOP]))
        .expect("it is flash");
    bench.memory.set_flash_timing(FlashTiming {
        wait_states: 2,
        prefetch: Prefetch::Both,
    });
    // Two for the line of the first instruction; then the pipeline is filled again.
    bench.run(100);
    assert_eq!(bench.cpu.cycle(), 2 + 3);
    // The handler's line, its one instruction, the pipeline. The line that it returns to is there.
    bench.step();
    assert_eq!(bench.cpu.cycle(), 2 + 3 + 2 + 1 + 3);
    bench.run(1);
    assert_eq!(bench.cpu.cycle(), 2 + 3 + 2 + 1 + 3 + 3);
}

#[test]
fn loads_wait_for_their_memory() {
    let mut bench = Bench::new(&[LOAD, NOP]);
    bench.memory.set_ram_wait_states(1);
    bench.cpu.set_register(1, RAM);
    bench.step();
    assert_eq!(bench.cpu.cycle(), 2);
    for address in [FLASH, 0xBFC0_0000] {
        let mut bench = Bench::new(&[LOAD, NOP]);
        bench.memory.set_flash_timing(FlashTiming {
            wait_states: 2,
            prefetch: Prefetch::Both,
        });
        bench.cpu.set_register(1, address);
        bench.step();
        // Two for the line of the instruction itself.
        assert_eq!(bench.cpu.cycle(), 2 + 3, "{address:x}");
    }
}

#[test]
fn it_does_not_matter_in_which_pieces_time_is_run() {
    let words = [
        LOAD,
        special(0x21, 10, 9, 10),
        special(0x1A, 0, 10, 3),
        special(0x12, 11, 0, 0),
        immediate(0x2B, 11, 1, 0),
        immediate(4, 0, 0, 0_u32.wrapping_sub(6)),
        immediate(9, 3, 3, 1),
    ];
    let prepared = || {
        let mut bench = Bench::new(&words);
        bench.cpu.set_register(1, RAM);
        bench.memory.set_flash_timing(FlashTiming {
            wait_states: 2,
            prefetch: Prefetch::Both,
        });
        bench
    };
    let mut whole = prepared();
    whole.run(10_000);
    let mut pieces = prepared();
    while pieces.cpu.cycle() < whole.cpu.cycle() {
        let left = whole.cpu.cycle() - pieces.cpu.cycle();
        pieces.run(left.min(1 + pieces.cpu.cycle() % 7));
    }
    assert_eq!(format!("{:?}", pieces.cpu), format!("{:?}", whole.cpu));
    assert!(pieces.memory.ram() == whole.memory.ram());
}
