//! The opcodes REGIMM (branches and traps against zero or an immediate) and COP0 (privileged instructions).

use super::InstructionFields;
use crate::cpu::operation::{Condition, Operation, Uncommon};
use crate::cpu::registers::Source;

pub(super) fn immediate_conditions(fields: InstructionFields) -> Operation {
    let rs = fields.rs();
    let zero = Source::new(0);
    let words = fields.signed();
    let likely = |condition| Uncommon::BranchLikely {
        condition,
        rs,
        rt: zero,
        words,
    };
    let trap = |condition| Uncommon::TrapImmediate {
        condition,
        rs,
        value: words,
    };
    let uncommon = match fields.five(16) {
        0x00 => {
            return Operation::Bltz {
                rs,
                words: fields.words(),
            };
        }
        0x01 => {
            return Operation::Bgez {
                rs,
                words: fields.words(),
            };
        }
        // `synci`: the emulator has no instruction cache to be synchronised.
        0x1F => return Operation::Nop,
        0x02 => likely(Condition::Less),
        0x03 => likely(Condition::GreaterEqual),
        0x08 => trap(Condition::GreaterEqual),
        0x09 => trap(Condition::GreaterEqualUnsigned),
        0x0A => trap(Condition::Less),
        0x0B => trap(Condition::LessUnsigned),
        0x0C => trap(Condition::Equal),
        0x0E => trap(Condition::NotEqual),
        0x10 => Uncommon::BranchLink {
            condition: Condition::Less,
            rs,
            words,
        },
        0x11 => Uncommon::BranchLink {
            condition: Condition::GreaterEqual,
            rs,
            words,
        },
        0x12 => Uncommon::BranchLinkLikely {
            condition: Condition::Less,
            rs,
            words,
        },
        0x13 => Uncommon::BranchLinkLikely {
            condition: Condition::GreaterEqual,
            rs,
            words,
        },
        _ => Uncommon::Reserved,
    };
    Operation::Uncommon(uncommon)
}

pub(super) fn coprocessor_zero(fields: InstructionFields) -> Operation {
    let (rt, rd) = (fields.rt(), fields.rd());
    let register = fields.five(11) as u8;
    let select = (fields.0 & 7) as u8;
    Operation::Uncommon(match fields.five(21) {
        0x00 => Uncommon::Mfc0 {
            rt: fields.rt_target(),
            register,
            select,
        },
        0x04 => Uncommon::Mtc0 { rt, register, select },
        0x0A => Uncommon::Rdpgpr { rd, rt },
        0x0B if fields.0 & 0x20 == 0 => Uncommon::Di {
            rt: fields.rt_target(),
        },
        0x0B => Uncommon::Ei {
            rt: fields.rt_target(),
        },
        0x0E => Uncommon::Wrpgpr { rd, rt },
        0x10..=0x1F => match fields.function() {
            0x18 => Uncommon::Eret,
            0x1F => Uncommon::Deret,
            0x20 => Uncommon::Wait,
            _ => Uncommon::Reserved,
        },
        _ => Uncommon::Reserved,
    })
}
