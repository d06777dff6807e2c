//! A program: random blocks, and after each of them a call that writes everything out.

use crate::block::{Item, Kind, TargetKind, WINDOW, item};
use crate::encode::{DATA, LINK, NOP, SCRATCH, SYSCALL, constant, immediate, jump, special};
use crate::numbers::Numbers;

/// Where programs begin. A process of Linux can live there, and so can this chip's program at error level.
pub(crate) const CODE: u32 = 0x1D00_0000;
/// [`CODE`] in KSEG0.
const CACHED_CODE: u32 = 0x8000_0000 | CODE;
/// Random instructions of a block, about.
pub(crate) const BLOCK_INSTRUCTIONS: usize = 16;

/// What a dump consists of: registers 1..=31 (0 for those that hold addresses), HI, LO, and the window.
pub(crate) const DUMP_REGISTERS: u32 = 33;
/// Bytes of a dump.
pub(crate) const DUMP_BYTES: u32 = WINDOW + 4 * DUMP_REGISTERS;
/// Where the registers of a dump begin, from [`DATA`] on: the window comes first, [`DATA`] is its middle.
const DUMP_START: u32 = WINDOW / 2;

const WRITE: u32 = 4004;
const EXIT: u32 = 4001;

/// Words and where they come from.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    /// From [`CODE`] on. The first two set [`DATA`]; the caller puts them there.
    pub(crate) words: Vec<u32>,
    /// Index of each block's first word.
    pub(crate) blocks: Vec<usize>,
}

impl Program {
    /// A program from a seed.
    pub(crate) fn random(seed: u64, blocks: usize, kind: Kind) -> Self {
        let mut numbers = Numbers::new(seed);
        let mut program = Self {
            words: vec![NOP; 2],
            blocks: Vec::new(),
        };
        // Over the routine.
        let routine = routine();
        let begin = CODE + 4 * (4 + routine.len() as u32);
        program.words.extend([jump(2, begin), NOP]);
        let routine_address = CODE + 4 * program.words.len() as u32;
        program.words.extend(routine);
        for register in (1..32).filter(|register| *register != DATA) {
            program.words.extend(constant(register, numbers.interesting()));
        }
        for _ in 0..blocks {
            program.blocks.push(program.words.len());
            program.block(&mut numbers, kind);
            program.words.extend(call(routine_address));
        }
        program.words.extend(constant(2, EXIT));
        program.words.extend([immediate(9, 4, 0, 0), SYSCALL]);
        program
    }

    fn block(&mut self, numbers: &mut Numbers, kind: Kind) {
        let mut items: Vec<Item> = Vec::new();
        while items.iter().map(|item| item.words.len()).sum::<usize>() < BLOCK_INSTRUCTIONS {
            items.push(item(numbers, kind));
        }
        let mut starts = vec![self.words.len()];
        for item in &items {
            starts.push(starts[starts.len() - 1] + item.words.len());
        }
        for (number, mut item) in items.into_iter().enumerate() {
            if let Some(target) = item.target {
                let base = if kind == Kind::Process { CODE } else { CACHED_CODE };
                let index = starts[(number + target.items).min(starts.len() - 1)];
                let address = base + 4 * index as u32;
                let place = starts[number] + target.word;
                let word = &mut item.words[target.word];
                match target.kind {
                    TargetKind::Branch => *word |= (index - place - 1) as u32,
                    TargetKind::Jump => *word |= jump(0, address),
                    TargetKind::Constant => item.words[..2].copy_from_slice(&constant(SCRATCH, address)),
                }
            }
            self.words.extend(item.words);
        }
    }
}

/// A call of the routine that leaves all registers as they were.
fn call(routine: u32) -> [u32; 4] {
    let slot = DUMP_START + 4 * (LINK - 1);
    [
        immediate(0x2B, LINK, DATA, slot),
        jump(3, routine),
        NOP,
        immediate(0x23, LINK, DATA, slot),
    ]
}

/// Writes window and registers to standard output.
fn routine() -> Vec<u32> {
    let place = |register: u32| DUMP_START + 4 * (register - 1);
    let others = || (1..LINK).filter(|register| ![DATA, SCRATCH].contains(register));
    let mut words: Vec<u32> = others()
        .map(|register| immediate(0x2B, register, DATA, place(register)))
        .collect();
    // HI and LO stand after the registers.
    words.extend([special(0x10, 2, 0, 0), immediate(0x2B, 2, DATA, place(32))]);
    words.extend([special(0x12, 2, 0, 0), immediate(0x2B, 2, DATA, place(33))]);
    words.extend(constant(2, WRITE));
    words.extend([
        immediate(9, 4, 0, 1),
        immediate(9, 5, DATA, 0_u32.wrapping_sub(WINDOW / 2)),
        immediate(9, 6, 0, DUMP_BYTES),
        SYSCALL,
    ]);
    words.extend(others().map(|register| immediate(0x23, register, DATA, place(register))));
    words.extend([special(0x08, 0, LINK, 0), NOP]);
    words
}
