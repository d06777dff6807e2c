//! Random programs of all 255 instructions.
//!
//! Jumps go forward over a few instructions, calls come back, and loops end, so that a program stays within itself unless
//! it overwrites its own stack or counters, which is allowed.

use crate::lockstep::Start;
use crate::numbers::Numbers;
use stc90::cpu::CODE_BYTES;

/// What programs may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The core alone.
    Core,
    /// The timers as well, without interrupts.
    Timers,
}

/// Registers that are written: A, B, DPTR, two ports.
const CORE: [u8; 7] = [0xE0, 0xF0, 0x82, 0x83, 0x80, 0x90, 0xE0];
const PSW: u8 = 0xD0;
/// Bits of PSW that uCsim gets wrong: a written parity stays, and RS0 and RS1 written as bits change no bank.
const UNCOMPARED_BITS: [u8; 3] = [PSW, PSW + 3, PSW + 4];
const CORE_BITS: [u8; 5] = [0xE0, 0xF0, 0xD0, 0x80, 0x90];
/// The counts and reload values of all timers.
const TIMERS: [u8; 9] = [0x8A, 0x8B, 0x8C, 0x8D, 0xCA, 0xCB, 0xCC, 0xCD, 0x8A];

/// Opcodes that [`Builder::item`] makes with more around them.
const SPECIAL: [u8; 12] = [
    0x02, 0x12, 0x22, 0x32, 0x73, 0x93, 0xC0, 0xD0, 0xE0, 0xF0, 0xA5, 0x80,
];

/// A program that is being written.
#[derive(Debug)]
struct Builder<'a> {
    numbers: &'a mut Numbers,
    kind: Kind,
    code: Vec<u8>,
}

/// A random program with random memories.
pub(crate) fn random(seed: u64, kind: Kind) -> Start {
    let mut numbers = Numbers::new(seed);
    let mut memory = |bytes: usize| (0..bytes).map(|_| numbers.byte()).collect::<Vec<u8>>();
    let (ram, xram) = (memory(256), memory(1024));
    let mut builder = Builder {
        numbers: &mut numbers,
        kind,
        code: Vec::new(),
    };
    // A stack of its own; P2 as uCsim must have it to find the memory on the chip by R0 and R1.
    builder.code.extend([0x75, 0x81, 0x5F, 0x75, 0xA0, 0x00]);
    if kind == Kind::Timers {
        builder.start_timers();
    }
    while builder.code.len() < CODE_BYTES - 64 {
        builder.item(2);
    }
    Start {
        code: builder.code,
        ram,
        xram,
    }
}

