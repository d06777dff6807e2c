//! A few random instructions that fall through to their end, whatever they do.

use crate::encode::{
    COUNTER, DATA, LINK, SCRATCH, bytes, condition, constant, ext, immediate, ins, jump, shift, special,
    special2,
};
use crate::numbers::Numbers;

/// Bytes that a program may reach, on both sides of [`DATA`].
pub(crate) const WINDOW: u32 = 256;

/// Instructions that belong together, and what of them depends on where others are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Item {
    pub(crate) words: Vec<u32>,
    /// A word whose target is the begin of a later item.
    pub(crate) target: Option<Target>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    /// Which word of the item.
    pub(crate) word: usize,
    /// Number of items to go forward, at least 1.
    pub(crate) items: usize,
    pub(crate) kind: TargetKind,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum TargetKind {
    /// The lower half is the distance in words.
    Branch,
    /// `j` and `jal`.
    Jump,
    /// `lui` and `ori` of the whole address, from this word on.
    Constant,
}

/// Registers that may hold anything: all but those with a purpose. Register 0 among them.
fn any(numbers: &mut Numbers) -> u32 {
    match numbers.below(32) {
        DATA | SCRATCH | COUNTER => 0,
        register => register,
    }
}

/// A register other than 31, for branches that write it.
fn not_link(numbers: &mut Numbers) -> u32 {
    match any(numbers) {
        LINK => 1,
        register => register,
    }
}

/// What a program is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A process, or the chip at error level.
    Process,
    /// The chip with interrupts: through KSEG0, and without `ll` and `sc`, whose link the return from an interrupt breaks.
    Interrupted,
}

/// One item.
pub(crate) fn item(numbers: &mut Numbers, kind: Kind) -> Item {
    match numbers.below(20) {
        0..=9 => plain(vec![simple(numbers)]),
        10 | 11 => plain(constant(any(numbers), numbers.interesting()).to_vec()),
        12 | 13 => plain(indexed(numbers)),
        14 => plain(guarded(numbers)),
        15 if kind == Kind::Process => plain(linked(numbers)),
        15 | 16 => plain(repeated(numbers)),
        _ => branch(numbers),
    }
}

fn plain(words: Vec<u32>) -> Item {
    Item { words, target: None }
}

/// Any instruction that can stand in a delay slot.
fn simple(numbers: &mut Numbers) -> u32 {
    let (rd, rs, rt) = (any(numbers), any(numbers), any(numbers));
    match numbers.below(12) {
        0..=2 => special(
            numbers.pick(&[
                0x21, 0x23, 0x24, 0x25, 0x26, 0x27, 0x2A, 0x2B, 0x0A, 0x0B, 0x04, 0x06, 0x07,
            ]),
            rd,
            rs,
            rt,
        ),
        3 => shift(numbers.pick(&[0, 2, 3]), rd, rt, (0, numbers.below(32))),
        4 => match numbers.below(2) {
            0 => shift(2, rd, rt, (1, numbers.below(32))),
            _ => special(6, rd, rs, rt) | 1 << 6,
        },
        5 => immediate(
            numbers.pick(&[9, 10, 11, 12, 13, 14, 15]),
            rt,
            rs,
            numbers.interesting(),
        ),
        6 => bit_field(numbers, rt, rs),
        7 => bytes(numbers.pick(&[0x02, 0x10, 0x18]), rd, rt),
        8 => special2(numbers.pick(&[0x20, 0x21]), rd, rs, rd),
        9 => product(numbers, rd, rs, rt),
        10 => access(numbers, rt, DATA),
        _ => numbers.pick(&[
            0,
            0x40,
            0xC0,
            0x0F,
            0x140,
            0x041F_0000 | DATA << 21,
            0x33 << 26 | DATA << 21,
        ]),
    }
}

fn bit_field(numbers: &mut Numbers, rt: u32, rs: u32) -> u32 {
    let low = numbers.below(32);
    let size = numbers.below(32 - low) + 1;
    match numbers.below(2) {
        0 => ext(rt, rs, low, size),
        _ => ins(rt, rs, low, size),
    }
}

/// Multiplications and moves from and to HI and LO.
fn product(numbers: &mut Numbers, rd: u32, rs: u32, rt: u32) -> u32 {
    match numbers.below(12) {
        0 => special2(2, rd, rs, rt),
        1 => special(0x18, 0, rs, rt),
        2 => special(0x19, 0, rs, rt),
        3..=6 => special2(numbers.pick(&[0, 1, 4, 5]), 0, rs, rt),
        7 => special(0x11, 0, rs, 0),
        8 => special(0x13, 0, rs, 0),
        9 | 10 => special(0x10, rd, 0, 0),
        _ => special(0x12, rd, 0, 0),
    }
}

/// A load or store inside of the window around `base`, or around an even more restricted address there.
fn access(numbers: &mut Numbers, rt: u32, base: u32) -> u32 {
    let (opcode, alignment) = numbers.pick(&[
        (0x20, 1),
        (0x24, 1),
        (0x28, 1),
        (0x21, 2),
        (0x25, 2),
        (0x29, 2),
        (0x23, 4),
        (0x2B, 4),
        (0x22, 1),
        (0x26, 1),
        (0x2A, 1),
        (0x2E, 1),
    ]);
    let offset = numbers.below(WINDOW / 2).wrapping_sub(WINDOW / 4) & !(alignment - 1);
    immediate(opcode, rt, base, offset)
}

