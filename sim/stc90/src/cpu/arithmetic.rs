//! Arithmetic and its flags.

use super::{CARRY, Cpu, HALF_CARRY, OVERFLOW};

impl Cpu {
    #[inline]
    fn set_flags(&mut self, [carry, half, overflow]: [bool; 3]) {
        self.psw &= !(CARRY | HALF_CARRY | OVERFLOW);
        self.psw |= if carry { CARRY } else { 0 };
        self.psw |= if half { HALF_CARRY } else { 0 };
        self.psw |= if overflow { OVERFLOW } else { 0 };
    }

    /// ADD.
    #[inline]
    pub(super) fn add(&mut self, operand: u8) {
        self.add_with(operand, 0);
    }

    /// ADDC.
    #[inline]
    pub(super) fn add_carry(&mut self, operand: u8) {
        self.add_with(operand, u8::from(self.carry()));
    }

    #[inline]
    fn add_with(&mut self, operand: u8, carry: u8) {
        let sum = u16::from(self.a) + u16::from(operand) + u16::from(carry);
        let half = (self.a & 0x0F) + (operand & 0x0F) + carry > 0x0F;
        let result = sum as u8;
        let overflow = (self.a ^ result) & (operand ^ result) & 0x80 != 0;
        self.set_flags([sum > 0xFF, half, overflow]);
        self.a = result;
    }

    /// SUBB.
    #[inline]
    pub(super) fn subtract(&mut self, operand: u8) {
        let borrow = u8::from(self.carry());
        let result = self.a.wrapping_sub(operand).wrapping_sub(borrow);
        let carry = u16::from(self.a) < u16::from(operand) + u16::from(borrow);
        let half = self.a & 0x0F < (operand & 0x0F) + borrow;
        let overflow = (self.a ^ operand) & (self.a ^ result) & 0x80 != 0;
        self.set_flags([carry, half, overflow]);
        self.a = result;
    }

    /// MUL AB: overflow says that the product needs B.
    pub(super) fn multiply(&mut self) {
        let [low, high] = (u16::from(self.a) * u16::from(self.b)).to_le_bytes();
        (self.a, self.b) = (low, high);
        self.psw &= !(CARRY | OVERFLOW);
        self.psw |= if high == 0 { 0 } else { OVERFLOW };
    }

    /// DIV AB. By zero it sets overflow; A and B are undefined then, and stay as they are, like in uCsim.
    pub(super) fn divide(&mut self) {
        self.psw &= !(CARRY | OVERFLOW);
        match (self.a.checked_div(self.b), self.a.checked_rem(self.b)) {
            (Some(quotient), Some(rest)) => (self.a, self.b) = (quotient, rest),
            _ => self.psw |= OVERFLOW,
        }
    }

    /// DA: makes the sum of two packed decimal numbers one again. It can set the carry and never clears it.
    pub(super) fn adjust_decimal(&mut self) {
        let mut sum = u16::from(self.a);
        if sum & 0x0F > 9 || self.psw & HALF_CARRY != 0 {
            sum += 6;
        }
        let carry = self.carry() || sum > 0xFF;
        if sum & 0x1F0 > 0x90 || self.carry() {
            sum += 0x60;
        }
        self.set_carry(carry || sum > 0xFF);
        self.a = sum as u8;
    }

    /// RLC.
    pub(super) fn rotate_left_through_carry(&mut self) {
        let carry = u8::from(self.carry());
        self.set_carry(self.a & 0x80 != 0);
        self.a = self.a << 1 | carry;
    }

    /// RRC.
    pub(super) fn rotate_right_through_carry(&mut self) {
        let carry = u8::from(self.carry());
        self.set_carry(self.a & 1 != 0);
        self.a = self.a >> 1 | carry << 7;
    }
}
