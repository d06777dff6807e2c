//! Columns 0 to 5 of the instruction map, of which nearly every instruction is one of its kind.

use super::{Bus, CoreFault, Cpu, External};

impl Cpu {
    /// Conditional jumps, the stack, MOVX by DPTR.
    #[inline]
    pub(super) fn column_0<B: Bus>(&mut self, row: u8, bus: &mut B) {
        match row {
            0x0 => {}
            0x1 => {
                let was = self.change_bit(bus, |_| false);
                self.jump_if(was);
            }
            0x2 => {
                let bit = self.fetch_bit(bus);
                self.jump_if(bit);
            }
            0x3 => {
                let bit = self.fetch_bit(bus);
                self.jump_if(!bit);
            }
            0x4 => self.jump_if(self.carry()),
            0x5 => self.jump_if(!self.carry()),
            0x6 => self.jump_if(self.a == 0),
            0x7 => self.jump_if(self.a != 0),
            0x8 => self.jump_if(true),
            0x9 => {
                let value = self.fetch_word();
                self.set_dptr(value);
            }
            0xA => {
                let bit = self.fetch_bit(bus);
                self.set_carry(self.carry() | !bit);
            }
            0xB => {
                let bit = self.fetch_bit(bus);
                self.set_carry(self.carry() & !bit);
            }
            0xC => self.push_direct(bus),
            0xD => {
                let address = self.fetch();
                let value = self.pop();
                self.write(address, value, bus);
            }
            0xE => self.load_external(External::Long(self.dptr()), bus),
            _ => self.store_external(External::Long(self.dptr()), bus),
        }
    }

    /// Long jumps and returns, logic on a direct byte with A, single bits, MOVX by R0.
    #[inline]
    pub(super) fn column_2<B: Bus>(&mut self, row: u8, bus: &mut B) {
        let a = self.a;
        match row {
            0x0 => self.pc = self.fetch_word(),
            0x1 => self.call(bus),
            0x2 => self.return_from_call(),
            0x3 => {
                self.return_from_call();
                bus.end_interrupt();
            }
            0x4 => self.change_next(bus, |byte| byte | a),
            0x5 => self.change_next(bus, |byte| byte & a),
            0x6 => self.change_next(bus, |byte| byte ^ a),
            0x7 => {
                let bit = self.fetch_bit(bus);
                self.set_carry(self.carry() | bit);
            }
            0x8 => {
                let bit = self.fetch_bit(bus);
                self.set_carry(self.carry() & bit);
            }
            0x9 => {
                let carry = self.carry();
                self.change_bit(bus, |_| carry);
            }
            0xA => {
                let bit = self.fetch_bit(bus);
                self.set_carry(bit);
            }
            0xB => {
                self.change_bit(bus, |bit| !bit);
            }
            0xC => {
                self.change_bit(bus, |_| false);
            }
            0xD => {
                self.change_bit(bus, |_| true);
            }
            0xE => self.load_external(self.short(0), bus),
            _ => self.store_external(self.short(0), bus),
        }
    }

    fn change_next<B: Bus>(&mut self, bus: &mut B, function: impl FnOnce(u8) -> u8) {
        let address = self.fetch();
        self.change(address, bus, function);
    }

    /// Rotations, logic on a direct byte with a constant, MOVC, the carry, MOVX by R1.
    #[inline]
    pub(super) fn column_3<B: Bus>(&mut self, row: u8, bus: &mut B) {
        match row {
            0x0 => self.a = self.a.rotate_right(1),
            0x1 => self.rotate_right_through_carry(),
            0x2 => self.a = self.a.rotate_left(1),
            0x3 => self.rotate_left_through_carry(),
            0x4..=0x6 => self.logic_with_constant(row, bus),
            0x7 => self.pc = self.dptr().wrapping_add(u16::from(self.a)),
            0x8 => self.load_code(self.pc, bus),
            0x9 => self.load_code(self.dptr(), bus),
            0xA => self.set_dptr(self.dptr().wrapping_add(1)),
            0xB => self.set_carry(!self.carry()),
            0xC => self.set_carry(false),
            0xD => self.set_carry(true),
            0xE => self.load_external(self.short(1), bus),
            _ => self.store_external(self.short(1), bus),
        }
    }

    fn logic_with_constant<B: Bus>(&mut self, row: u8, bus: &mut B) {
        let address = self.fetch();
        let constant = self.fetch();
        self.change(address, bus, |byte| match row {
            0x4 => byte | constant,
            0x5 => byte & constant,
            _ => byte ^ constant,
        });
    }

    /// The accumulator, with a constant or alone.
    #[inline]
    pub(super) fn column_4(&mut self, row: u8) {
        match row {
            0x0 => self.a = self.a.wrapping_add(1),
            0x1 => self.a = self.a.wrapping_sub(1),
            0x2..=0x7 | 0x9 => {
                let constant = self.fetch();
                self.accumulate(row, constant);
            }
            0x8 => self.divide(),
            0xA => self.multiply(),
            0xB => {
                let constant = self.fetch();
                self.jump_if_unequal(self.a, constant);
            }
            0xC => self.a = self.a.rotate_left(4),
            0xD => self.adjust_decimal(),
            0xE => self.a = 0,
            _ => self.a = !self.a,
        }
    }

    /// What rows 2 to 7, 9 and 14 do with the accumulator and an operand of any kind.
    #[inline]
    pub(super) fn accumulate(&mut self, row: u8, operand: u8) {
        match row {
            0x2 => self.add(operand),
            0x3 => self.add_carry(operand),
            0x4 => self.a |= operand,
            0x5 => self.a &= operand,
            0x6 => self.a ^= operand,
            0x9 => self.subtract(operand),
            _ => self.a = operand,
        }
    }

    /// A direct byte.
    #[inline]
    pub(super) fn column_5<B: Bus>(&mut self, row: u8, bus: &mut B) {
        if row == 0xA {
            bus.note(CoreFault::ReservedInstruction, self.access_cycle());
            return;
        }
        let address = self.fetch();
        match row {
            0x0 => {
                self.change(address, bus, |byte| byte.wrapping_add(1));
            }
            0x1 => {
                self.change(address, bus, |byte| byte.wrapping_sub(1));
            }
            0x7 => {
                let constant = self.fetch();
                self.write(address, constant, bus);
            }
            0x8 => {
                let value = self.read(address, bus);
                let target = self.fetch();
                self.write(target, value, bus);
            }
            0xB => {
                let value = self.read(address, bus);
                self.jump_if_unequal(self.a, value);
            }
            0xC => {
                let value = self.read(address, bus);
                let a = std::mem::replace(&mut self.a, value);
                self.write(address, a, bus);
            }
            0xD => {
                let rest = self.change(address, bus, |byte| byte.wrapping_sub(1));
                self.jump_if(rest != 0);
            }
            0xF => self.write(address, self.a, bus),
            _ => {
                let value = self.read(address, bus);
                self.accumulate(row, value);
            }
        }
    }
}
