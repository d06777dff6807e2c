//! Single bits: 128 in internal RAM from 0x20 on, and those of the registers whose address is a multiple of eight.

use super::operand::REGISTERS;
use super::{Bus, CARRY, Cpu};

/// First byte of internal RAM with addressable bits.
const BIT_RAM: u8 = 0x20;

/// A bit's byte, as a direct address, and its mask.
#[derive(Clone, Copy, Debug)]
struct BitPlace {
    byte: u8,
    mask: u8,
}

impl BitPlace {
    fn of(address: u8) -> Self {
        let byte = if address < REGISTERS {
            BIT_RAM + (address >> 3)
        } else {
            address & 0xF8
        };
        Self {
            byte,
            mask: 1 << (address & 7),
        }
    }
}

impl Cpu {
    /// Whether the carry is set.
    #[inline]
    pub(super) fn carry(&self) -> bool {
        self.psw & CARRY != 0
    }

    /// Sets or clears the carry.
    #[inline]
    pub(super) fn set_carry(&mut self, carry: bool) {
        self.psw = self.psw & !CARRY | if carry { CARRY } else { 0 };
    }

    /// Reads the bit whose address follows; of a port its pin.
    pub(super) fn fetch_bit<B: Bus>(&mut self, bus: &mut B) -> bool {
        let place = BitPlace::of(self.fetch());
        self.read(place.byte, bus) & place.mask != 0
    }

    /// Replaces the bit whose address follows by a function of it; of a port its latch. Says what it was.
    pub(super) fn change_bit<B: Bus>(&mut self, bus: &mut B, function: impl FnOnce(bool) -> bool) -> bool {
        let place = BitPlace::of(self.fetch());
        let mut was = false;
        self.change(place.byte, bus, |byte| {
            was = byte & place.mask != 0;
            if function(was) {
                byte | place.mask
            } else {
                byte & !place.mask
            }
        });
        was
    }
}