impl Builder<'_> {
    /// Random modes, and all timers running. The pins of counters and gates stay high. Not mode 3 of timer 0, in which
    /// uCsim does not let timer 1 run on.
    fn start_timers(&mut self) {
        let modes = [self.numbers.next() as u8 % 4, self.numbers.next() as u8 % 3];
        let tmod = modes[0] << 4 | modes[1];
        self.code.extend([0x75, 0x89, tmod]);
        // TR0, TR1; TR2
        self.code.extend([0x75, 0x88, 0x50, 0x75, 0xC8, 0x04]);
    }

    fn direct(&mut self) -> u8 {
        if self.numbers.below(10) < 6 {
            return self.numbers.next() as u8 & 0x7F;
        }
        if self.kind == Kind::Timers && self.numbers.below(2) == 0 {
            return self.numbers.pick(&TIMERS);
        }
        self.numbers.pick(&CORE)
    }

    /// A byte that is only read. As a whole PSW is written by [`Self::status`] only, because of its parity.
    fn source(&mut self) -> u8 {
        if self.numbers.below(8) == 0 {
            return PSW;
        }
        self.direct()
    }

    fn bit(&mut self) -> u8 {
        if self.numbers.below(10) < 6 {
            return self.numbers.next() as u8 & 0x7F;
        }
        let bit = self.numbers.pick(&CORE_BITS) | self.numbers.next() as u8 & 7;
        if UNCOMPARED_BITS.contains(&bit) {
            PSW + 1
        } else {
            bit
        }
    }

    fn address(&self) -> u16 {
        self.code.len() as u16
    }

    /// One instruction or a few that belong together; `depth` more may lie inside.
    fn item(&mut self, depth: u32) {
        match self.numbers.below(40) {
            0 if depth > 0 => self.call(depth),
            1 if depth > 0 => self.looped(depth),
            2 if depth > 0 => self.long_jump(depth),
            3 => self.computed_jump(),
            4 => self.returned_jump(),
            5 => self.pushed(),
            6 | 7 => self.external(),
            8 => self.table(),
            9 => self.status(),
            10 if self.kind == Kind::Timers => self.start_timers(),
            _ => self.plain(depth),
        }
    }

    /// Any instruction that stands alone; a branch with what it jumps over.
    fn plain(&mut self, depth: u32) {
        let opcode = self.numbers.next() as u8;
        if SPECIAL.contains(&opcode) || opcode & 0x1F == 0x11 {
            return;
        }
        if opcode & 0x1F == 0x01 {
            return self.absolute_jump(opcode);
        }
        self.code.push(opcode);
        self.operands(opcode);
        if is_branch(opcode) {
            self.over(depth);
        }
    }

    fn operands(&mut self, opcode: u8) {
        let (row, column) = (opcode >> 4, opcode & 0x0F);
        match (row, column) {
            (0x1..=0x3 | 0xA | 0xB, 0) | (0x7..=0xD, 2) => self.push_bit(),
            (0x9, 0) => {
                let [high, low] = (self.numbers.next() as u16).to_be_bytes();
                self.code.extend([high & 3, low]);
            }
            (0x4..=0x6, 2) => self.push_direct(),
            (0x4..=0x6, 3) | (0x7, 5) => {
                self.push_direct();
                self.push_constant();
            }
            (0x2..=0x7 | 0x9 | 0xB, 4) | (0x7 | 0xB, 6..) => self.push_constant(),
            (0x8, 5) => {
                self.push_source();
                self.push_direct();
            }
            (0x2..=0x6 | 0x9 | 0xB | 0xE, 5) | (0xA, 6..) => self.push_source(),
            // DJNZ: uCsim looks at a timer a cycle later than with all other instructions.
            (0xD, 5) => self.code.push(self.numbers.next() as u8 & 0x7F),
            (_, 5) | (0x8, 6..) => self.push_direct(),
            _ => {}
        }
    }

    fn push_direct(&mut self) {
        let direct = self.direct();
        self.code.push(direct);
    }

    fn push_source(&mut self) {
        let source = self.source();
        self.code.push(source);
    }

    fn push_constant(&mut self) {
        let constant = self.numbers.byte();
        self.code.push(constant);
    }

    fn push_bit(&mut self) {
        let bit = self.bit();
        self.code.push(bit);
    }

    /// A distance, and as many bytes of instructions.
    fn over(&mut self, depth: u32) {
        let place = self.code.len();
        self.code.push(0);
        self.item(depth.saturating_sub(1));
        let distance = self.code.len() - place - 1;
        // Nothing nested is so long; a distance that does not fit would only jump elsewhere.
        self.code[place] = distance as u8;
    }

    /// AJMP over an instruction, or to the next one at the end of a page.
    fn absolute_jump(&mut self, opcode: u8) {
        let next = self.address() + 2;
        let target = next & 0xF800 | (next + 1) & 0x07FF;
        let page = (target >> 3) as u8 & 0xE0;
        self.code.extend([page | opcode & 0x1F, target as u8, 0]);
    }

    /// A call of what follows, over a jump past it.
    fn call(&mut self, depth: u32) {
        let subroutine = self.address() + 3 + 2;
        let [high, low] = subroutine.to_be_bytes();
        let is_short = subroutine & 0xF800 == (self.address() + 2) & 0xF800;
        if self.numbers.below(2) == 0 && is_short {
            let page = (subroutine >> 3) as u8 & 0xE0;
            self.code.extend([page | 0x11, low, 0x00]);
        } else {
            self.code.extend([0x12, high, low]);
        }
        self.code.push(0x80);
        let place = self.code.len();
        self.code.push(0);
        self.item(depth - 1);
        let instruction = self.numbers.pick(&[0x22, 0x32]);
        self.code.push(instruction);
        self.code[place] = (self.code.len() - place - 1) as u8;
    }

    /// Something a few times, counted by a register or a byte.
    fn looped(&mut self, depth: u32) {
        let count = self.numbers.next() as u8 % 5 + 1;
        let register = self.numbers.next() as u8 & 7;
        let by_register = self.numbers.below(2) == 0;
        let counter = 0x30 + register;
        if by_register {
            self.code.extend([0x78 | register, count]);
        } else {
            self.code.extend([0x75, counter, count]);
        }
        let begin = self.code.len();
        self.item(depth - 1);
        if by_register {
            self.code.push(0xD8 | register);
        } else {
            self.code.extend([0xD5, counter]);
        }
        let distance = self.code.len() + 1 - begin;
        self.code.push((distance as u8).wrapping_neg());
    }

    fn long_jump(&mut self, depth: u32) {
        let place = self.code.len();
        self.code.extend([0x02, 0, 0]);
        self.item(depth - 1);
        let target = self.address().to_be_bytes();
        self.code[place + 1..place + 3].copy_from_slice(&target);
    }

    /// JMP @A+DPTR to the next instruction.
    fn computed_jump(&mut self) {
        let offset = self.numbers.byte();
        let target = self.address() + 6;
        let [high, low] = target.wrapping_sub(u16::from(offset)).to_be_bytes();
        self.code.extend([0x74, offset, 0x90, high, low, 0x73]);
    }

    /// The address of the next instruction on the stack, and RET or RETI.
    fn returned_jump(&mut self) {
        let instruction = self.numbers.pick(&[0x22, 0x32]);
        let [high, low] = (self.address() + 11).to_be_bytes();
        self.code.extend([0x75, 0x7F, low, 0xC0, 0x7F]);
        self.code.extend([0x75, 0x7F, high, 0xC0, 0x7F, instruction]);
    }

    /// Any status, then an accumulator, whose parity uCsim takes over.
    fn status(&mut self) {
        let (status, a) = (self.numbers.byte(), self.numbers.byte());
        self.code.extend([0x75, PSW, status, 0x74, a]);
    }

    fn pushed(&mut self) {
        self.code.push(0xC0);
        self.push_source();
        self.code.push(0xD0);
        self.push_direct();
    }

    /// MOVX by DPTR.
    fn external(&mut self) {
        let [high, low] = (self.numbers.next() as u16).to_be_bytes();
        let instruction = self.numbers.pick(&[0xE0, 0xF0]);
        self.code.extend([0x90, high & 3, low, instruction]);
    }

    /// MOVC by DPTR.
    fn table(&mut self) {
        let [high, low] = (self.numbers.next() as u16).to_be_bytes();
        self.code.extend([0x90, high % 0x7E, low, 0x93]);
    }
}

/// Whether a distance follows.
fn is_branch(opcode: u8) -> bool {
    let (row, column) = (opcode >> 4, opcode & 0x0F);
    match column {
        0 => (0x1..=0x8).contains(&row),
        4 => row == 0xB,
        5 => row == 0xB || row == 0xD,
        6 | 7 => row == 0xB,
        8.. => row == 0xB || row == 0xD,
        _ => false,
    }
}
