//! One instruction of the inner loop: a flat `match`, of which the compiler makes one jump table.

use super::inner::{After, ExecutionContext, Region};
use super::multiplier::{Multiplier, product};
use super::operation::{Loaded, Operation};
use super::registers::{Registers, Source, WriteTarget};
use super::{Cpu, STACK_POINTER};

impl Cpu {
    /// Executes an instruction.
    #[inline(always)]
    #[rustfmt::skip]
    pub(super) fn perform(&mut self, operation: &Operation, scene: &mut ExecutionContext<'_>) -> After {
        let (r, at, region, memory) = (&mut self.registers, scene.at, scene.region, &mut scene.memory);
        match *operation {
            Operation::Nop => {}
            Operation::Constant { rt, value } => r.set(rt, value),
            Operation::Addiu { rt, rs, value } => r.set(rt, r.sum(rs, value)),
            Operation::Addu { rd, rs, rt } => r.set(rd, r.get(rs).wrapping_add(r.get(rt))),
            Operation::Subu { rd, rs, rt } => r.set(rd, r.get(rs).wrapping_sub(r.get(rt))),
            Operation::And { rd, rs, rt } => r.set(rd, r.get(rs) & r.get(rt)),
            Operation::Or { rd, rs, rt } => r.set(rd, r.get(rs) | r.get(rt)),
            Operation::Xor { rd, rs, rt } => r.set(rd, r.get(rs) ^ r.get(rt)),
            Operation::Nor { rd, rs, rt } => r.set(rd, !(r.get(rs) | r.get(rt))),
            Operation::Andi { rt, rs, value } => r.set(rt, r.get(rs) & value),
            Operation::Ori { rt, rs, value } => r.set(rt, r.get(rs) | value),
            Operation::Xori { rt, rs, value } => r.set(rt, r.get(rs) ^ value),
            Operation::Slt { rd, rs, rt } => r.set(rd, u32::from(r.signed(rs) < r.signed(rt))),
            Operation::Sltu { rd, rs, rt } => r.set(rd, u32::from(r.get(rs) < r.get(rt))),
            Operation::Slti { rt, rs, value } => r.set(rt, u32::from(r.signed(rs) < value)),
            Operation::Sltiu { rt, rs, value } => r.set(rt, u32::from(r.get(rs) < value)),
            Operation::Sll { rd, rt, shift } => r.set(rd, r.get(rt).wrapping_shl(u32::from(shift))),
            Operation::Srl { rd, rt, shift } => r.set(rd, r.get(rt).wrapping_shr(u32::from(shift))),
            Operation::Sra { rd, rt, shift } => r.set(rd, r.signed(rt).wrapping_shr(u32::from(shift)).cast_unsigned()),
            Operation::Rotr { rd, rt, shift } => r.set(rd, r.get(rt).rotate_right(u32::from(shift))),
            Operation::Sllv { rd, rs, rt } => r.set(rd, r.get(rt).wrapping_shl(r.get(rs))),
            Operation::Srlv { rd, rs, rt } => r.set(rd, r.get(rt).wrapping_shr(r.get(rs))),
            Operation::Srav { rd, rs, rt } => r.set(rd, r.signed(rt).wrapping_shr(r.get(rs)).cast_unsigned()),
            Operation::Rotrv { rd, rs, rt } => r.set(rd, r.get(rt).rotate_right(r.get(rs))),
            Operation::Ext { rt, rs, shift, mask } => r.set(rt, r.get(rs) >> (shift & 31) & mask),
            Operation::Ins { rt, rs, shift, mask } => r.set(rt, r.get(rs) << (shift & 31) & mask | r.before(rt) & !mask),
            Operation::Seb { rd, rt } => r.set(rd, i32::from(r.get(rt) as i8).cast_unsigned()),
            Operation::Seh { rd, rt } => r.set(rd, i32::from(r.get(rt) as i16).cast_unsigned()),
            Operation::Wsbh { rd, rt } => r.set(rd, r.get(rt).swap_bytes().rotate_right(16)),
            Operation::Clz { rd, rs } => r.set(rd, r.get(rs).leading_zeros()),
            Operation::Clo { rd, rs } => r.set(rd, r.get(rs).leading_ones()),
            Operation::Movz { rd, rs, rt } => if r.get(rt) == 0 { r.set(rd, r.get(rs)) },
            Operation::Movn { rd, rs, rt } => if r.get(rt) != 0 { r.set(rd, r.get(rs)) },
            Operation::GrowStack { amount } => grow_stack(r, amount, &mut self.deepest_stack),
            Operation::Lw { to, base, offset } => return loaded(memory.load_u32(r.sum(base, offset)), to, region, r),
            Operation::Lb { to, base, offset } => return loaded(memory.load_i8(r.sum(base, offset)), to, region, r),
            Operation::Lbu { to, base, offset } => return loaded(memory.load_u8(r.sum(base, offset)), to, region, r),
            Operation::Lh { to, base, offset } => return loaded(memory.load_i16(r.sum(base, offset)), to, region, r),
            Operation::Lhu { to, base, offset } => return loaded(memory.load_u16(r.sum(base, offset)), to, region, r),
            Operation::Lwl { to, base, offset } => return loaded(memory.load_left(r.sum(base, offset), r.before(to.rt)), to, region, r),
            Operation::Lwr { to, base, offset } => return loaded(memory.load_right(r.sum(base, offset), r.before(to.rt)), to, region, r),
            Operation::Sw { rt, base, offset } => return stored(memory.store(r.sum(base, offset), r.get(rt).to_le_bytes())),
            Operation::Sh { rt, base, offset } => return stored(memory.store(r.sum(base, offset), (r.get(rt) as u16).to_le_bytes())),
            Operation::Sb { rt, base, offset } => return stored(memory.store(r.sum(base, offset), [r.get(rt) as u8])),
            Operation::Swl { rt, base, offset } => return stored(memory.store_left(r.sum(base, offset), r.get(rt))),
            Operation::Swr { rt, base, offset } => return stored(memory.store_right(r.sum(base, offset), r.get(rt))),
            Operation::Beq { rs, rt, words } => return branch(r.get(rs) == r.get(rt), at, words),
            Operation::Bne { rs, rt, words } => return branch(r.get(rs) != r.get(rt), at, words),
            Operation::Blez { rs, words } => return branch(r.signed(rs) <= 0, at, words),
            Operation::Bgtz { rs, words } => return branch(r.signed(rs) > 0, at, words),
            Operation::Bltz { rs, words } => return branch(r.signed(rs) < 0, at, words),
            Operation::Bgez { rs, words } => return branch(r.signed(rs) >= 0, at, words),
            Operation::J { target } => return After::Jump(region.jump(target)),
            Operation::Jal { target } => return link(r, WriteTarget::new(31), region.link(at), region.jump(target)),
            Operation::Jr { rs } => return After::Jump(region.index(r.get(rs))),
            Operation::Jalr { rd, rs } => return link(r, rd, region.link(at), region.index(r.get(rs))),
            Operation::Mul { .. } | Operation::Multiply { .. } | Operation::Div { .. } | Operation::Divu { .. }
            | Operation::Mfhi { .. } | Operation::Mflo { .. } | Operation::Mthi { .. } | Operation::Mtlo { .. } => {
                return After::Wait(multiply(operation, r, &mut self.multiplier, scene.end));
            }
            Operation::Uncommon(_) => return After::Refused,
        }
        After::Next
    }
}

