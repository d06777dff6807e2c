//! Instructions of the inner loop that work on general registers, HI and LO.

use super::inner::Outcome;
use super::multiplier;
use super::operation::Operation;
use super::registers::{Source, Target};
use super::{Cpu, STACK_POINTER};

impl Cpu {
    /// Arithmetic on general registers.
    #[inline(always)]
    pub(super) fn compute(&mut self, operation: &Operation) -> Outcome<()> {
        let r = &mut self.registers;
        match *operation {
            Operation::Nop => {}
            Operation::Constant { rt, value } => r.set(rt, value),
            Operation::Addiu { rt, rs, value } => r.set(rt, r.get(rs).wrapping_add(value)),
            Operation::Addu { rd, rs, rt } => r.set(rd, r.get(rs).wrapping_add(r.get(rt))),
            Operation::Subu { rd, rs, rt } => r.set(rd, r.get(rs).wrapping_sub(r.get(rt))),
            Operation::And { rd, rs, rt } => r.set(rd, r.get(rs) & r.get(rt)),
            Operation::Or { rd, rs, rt } => r.set(rd, r.get(rs) | r.get(rt)),
            Operation::Xor { rd, rs, rt } => r.set(rd, r.get(rs) ^ r.get(rt)),
            Operation::Nor { rd, rs, rt } => r.set(rd, !(r.get(rs) | r.get(rt))),
            Operation::Andi { rt, rs, value } => r.set(rt, r.get(rs) & value),
            Operation::Ori { rt, rs, value } => r.set(rt, r.get(rs) | value),
            Operation::Xori { rt, rs, value } => r.set(rt, r.get(rs) ^ value),
            Operation::Slt { rd, rs, rt } => r.set(rd, u32::from(signed(r.get(rs)) < signed(r.get(rt)))),
            Operation::Sltu { rd, rs, rt } => r.set(rd, u32::from(r.get(rs) < r.get(rt))),
            Operation::Slti { rt, rs, value } => r.set(rt, u32::from(signed(r.get(rs)) < value)),
            Operation::Sltiu { rt, rs, value } => r.set(rt, u32::from(r.get(rs) < value)),
            Operation::Sll { rd, rt, shift } => r.set(rd, r.get(rt).wrapping_shl(u32::from(shift))),
            Operation::Srl { rd, rt, shift } => r.set(rd, r.get(rt).wrapping_shr(u32::from(shift))),
            Operation::Sra { rd, rt, shift } => r.set(rd, shift_signed(r.get(rt), u32::from(shift))),
            Operation::Rotr { rd, rt, shift } => r.set(rd, r.get(rt).rotate_right(u32::from(shift))),
            Operation::Sllv { rd, rs, rt } => r.set(rd, r.get(rt).wrapping_shl(r.get(rs))),
            Operation::Srlv { rd, rs, rt } => r.set(rd, r.get(rt).wrapping_shr(r.get(rs))),
            Operation::Srav { rd, rs, rt } => r.set(rd, shift_signed(r.get(rt), r.get(rs))),
            Operation::Rotrv { rd, rs, rt } => r.set(rd, r.get(rt).rotate_right(r.get(rs))),
            Operation::Ext { rt, rs, shift, mask } => r.set(rt, r.get(rs) >> (shift & 31) & mask),
            Operation::Ins { rt, rs, shift, mask } => {
                r.set(rt, r.get(rs) << (shift & 31) & mask | r.before(rt) & !mask);
            }
            Operation::Seb { rd, rt } => r.set(rd, i32::from(r.get(rt) as i8).cast_unsigned()),
            Operation::Seh { rd, rt } => r.set(rd, i32::from(r.get(rt) as i16).cast_unsigned()),
            Operation::Wsbh { rd, rt } => r.set(rd, r.get(rt).swap_bytes().rotate_right(16)),
            Operation::Clz { rd, rs } => r.set(rd, r.get(rs).leading_zeros()),
            Operation::Clo { rd, rs } => r.set(rd, r.get(rs).leading_ones()),
            Operation::Movz { rd, rs, rt } if r.get(rt) == 0 => r.set(rd, r.get(rs)),
            Operation::Movn { rd, rs, rt } if r.get(rt) != 0 => r.set(rd, r.get(rs)),
            Operation::Movz { .. } | Operation::Movn { .. } => {}
            Operation::GrowStack { amount } => {
                let low = r.get(Source::new(STACK_POINTER)).wrapping_sub(amount);
                r.set(Target::new(STACK_POINTER), low);
                self.deepest_stack = self.deepest_stack.min(low);
            }
            _ => return Outcome::Other,
        }
        Outcome::Done(())
    }

    /// Multiplications and divisions, HI and LO; gives the cycle at which the instruction ends.
    #[inline(always)]
    pub(super) fn multiply(&mut self, operation: &Operation, cycle: u64) -> Outcome<u64> {
        let r = &mut self.registers;
        let unit = &mut self.multiplier;
        Outcome::Done(match *operation {
            Operation::Mul { rd, rs, rt } => {
                let (product, cycles) = multiplier::product(r.get(rs), r.get(rt));
                r.set(rd, product);
                cycle + cycles
            }
            Operation::Multiply { kind, rs, rt } => unit.multiply(kind, (r.get(rs), r.get(rt)), cycle),
            Operation::Div { rs, rt } => unit.divide((r.get(rs), r.get(rt)), cycle),
            Operation::Divu { rs, rt } => unit.divide_unsigned((r.get(rs), r.get(rt)), cycle),
            Operation::Mfhi { rd } => {
                let (value, end) = unit.high(cycle);
                r.set(rd, value);
                end
            }
            Operation::Mflo { rd } => {
                let (value, end) = unit.low(cycle);
                r.set(rd, value);
                end
            }
            Operation::Mthi { rs } => {
                unit.set_high(r.get(rs));
                cycle
            }
            Operation::Mtlo { rs } => {
                unit.set_low(r.get(rs));
                cycle
            }
            _ => return Outcome::Other,
        })
    }
}

#[inline(always)]
fn signed(value: u32) -> i32 {
    value.cast_signed()
}

#[inline(always)]
fn shift_signed(value: u32, shift: u32) -> u32 {
    value.cast_signed().wrapping_shr(shift).cast_unsigned()
}
