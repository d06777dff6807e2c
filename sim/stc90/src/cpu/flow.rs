//! Jumps, calls and returns.

use super::{Bus, Cpu};

impl Cpu {
    /// Jumps by the distance that follows, if so.
    #[inline]
    pub(super) fn jump_if(&mut self, condition: bool) {
        let distance = self.fetch() as i8;
        if condition {
            self.pc = self.pc.wrapping_add_signed(i16::from(distance));
        }
    }

    /// CJNE: jumps when they differ; the carry says that the first is less.
    #[inline]
    pub(super) fn jump_if_unequal(&mut self, first: u8, second: u8) {
        self.set_carry(first < second);
        self.jump_if(first != second);
    }

    /// Column 1: AJMP and ACALL, whose opcodes hold three bits of the address.
    #[inline]
    pub(super) fn absolute<B: Bus>(&mut self, opcode: u8, bus: &mut B) {
        let low = self.fetch();
        let page = u16::from(opcode & 0xE0) << 3;
        let target = self.pc & 0xF800 | page | u16::from(low);
        if opcode & 0x10 != 0 {
            self.push_pc(bus);
        }
        self.pc = target;
    }

    /// LCALL.
    pub(super) fn call<B: Bus>(&mut self, bus: &mut B) {
        let target = self.fetch_word();
        self.push_pc(bus);
        self.pc = target;
    }

    /// Puts the address of the next instruction on the stack, lower half first.
    pub(super) fn push_pc<B: Bus>(&mut self, bus: &mut B) {
        let [low, high] = self.pc.to_le_bytes();
        self.push(low, bus);
        self.push(high, bus);
    }

    /// RET.
    #[inline]
    pub(super) fn return_from_call(&mut self) {
        let high = self.pop();
        let low = self.pop();
        self.pc = u16::from_le_bytes([low, high]);
    }
}
