//! Where operands are: internal RAM, special function registers, external memory, the stack.

use super::{BANK, Bus, CoreFault, Cpu, DPS, External};

/// Direct addresses from here on are special function registers.
pub(super) const REGISTERS: u8 = 0x80;

impl Cpu {
    /// Address in internal RAM of R0 to R7.
    #[inline]
    pub(super) fn register_place(&self, number: u8) -> u8 {
        self.psw & BANK | number & 7
    }

    /// Address in internal RAM that R0 or R1 holds.
    #[inline]
    pub(super) fn indirect_place(&self, number: u8) -> u8 {
        self.ram[usize::from(self.register_place(number & 1))]
    }

    /// Reads a direct address.
    #[inline]
    pub(super) fn read<B: Bus>(&mut self, address: u8, bus: &mut B) -> u8 {
        if address < REGISTERS {
            return self.ram[usize::from(address)];
        }
        self.register(address)
            .unwrap_or_else(|| bus.read(address, self.access_cycle()))
    }

    /// Reads a direct address that the instruction writes back.
    #[inline]
    pub(super) fn read_latch<B: Bus>(&mut self, address: u8, bus: &mut B) -> u8 {
        if address < REGISTERS {
            return self.ram[usize::from(address)];
        }
        self.register(address)
            .unwrap_or_else(|| bus.read_latch(address, self.access_cycle()))
    }

    /// Writes a direct address.
    #[inline]
    pub(super) fn write<B: Bus>(&mut self, address: u8, value: u8, bus: &mut B) {
        if address < REGISTERS {
            self.ram[usize::from(address)] = value;
        } else if !self.set_register(address, value) {
            bus.write(address, value, self.access_cycle());
        }
    }

    /// Replaces a direct address by a function of it.
    #[inline]
    pub(super) fn change<B: Bus>(&mut self, address: u8, bus: &mut B, function: impl FnOnce(u8) -> u8) -> u8 {
        let value = function(self.read_latch(address, bus));
        self.write(address, value, bus);
        value
    }

    /// Puts a byte on the stack.
    #[inline]
    pub(super) fn push<B: Bus>(&mut self, value: u8, bus: &mut B) {
        self.raise_stack(bus);
        self.ram[usize::from(self.sp)] = value;
    }

    /// PUSH: the stack pointer is raised before the byte is read.
    #[inline]
    pub(super) fn push_direct<B: Bus>(&mut self, bus: &mut B) {
        let address = self.fetch();
        self.raise_stack(bus);
        let value = self.read(address, bus);
        self.ram[usize::from(self.sp)] = value;
    }

    #[inline]
    fn raise_stack<B: Bus>(&mut self, bus: &mut B) {
        if self.sp == u8::MAX {
            bus.note(CoreFault::StackWrapped, self.access_cycle());
        }
        self.sp = self.sp.wrapping_add(1);
        self.sp_max = self.sp_max.max(self.sp);
    }

    /// Takes a byte from the stack.
    #[inline]
    pub(super) fn pop(&mut self) -> u8 {
        let value = self.ram[usize::from(self.sp)];
        self.sp = self.sp.wrapping_sub(1);
        value
    }

    /// The place that a MOVX with R0 or R1 means.
    pub(super) fn short(&self, number: u8) -> External {
        External::Short(self.ram[usize::from(self.register_place(number))])
    }

    /// MOVX to the accumulator.
    pub(super) fn load_external<B: Bus>(&mut self, place: External, bus: &mut B) {
        self.a = bus.read_external(place, self.access_cycle());
    }

    /// MOVX from the accumulator.
    pub(super) fn store_external<B: Bus>(&mut self, place: External, bus: &mut B) {
        bus.write_external(place, self.a, self.access_cycle());
    }

    /// Sets the selected DPTR.
    pub(super) fn set_dptr(&mut self, value: u16) {
        self.dptr[usize::from(self.auxr1 & DPS)] = value;
    }
}
