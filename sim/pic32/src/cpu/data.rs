//! Loads and stores in full: address translation, registers of the chip, and what is wrong with an address.

use super::exception::{ExceptionCode, InstructionFault};
use super::open::{merge_left, merge_right, split_left, split_right};
use super::operation::Operation;
use super::{Access, Bus, Cpu, Width};
use crate::memory::Memory;

/// The window of the special function registers.
const REGISTERS_START: u32 = 0x1F80_0000;
const REGISTERS_END: u32 = 0x1F90_0000;

/// Cycles that reading a special function register takes beyond one: the read crosses the bus matrix and the peripheral
/// bus. General knowledge, not confirmed by a source. Writes are buffered and take one.
const REGISTER_READ_CYCLES: u64 = 2;

impl Cpu {
    /// The physical address behind a virtual one, in fixed mapping. KUSEG is mapped to where this part has nothing, except
    /// at error level, where it is physical memory.
    pub(super) fn physical(&self, address: u32) -> Option<u32> {
        match address >> 29 {
            4 | 5 => Some(address & 0x1FFF_FFFF),
            0..=3 if self.system.is_error_level() => Some(address),
            _ => None,
        }
    }

    /// A load or store of any kind. The memory or register is changed, or a fault says why not.
    pub(super) fn transfer<B: Bus>(
        &mut self,
        operation: Operation,
        memory: &mut Memory,
        bus: &mut B,
    ) -> Result<(), InstructionFault> {
        let mut port = AddressSpace { memory, bus };
        let (to, value) = match operation {
            Operation::Lb { to, base, offset } => {
                let byte = self.load(&mut port, self.registers.sum(base, offset), Width::Byte)?;
                (to, i32::from(byte as i8).cast_unsigned())
            }
            Operation::Lbu { to, base, offset } => (
                to,
                self.load(&mut port, self.registers.sum(base, offset), Width::Byte)? & 0xFF,
            ),
            Operation::Lh { to, base, offset } => {
                let half = self.load(&mut port, self.registers.sum(base, offset), Width::Half)?;
                (to, i32::from(half as i16).cast_unsigned())
            }
            Operation::Lhu { to, base, offset } => (
                to,
                self.load(&mut port, self.registers.sum(base, offset), Width::Half)? & 0xFFFF,
            ),
            Operation::Lw { to, base, offset } => (
                to,
                self.load(&mut port, self.registers.sum(base, offset), Width::Word)?,
            ),
            Operation::Lwl { to, base, offset } => {
                let address = self.registers.sum(base, offset);
                let word = self.load(&mut port, address & !3, Width::Word)?;
                (to, merge_left(address, word, self.registers.before(to.rt)))
            }
            Operation::Lwr { to, base, offset } => {
                let address = self.registers.sum(base, offset);
                let word = self.load(&mut port, address & !3, Width::Word)?;
                (to, merge_right(address, word, self.registers.before(to.rt)))
            }
            _ => return self.transfer_out(operation, &mut port),
        };
        self.registers.set(to.rt, value);
        Ok(())
    }

    fn transfer_out<B: Bus>(
        &mut self,
        operation: Operation,
        port: &mut AddressSpace<'_, B>,
    ) -> Result<(), InstructionFault> {
        match operation {
            Operation::Sb { rt, base, offset } => {
                let value = self.registers.get(rt) & 0xFF;
                self.store(port, (self.registers.sum(base, offset), Width::Byte), value)
            }
            Operation::Sh { rt, base, offset } => {
                let value = self.registers.get(rt) & 0xFFFF;
                self.store(port, (self.registers.sum(base, offset), Width::Half), value)
            }
            Operation::Sw { rt, base, offset } => {
                let value = self.registers.get(rt);
                self.store(port, (self.registers.sum(base, offset), Width::Word), value)
            }
            Operation::Swl { rt, base, offset } => {
                let (address, value) = (self.registers.sum(base, offset), self.registers.get(rt));
                let word = self.load_for_store(port, address)?;
                self.store(
                    port,
                    (address & !3, Width::Word),
                    split_left(address, word, value),
                )
            }
            Operation::Swr { rt, base, offset } => {
                let (address, value) = (self.registers.sum(base, offset), self.registers.get(rt));
                let word = self.load_for_store(port, address)?;
                self.store(
                    port,
                    (address & !3, Width::Word),
                    split_right(address, word, value),
                )
            }
            // Only loads and stores come here.
            _ => Err(InstructionFault::plain(ExceptionCode::Reserved)),
        }
    }

    /// The word around an address, for a store of a part of it.
    fn load_for_store<B: Bus>(
        &mut self,
        port: &mut AddressSpace<'_, B>,
        address: u32,
    ) -> Result<u32, InstructionFault> {
        let before = self.cycle;
        let word = self.load(port, address & !3, Width::Word);
        self.cycle = before;
        word
    }

    /// Loads from anywhere.
    pub(super) fn load<B: Bus>(
        &mut self,
        port: &mut AddressSpace<'_, B>,
        address: u32,
        width: Width,
    ) -> Result<u32, InstructionFault> {
        if address & (width.bytes() - 1) != 0 {
            return Err(InstructionFault::at(ExceptionCode::AddressLoad, address));
        }
        let fault = InstructionFault::at(ExceptionCode::BusData, address);
        let physical = self.physical(address).ok_or(fault)?;
        if (REGISTERS_START..REGISTERS_END).contains(&physical) {
            let access = self.register_access(physical, width);
            self.cycle += REGISTER_READ_CYCLES;
            return port.bus.load(access).map_err(|_| fault);
        }
        let mut bytes = [0; 4];
        let wanted = bytes.get_mut(..width.bytes() as usize).unwrap_or_default();
        port.memory.read(physical, wanted).map_err(|_| fault)?;
        self.cycle += match physical {
            ..crate::memory::FLASH_START => u64::from(port.memory.ram_wait_states()),
            _ => u64::from(port.memory.flash_timing().wait_states),
        };
        Ok(u32::from_le_bytes(bytes))
    }

    /// Stores to RAM or a register; stores to flash are bus errors.
    pub(super) fn store<B: Bus>(
        &mut self,
        port: &mut AddressSpace<'_, B>,
        (address, width): (u32, Width),
        value: u32,
    ) -> Result<(), InstructionFault> {
        if address & (width.bytes() - 1) != 0 {
            return Err(InstructionFault::at(ExceptionCode::AddressStore, address));
        }
        let fault = InstructionFault::at(ExceptionCode::BusData, address);
        let physical = self.physical(address).ok_or(fault)?;
        if (REGISTERS_START..REGISTERS_END).contains(&physical) {
            let access = self.register_access(physical, width);
            return port.bus.store(access, value).map_err(|_| fault);
        }
        let bytes = value.to_le_bytes();
        let bytes = bytes.get(..width.bytes() as usize).unwrap_or_default();
        match physical {
            ..crate::memory::FLASH_START => port.memory.write(physical, bytes).map_err(|_| fault),
            _ => Err(fault),
        }
    }

    fn register_access(&self, address: u32, width: Width) -> Access {
        Access {
            address,
            width,
            cycle: self.cycle,
            pc: self.pc,
        }
    }
}

/// Everything that an address can lead to.
#[derive(Debug)]
pub(super) struct AddressSpace<'a, B> {
    pub(super) memory: &'a mut Memory,
    pub(super) bus: &'a mut B,
}
