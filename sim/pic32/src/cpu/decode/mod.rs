//! From instruction words to [`Operation`]s.
//!
//! Fields that the architecture says are zero are not looked at, except where release 2 gave them a meaning. What this
//! core does not have decodes to a reserved instruction or an unusable coprocessor and raises that exception when it is
//! executed. `jalx` is reserved here: the chip would go on in MIPS16e, which no compiler for this project emits.

mod special;
mod system;
mod uses;

use super::STACK_POINTER;
use super::operation::{Condition, Loaded, Operation, Uncommon};
use super::registers::{Source, WriteTarget};

/// The fields of an instruction word.
#[derive(Clone, Copy, Debug)]
struct InstructionFields(u32);

impl InstructionFields {
    /// Bits `low..low + 5`.
    fn five(self, low: u32) -> u32 {
        self.0 >> low & 31
    }

    fn rs(self) -> Source {
        Source::new(self.0 >> 21)
    }

    fn rt(self) -> Source {
        Source::new(self.0 >> 16)
    }

    fn rt_target(self) -> WriteTarget {
        WriteTarget::new(self.0 >> 16)
    }

    fn rd(self) -> WriteTarget {
        WriteTarget::new(self.0 >> 11)
    }

    fn function(self) -> u32 {
        self.0 & 63
    }

    fn signed(self) -> i16 {
        (self.0 as u16).cast_signed()
    }

    fn extended(self) -> u32 {
        i32::from(self.signed()).cast_unsigned()
    }

    fn unsigned(self) -> u32 {
        self.0 & 0xFFFF
    }

    /// The distance from the branch to its target in words.
    fn words(self) -> i32 {
        i32::from(self.signed()) + 1
    }
}

/// The word at `index` of a memory. Its neighbours matter for a load: it stalls when the next instruction needs what it
/// loads. In a delay slot the next instruction is not known, and no stall is counted.
pub(crate) fn decode_at(word: impl Fn(usize) -> Option<u32>, index: usize) -> Operation {
    let mut operation = word(index).map_or(Operation::Uncommon(Uncommon::Reserved), decode);
    if let Some(loaded) = uses::loaded(&mut operation) {
        let before = index.checked_sub(1).and_then(&word).map(decode);
        let after = word(index + 1).map(decode);
        let in_slot = before.is_some_and(uses::has_delay_slot);
        let needed = after.is_some_and(|after| uses::reads(after, loaded.rt));
        loaded.stall = u8::from(needed && !in_slot);
    }
    operation
}

/// One word by itself.
pub(crate) fn decode(word: u32) -> Operation {
    let fields = InstructionFields(word);
    match word >> 26 {
        0x00 => special::special(fields),
        0x01 => system::immediate_conditions(fields),
        0x02 => Operation::J {
            target: word << 6 >> 4,
        },
        0x03 => Operation::Jal {
            target: word << 6 >> 4,
        },
        0x04..=0x07 => branch(fields),
        0x08..=0x0F => immediate(fields),
        0x10 => system::coprocessor_zero(fields),
        0x11 | 0x13 | 0x31 | 0x35 | 0x39 | 0x3D => {
            Operation::Uncommon(Uncommon::CoprocessorUnusable { unit: 1 })
        }
        0x12 | 0x32 | 0x36 | 0x3A | 0x3E => Operation::Uncommon(Uncommon::CoprocessorUnusable { unit: 2 }),
        0x14..=0x17 => Operation::Uncommon(branch_likely(fields)),
        0x1C => special::special2(fields),
        0x1F => special::special3(fields),
        0x20..=0x26 => load(fields),
        0x28..=0x2B | 0x2E => store(fields),
        // Without caches `cache` does nothing on this core; `pref` is a hint.
        0x2F | 0x33 => Operation::Nop,
        0x30 => Operation::Uncommon(Uncommon::Ll {
            rt: fields.rt_target(),
            base: fields.rs(),
            offset: fields.signed(),
        }),
        0x38 => Operation::Uncommon(Uncommon::Sc {
            rt: fields.rt(),
            to: fields.rt_target(),
            base: fields.rs(),
            offset: fields.signed(),
        }),
        _ => Operation::Uncommon(Uncommon::Reserved),
    }
}

