//! The chip against uCsim, instruction by instruction.
//!
//! Random programs (from a seed) of all 255 instructions, and programs that SDCC compiled, run in both from the same
//! memories. Every few instructions all registers, the internal RAM and the number of cycles must be equal, and in the end
//! the external memory. A comparison ends where the two are known to differ: `stc90`'s own documentation lists where.

mod compiled;
mod lockstep;
mod numbers;
mod process;
mod program;
mod state;

use lockstep::{Compared, Extent, compare};
use process::UcSim;
use program::Kind;

/// Programs of a usual run.
const EXTENT: Extent = Extent {
    instructions: 6_000,
    stride: 12,
};

/// Programs of the campaign.
const LONG: Extent = Extent {
    instructions: 10_000,
    stride: 60,
};

/// Runs random programs in both.
fn compare_random(kind: Kind, seeds: std::ops::Range<u64>, extent: Extent) {
    let Some(ucsim) = UcSim::find() else {
        return;
    };
    let mut all = Compared::default();
    for seed in seeds {
        let compared = compare(&ucsim, &program::random(seed, kind), extent, seed);
        all.instructions += compared.instructions;
        all.opcodes.extend(compared.opcodes);
    }
    println!(
        "{} random instructions agree, {} different ones",
        all.instructions,
        all.opcodes.len()
    );
    let missing: Vec<u8> = (0..=u8::MAX)
        .filter(|opcode| *opcode != 0xA5 && !all.opcodes.contains(opcode))
        .collect();
    assert!(missing.is_empty(), "never executed: {missing:02x?}");
}

#[test]
fn random_programs_agree() {
    compare_random(Kind::Core, 0..4, EXTENT);
}

#[test]
fn random_programs_with_timers_agree() {
    compare_random(Kind::Timers, 100..103, EXTENT);
}

#[test]
#[ignore = "campaign: a million instructions take a minute"]
fn many_random_programs_agree() {
    compare_random(Kind::Core, 1000..1070, LONG);
    compare_random(Kind::Timers, 2000..2030, LONG);
}
