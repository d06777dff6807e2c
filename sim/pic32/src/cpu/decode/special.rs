//! The opcodes SPECIAL, SPECIAL2 and SPECIAL3: register arithmetic, shifts, multiplications, bit fields.

use super::InstructionFields;
use crate::cpu::operation::{Condition, Multiply, Operation, Uncommon};

const RESERVED: Operation = Operation::Uncommon(Uncommon::Reserved);

pub(super) fn special(fields: InstructionFields) -> Operation {
    let (rd, rs, rt) = (fields.rd(), fields.rs(), fields.rt());
    match fields.function() {
        0x00 | 0x02..=0x04 | 0x06 | 0x07 => shift(fields),
        // `movf` and `movt` read a condition of the floating point unit.
        0x01 => Operation::Uncommon(Uncommon::CoprocessorUnusable { unit: 1 }),
        0x08 => Operation::Jr { rs },
        0x09 => Operation::Jalr { rd, rs },
        0x0A => Operation::Movz { rd, rs, rt },
        0x0B => Operation::Movn { rd, rs, rt },
        0x0C => Operation::Uncommon(Uncommon::Syscall),
        0x0D => Operation::Uncommon(Uncommon::Break),
        // `sync`: each access is complete before the next instruction.
        0x0F => Operation::Nop,
        0x10 => Operation::Mfhi { rd },
        0x11 => Operation::Mthi { rs },
        0x12 => Operation::Mflo { rd },
        0x13 => Operation::Mtlo { rs },
        0x18 => Operation::Multiply {
            kind: Multiply::Mult,
            rs,
            rt,
        },
        0x19 => Operation::Multiply {
            kind: Multiply::Multu,
            rs,
            rt,
        },
        0x1A => Operation::Div { rs, rt },
        0x1B => Operation::Divu { rs, rt },
        0x20 => Operation::Uncommon(Uncommon::Add { rd, rs, rt }),
        0x21 => Operation::Addu { rd, rs, rt },
        0x22 => Operation::Uncommon(Uncommon::Sub { rd, rs, rt }),
        0x23 => Operation::Subu { rd, rs, rt },
        0x24 => Operation::And { rd, rs, rt },
        0x25 => Operation::Or { rd, rs, rt },
        0x26 => Operation::Xor { rd, rs, rt },
        0x27 => Operation::Nor { rd, rs, rt },
        0x2A => Operation::Slt { rd, rs, rt },
        0x2B => Operation::Sltu { rd, rs, rt },
        0x30..=0x34 | 0x36 => trap(fields),
        _ => RESERVED,
    }
}

fn shift(fields: InstructionFields) -> Operation {
    let (rd, rs, rt) = (fields.rd(), fields.rs(), fields.rt());
    let shift = fields.five(6) as u8;
    match (fields.function(), fields.five(21), fields.five(6)) {
        // `nop`, `ssnop` and `ehb` among them: hazards do not exist when one instruction ends before the next.
        (0x00, ..) if fields.five(11) == 0 => Operation::Nop,
        (0x00, ..) => Operation::Sll { rd, rt, shift },
        (0x02, 0, _) => Operation::Srl { rd, rt, shift },
        (0x02, 1, _) => Operation::Rotr { rd, rt, shift },
        (0x03, ..) => Operation::Sra { rd, rt, shift },
        (0x04, ..) => Operation::Sllv { rd, rs, rt },
        (0x06, _, 0) => Operation::Srlv { rd, rs, rt },
        (0x06, _, 1) => Operation::Rotrv { rd, rs, rt },
        (0x07, ..) => Operation::Srav { rd, rs, rt },
        _ => RESERVED,
    }
}

fn trap(fields: InstructionFields) -> Operation {
    let condition = match fields.function() {
        0x30 => Condition::GreaterEqual,
        0x31 => Condition::GreaterEqualUnsigned,
        0x32 => Condition::Less,
        0x33 => Condition::LessUnsigned,
        0x34 => Condition::Equal,
        _ => Condition::NotEqual,
    };
    Operation::Uncommon(Uncommon::Trap {
        condition,
        rs: fields.rs(),
        rt: fields.rt(),
    })
}

pub(super) fn special2(fields: InstructionFields) -> Operation {
    let (rd, rs, rt) = (fields.rd(), fields.rs(), fields.rt());
    match fields.function() {
        0x00 => Operation::Multiply {
            kind: Multiply::Madd,
            rs,
            rt,
        },
        0x01 => Operation::Multiply {
            kind: Multiply::Maddu,
            rs,
            rt,
        },
        0x02 => Operation::Mul { rd, rs, rt },
        0x04 => Operation::Multiply {
            kind: Multiply::Msub,
            rs,
            rt,
        },
        0x05 => Operation::Multiply {
            kind: Multiply::Msubu,
            rs,
            rt,
        },
        0x20 => Operation::Clz { rd, rs },
        0x21 => Operation::Clo { rd, rs },
        0x3F => Operation::Uncommon(Uncommon::Sdbbp),
        _ => RESERVED,
    }
}

pub(super) fn special3(fields: InstructionFields) -> Operation {
    let (rt, rs) = (fields.rt_target(), fields.rs());
    let (upper, lower) = (fields.five(11), fields.five(6));
    match fields.function() {
        0x00 if lower + upper < 32 => Operation::Ext {
            rt,
            rs,
            shift: lower as u8,
            mask: ones(upper + 1),
        },
        0x04 if upper >= lower => Operation::Ins {
            rt,
            rs,
            shift: lower as u8,
            mask: ones(upper - lower + 1) << lower,
        },
        0x20 => match lower {
            0x02 => Operation::Wsbh {
                rd: fields.rd(),
                rt: fields.rt(),
            },
            0x10 => Operation::Seb {
                rd: fields.rd(),
                rt: fields.rt(),
            },
            0x18 => Operation::Seh {
                rd: fields.rd(),
                rt: fields.rt(),
            },
            _ => RESERVED,
        },
        0x3B => Operation::Uncommon(Uncommon::Rdhwr {
            rt,
            register: upper as u8,
        }),
        _ => RESERVED,
    }
}

/// A number of ones, 1..=32, at the low end.
fn ones(count: u32) -> u32 {
    u32::MAX >> (32 - count.clamp(1, 32))
}