fn branch(fields: InstructionFields) -> Operation {
    let (rs, rt, words) = (fields.rs(), fields.rt(), fields.words());
    match fields.0 >> 26 {
        0x04 => Operation::Beq { rs, rt, words },
        0x05 => Operation::Bne { rs, rt, words },
        0x06 => Operation::Blez { rs, words },
        _ => Operation::Bgtz { rs, words },
    }
}

fn branch_likely(fields: InstructionFields) -> Uncommon {
    let (condition, rt) = match fields.0 >> 26 {
        0x14 => (Condition::Equal, fields.rt()),
        0x15 => (Condition::NotEqual, fields.rt()),
        0x16 => (Condition::LessEqual, Source::new(0)),
        _ => (Condition::Greater, Source::new(0)),
    };
    Uncommon::BranchLikely {
        condition,
        rs: fields.rs(),
        rt,
        words: fields.signed(),
    }
}

fn immediate(fields: InstructionFields) -> Operation {
    let (rt, rs) = (fields.rt_target(), fields.rs());
    let value = fields.extended();
    let unsigned = fields.unsigned();
    match fields.0 >> 26 {
        0x08 => Operation::Uncommon(Uncommon::Addi {
            rt,
            rs,
            value: fields.signed(),
        }),
        0x09 => add_immediate(fields),
        0x0A => Operation::Slti {
            rt,
            rs,
            value: value.cast_signed(),
        },
        0x0B => Operation::Sltiu { rt, rs, value },
        0x0C => Operation::Andi {
            rt,
            rs,
            value: unsigned,
        },
        0x0D if rs.number() == 0 => Operation::Constant { rt, value: unsigned },
        0x0D => Operation::Ori {
            rt,
            rs,
            value: unsigned,
        },
        0x0E => Operation::Xori {
            rt,
            rs,
            value: unsigned,
        },
        _ => Operation::Constant {
            rt,
            value: unsigned << 16,
        },
    }
}

fn add_immediate(fields: InstructionFields) -> Operation {
    let (rt, rs, value) = (fields.rt_target(), fields.rs(), fields.extended());
    let is_stack = rs == Source::new(STACK_POINTER) && rt.is_read_by(rs);
    match rs.number() {
        0 => Operation::Constant { rt, value },
        _ if is_stack && fields.signed() < 0 => Operation::GrowStack {
            amount: value.wrapping_neg(),
        },
        _ => Operation::Addiu { rt, rs, value },
    }
}

fn load(fields: InstructionFields) -> Operation {
    let (base, offset) = (fields.rs(), fields.extended());
    let to = Loaded {
        rt: fields.rt_target(),
        stall: 0,
    };
    match fields.0 >> 26 {
        0x20 => Operation::Lb { to, base, offset },
        0x21 => Operation::Lh { to, base, offset },
        0x22 => Operation::Lwl { to, base, offset },
        0x23 => Operation::Lw { to, base, offset },
        0x24 => Operation::Lbu { to, base, offset },
        0x25 => Operation::Lhu { to, base, offset },
        _ => Operation::Lwr { to, base, offset },
    }
}

fn store(fields: InstructionFields) -> Operation {
    let (rt, base, offset) = (fields.rt(), fields.rs(), fields.extended());
    match fields.0 >> 26 {
        0x28 => Operation::Sb { rt, base, offset },
        0x29 => Operation::Sh { rt, base, offset },
        0x2A => Operation::Swl { rt, base, offset },
        0x2B => Operation::Sw { rt, base, offset },
        _ => Operation::Swr { rt, base, offset },
    }
}