#[inline(always)]
fn grow_stack(r: &mut Registers, amount: u32, deepest: &mut u32) {
    let low = r.get(Source::new(STACK_POINTER)).wrapping_sub(amount);
    r.set(WriteTarget::new(STACK_POINTER), low);
    *deepest = low.min(*deepest);
}

/// Puts what was loaded into its register.
#[inline(always)]
fn loaded(found: Option<(u32, bool)>, to: Loaded, region: Region, r: &mut Registers) -> After {
    let Some((value, is_flash)) = found else {
        return After::Refused;
    };
    r.set(to.rt, value);
    let wait = if is_flash {
        region.flash_wait
    } else {
        region.ram_wait
    };
    After::Wait(wait + u64::from(to.stall))
}

#[inline(always)]
fn stored(done: Option<()>) -> After {
    match done {
        Some(()) => After::Next,
        None => After::Refused,
    }
}

#[inline(always)]
fn branch(is_taken: bool, at: usize, words: i32) -> After {
    match is_taken {
        true => After::Jump(at.wrapping_add_signed(words as isize)),
        false => After::Slot,
    }
}

#[inline(always)]
fn link(r: &mut Registers, to: WriteTarget, address: u32, target: usize) -> After {
    r.set(to, address);
    After::Jump(target)
}

/// Multiplications and divisions, HI and LO; gives the cycles for which the instruction waits.
#[inline(always)]
fn multiply(operation: &Operation, r: &mut Registers, unit: &mut Multiplier, end: u64) -> u64 {
    match *operation {
        Operation::Mul { rd, rs, rt } => {
            let (product, cycles) = product(r.get(rs), r.get(rt));
            r.set(rd, product);
            cycles
        }
        Operation::Multiply { kind, rs, rt } => unit.multiply(kind, (r.get(rs), r.get(rt)), end),
        Operation::Div { rs, rt } => unit.divide((r.get(rs), r.get(rt)), end),
        Operation::Divu { rs, rt } => unit.divide_unsigned((r.get(rs), r.get(rt)), end),
        Operation::Mfhi { rd } => {
            r.set(rd, unit.high());
            unit.wait(end)
        }
        Operation::Mflo { rd } => {
            r.set(rd, unit.low());
            unit.wait(end)
        }
        Operation::Mthi { rs } => {
            unit.set_high(r.get(rs));
            0
        }
        Operation::Mtlo { rs } => {
            unit.set_low(r.get(rs));
            0
        }
        // The others are not asked for here.
        _ => 0,
    }
}
