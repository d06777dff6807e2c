//! The core against qemu-user, instruction by instruction.
//!
//! Random programs (from a seed) of all instructions that user mode has, with delay slots, unaligned accesses and jumps,
//! run as processes under `qemu-mipsel-static` and in the emulator. After every few instructions all registers, HI, LO and
//! the memory that the program can reach are written out and must be equal. The same for compiled code.
//!
//! What is undefined is left out: overflow of HI and LO after `mul` is not (both leave them alone), division by zero,
//! links into the register that a branch reads, `sc` without `ll` just before it on the same word.

mod block;
mod chip;
mod compiled;
mod coverage;
mod dump;
mod encode;
mod image;
mod interrupts;
mod numbers;
mod process;
mod program;

use block::Kind;
use chip::DataPlace;
use numbers::Numbers;
use program::{BLOCK_INSTRUCTIONS, Program};

/// Blocks of each program: together about 10^5 random instructions, each a few times where there are loops.
const BLOCKS: usize = 1100;
/// Where the emulated program finds its data: through KSEG0 and KSEG1, which the inner loop does, and at error level through
/// KUSEG, which it does not.
const PLACES: [DataPlace; 3] = [DataPlace::Cached, DataPlace::Uncached, DataPlace::Physical];

/// Runs programs in both and compares.
fn compare(seeds: std::ops::Range<u64>) {
    let Some(qemu) = process::Qemu::find() else {
        return;
    };
    let mut instructions = 0;
    for seed in seeds {
        let program = Program::random(seed, BLOCKS, Kind::Process);
        instructions += program.blocks.len() * BLOCK_INSTRUCTIONS;
        let expected = qemu.run(&image::process(&program));
        let place = PLACES[seed as usize % PLACES.len()];
        let mut strides = Numbers::new(seed);
        let found = chip::run(&program, place, || u64::from(strides.below(40)) + 1);
        dump::assert_equal(&program, seed, (&found, &expected));
    }
    println!("{instructions} random instructions agree");
}

#[test]
fn random_programs_end_alike() {
    compare(0..6);
}

#[test]
#[ignore = "ten million instructions take minutes; for changes of the core"]
fn many_random_programs_end_alike() {
    compare(1000..1600);
}
