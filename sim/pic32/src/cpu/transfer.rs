//! Loads and stores of the inner loop, as far as they touch memory only.

use super::Cpu;
use super::inner::{Outcome, Region};
use super::open::{merge_left, merge_right, split_left, split_right};
use super::operation::Operation;
use super::registers::Source;
use crate::memory::Open;

impl Cpu {
    /// Loads and stores; gives the cycles that they take beyond one. Refused is what needs more than memory.
    #[inline(always)]
    #[rustfmt::skip]
    pub(super) fn access(&mut self, operation: &Operation, memory: &mut Open<'_>, region: Region) -> Outcome<u64> {
        let r = &self.registers;
        let at = |base: Source, offset: u32| r.get(base).wrapping_add(offset);
        let (rt, stall, loaded) = match *operation {
            Operation::Lw { rt, base, stall, offset } => (rt, stall, memory.load_u32(at(base, offset))),
            Operation::Lb { rt, base, stall, offset } => (rt, stall, memory.load_i8(at(base, offset))),
            Operation::Lbu { rt, base, stall, offset } => (rt, stall, memory.load_u8(at(base, offset))),
            Operation::Lh { rt, base, stall, offset } => (rt, stall, memory.load_i16(at(base, offset))),
            Operation::Lhu { rt, base, stall, offset } => (rt, stall, memory.load_u16(at(base, offset))),
            Operation::Lwl { rt, base, stall, offset } => {
                let address = at(base, offset);
                (rt, stall, memory.load_merged(address, |word| merge_left(address, word, r.before(rt))))
            }
            Operation::Lwr { rt, base, stall, offset } => {
                let address = at(base, offset);
                (rt, stall, memory.load_merged(address, |word| merge_right(address, word, r.before(rt))))
            }
            _ => return self.access_out(operation, memory),
        };
        let Some((value, is_flash)) = loaded else {
            return Outcome::Refused;
        };
        self.registers.set(rt, value);
        let wait = if is_flash { region.flash_wait } else { region.ram_wait };
        Outcome::Done(wait + u64::from(stall))
    }

    #[inline(always)]
    fn access_out(&self, operation: &Operation, memory: &mut Open<'_>) -> Outcome<u64> {
        let r = &self.registers;
        let at = |base: Source, offset: u32| r.get(base).wrapping_add(offset);
        let stored = match *operation {
            Operation::Sw { rt, base, offset } => memory.store(at(base, offset), r.get(rt).to_le_bytes()),
            Operation::Sh { rt, base, offset } => {
                memory.store(at(base, offset), (r.get(rt) as u16).to_le_bytes())
            }
            Operation::Sb { rt, base, offset } => memory.store(at(base, offset), [r.get(rt) as u8]),
            Operation::Swl { rt, base, offset } => {
                let address = at(base, offset);
                memory.change_word(address, |word| split_left(address, word, r.get(rt)))
            }
            Operation::Swr { rt, base, offset } => {
                let address = at(base, offset);
                memory.change_word(address, |word| split_right(address, word, r.get(rt)))
            }
            _ => return Outcome::Other,
        };
        match stored {
            Some(()) => Outcome::Done(0),
            None => Outcome::Refused,
        }
    }
}
