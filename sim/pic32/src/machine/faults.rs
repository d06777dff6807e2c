//! Faults injected into the machine: flipped bits, a dead crystal, a supply that is too low for a moment.

use super::Machine;
use crate::memory::{FLASH_START, OutsideMemory};
use crate::peripheral::ResetSource;

impl Machine {
    /// Flips bit 0..=7 of the byte of RAM at a physical address or at its KSEG0 or KSEG1 alias.
    ///
    /// # Errors
    /// When the address is not in RAM.
    pub fn flip_ram_bit(&mut self, address: u32, bit: u8) -> Result<(), OutsideMemory> {
        let physical = address & 0x1FFF_FFFF;
        if physical >= FLASH_START {
            return Err(OutsideMemory {
                address: physical,
                length: 1,
            });
        }
        self.flip(physical, bit)
    }

    /// Flips bit 0..=7 of the byte of program or boot flash at a physical address or at its KSEG0 or KSEG1 alias.
    /// Configuration words act at the next reset.
    ///
    /// # Errors
    /// When the address is not in flash.
    pub fn flip_flash_bit(&mut self, address: u32, bit: u8) -> Result<(), OutsideMemory> {
        let physical = address & 0x1FFF_FFFF;
        if physical < FLASH_START {
            return Err(OutsideMemory {
                address: physical,
                length: 1,
            });
        }
        self.flip(physical, bit)
    }

    fn flip(&mut self, physical: u32, bit: u8) -> Result<(), OutsideMemory> {
        let mut byte = [0];
        self.memory.read(physical, &mut byte)?;
        byte[0] ^= 1 << (bit & 7);
        self.memory.write(physical, &byte)
    }

    /// The crystal stops. What follows is up to the configuration words: the clock monitor goes over to the internal
    /// oscillator and interrupts, or core and peripherals stand still, with outputs as they are, until the watchdog
    /// resets.
    pub fn fail_oscillator(&mut self) {
        self.chip.fail_crystal(self.cycle);
    }

    /// Flash takes nothing any more: each operation ends with an error and changes nothing.
    pub fn wear_out_flash(&mut self) {
        self.is_worn_out = true;
    }

    /// The supply was too low for a moment: a reset. RAM keeps its contents here; on the chip it need not.
    pub fn brown_out(&mut self) {
        self.reset(ResetSource::BrownOut);
    }
}