/// A load or store at an address that depends on a register.
fn indexed(numbers: &mut Numbers) -> Vec<u32> {
    let (index, value) = (any(numbers), any(numbers));
    vec![
        immediate(0x0C, SCRATCH, index, WINDOW / 4 - 4),
        special(0x21, SCRATCH, SCRATCH, DATA),
        access(numbers, value, SCRATCH),
    ]
}

/// What would raise an exception with the wrong operands, with the right ones.
fn guarded(numbers: &mut Numbers) -> Vec<u32> {
    let (rd, rs, rt) = (any(numbers), any(numbers), any(numbers));
    match numbers.below(6) {
        // Division by anything but zero.
        0 => {
            let divisor = immediate(0x0D, SCRATCH, rt, 1);
            vec![divisor, special(numbers.pick(&[0x1A, 0x1B]), 0, rs, SCRATCH)]
        }
        // Additions that cannot overflow.
        1 => vec![
            shift(3, SCRATCH, rs, (0, 2)),
            immediate(8, rd, SCRATCH, numbers.interesting()),
        ],
        2 => vec![
            shift(3, SCRATCH, rs, (0, 2)),
            shift(3, COUNTER, rt, (0, 2)),
            special(numbers.pick(&[0x20, 0x22]), rd, SCRATCH, COUNTER),
        ],
        // Traps whose condition does not hold: the register against itself.
        3 => vec![special(numbers.pick(&[0x32, 0x33, 0x36]), 0, rs, rs)],
        4 => vec![
            immediate(0x0C, SCRATCH, rs, 0x7F),
            immediate(9, COUNTER, SCRATCH, 0x80),
            special(0x30, 0, SCRATCH, COUNTER),
            special(0x31, 0, SCRATCH, COUNTER),
            special(0x34, 0, SCRATCH, COUNTER),
        ],
        _ => vec![
            immediate(0x0C, SCRATCH, rs, 0x7F),
            condition(8, SCRATCH, 0x80),
            condition(9, SCRATCH, 0x80),
            condition(10, SCRATCH, 0),
            condition(11, SCRATCH, 0),
            condition(12, SCRATCH, 0x80),
            condition(14, 0, 0),
        ],
    }
}

/// `ll` and `sc` of the same word with something in between.
fn linked(numbers: &mut Numbers) -> Vec<u32> {
    let offset = numbers.below(WINDOW / 2).wrapping_sub(WINDOW / 4) & !3;
    let load = immediate(0x30, any(numbers), DATA, offset);
    let change = special(0x21, any(numbers), any(numbers), any(numbers));
    vec![load, change, immediate(0x38, any(numbers), DATA, offset)]
}

/// A loop of a few rounds.
fn repeated(numbers: &mut Numbers) -> Vec<u32> {
    let rounds = numbers.below(4) + 1;
    let mut words = vec![immediate(9, COUNTER, 0, rounds)];
    let length = numbers.below(3) + 1;
    words.extend((0..length).map(|_| simple(numbers)));
    words.push(immediate(9, COUNTER, COUNTER, u32::MAX));
    let back = 0_u32.wrapping_sub(length + 2);
    // `bne`, `bgtz`, or their likely forms.
    words.push(match numbers.below(4) {
        0 => immediate(0x05, 0, COUNTER, back),
        1 => immediate(0x15, 0, COUNTER, back),
        2 => immediate(0x07, 0, COUNTER, back),
        _ => immediate(0x17, 0, COUNTER, back),
    });
    words.push(simple(numbers));
    words
}

/// A branch or jump forward, with its delay slot.
fn branch(numbers: &mut Numbers) -> Item {
    let items = numbers.below(4) as usize + 1;
    let (rs, rt) = (any(numbers), any(numbers));
    let (mut words, word, kind) = match numbers.below(9) {
        0..=2 => {
            let opcode = numbers.pick(&[4, 5, 0x14, 0x15]);
            (vec![immediate(opcode, rt, rs, 0)], 0, TargetKind::Branch)
        }
        3 => {
            let opcode = numbers.pick(&[6, 7, 0x16, 0x17]);
            (vec![immediate(opcode, 0, rs, 0)], 0, TargetKind::Branch)
        }
        4 => (vec![condition(numbers.below(4), rs, 0)], 0, TargetKind::Branch),
        5 => {
            let kind = 0x10 + numbers.below(4);
            (vec![condition(kind, not_link(numbers), 0)], 0, TargetKind::Branch)
        }
        6 => (vec![jump(numbers.pick(&[2, 3]), 0)], 0, TargetKind::Jump),
        7 => {
            // Plain or with a hazard barrier.
            let barrier = numbers.below(2) << 10;
            let go = special(0x08, 0, SCRATCH, 0) | barrier;
            (vec![0, 0, go], 0, TargetKind::Constant)
        }
        _ => {
            let barrier = numbers.below(2) << 10;
            let go = special(0x09, any(numbers), SCRATCH, 0) | barrier;
            (vec![0, 0, go], 0, TargetKind::Constant)
        }
    };
    words.push(simple(numbers));
    Item {
        words,
        target: Some(Target { word, items, kind }),
    }
}
