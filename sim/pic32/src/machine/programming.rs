//! What a programmer does to the chip besides driving pins: reset held and released, debug mode, erasure, power.

use super::{FLASH_PAGES, HELD, Machine, configuration_of};
use crate::cpu::ProbeAccess;
use crate::memory::{BOOT_BYTES, BOOT_START, FLASH_START};
use crate::peripheral::{NvmOperation, PAGE_BYTES, ROW_BYTES, ResetSource};

/// A flash operation that lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct UnfinishedOperation {
    pub(super) operation: NvmOperation,
    pub(super) until: u64,
}

impl Machine {
    /// Resets the chip and holds it there: nothing runs until one of the two releases.
    pub fn hold_in_reset(&mut self) {
        self.reset(ResetSource::MasterClear);
        self.stalled_until = HELD;
    }

    /// Ends a reset that was held: the program starts.
    pub fn release_reset(&mut self) {
        self.reset(ResetSource::MasterClear);
    }

    /// Ends a reset that was held, into debug mode: the core waits for instructions of the probe.
    pub fn release_to_probe(&mut self) {
        self.reset(ResetSource::MasterClear);
        self.cpu.reset_to_probe();
    }

    /// Whether the core is in debug mode, waiting for the probe or working for it.
    pub fn is_debugging(&self) -> bool {
        self.cpu.is_debugging()
    }

    /// What the core wants of the probe.
    pub fn probe_access(&self) -> Option<ProbeAccess> {
        self.cpu.probe_access()
    }

    /// The probe completes what the core wants; `word` is what a read gets.
    pub fn complete_probe_access(&mut self, word: u32) {
        self.cpu.complete_probe_access(word);
    }

    /// Whether the configuration words forbid to read the chip from outside.
    pub fn is_code_protected(&self) -> bool {
        // DEVCFG0, the last word; CP is its bit 28.
        configuration_of(&self.memory)[15] & 0x10 == 0
    }

    /// Erases both flashes with the configuration words.
    pub fn erase_chip(&mut self) {
        for page in 0..FLASH_PAGES {
            self.erase(FLASH_START + page * PAGE_BYTES);
        }
        for page in 0..BOOT_BYTES as u32 / PAGE_BYTES {
            self.erase(BOOT_START + page * PAGE_BYTES);
        }
    }

    /// The supply fails and comes back at once. RAM holds anything then. A page or row that was being erased or programmed holds
    /// anything, too; `seed` says what.
    pub fn power_cut(&mut self, seed: u64) {
        let mut random = home::Pcg::new(seed, 0x00B0_7104);
        if let Some(unfinished) = self.unfinished.take().filter(|one| one.until > self.cycle) {
            let (start, length) = place_of(unfinished.operation);
            let mut bytes = vec![0; length];
            if self.memory.read(start, &mut bytes).is_ok() {
                for byte in &mut bytes {
                    *byte ^= random.next_u32() as u8;
                }
                let written = self.memory.write(start, &bytes);
                debug_assert!(written.is_ok(), "it could be read");
            }
        }
        for byte in self.memory.ram_mut() {
            *byte = random.next_u32() as u8;
        }
        self.reset(ResetSource::PowerOn);
    }
}

fn place_of(operation: NvmOperation) -> (u32, usize) {
    match operation {
        NvmOperation::Word { address, .. } => (address, 4),
        NvmOperation::Row { address, .. } => (address, ROW_BYTES as usize),
        NvmOperation::Page { address } => (address, PAGE_BYTES as usize),
        NvmOperation::All => (FLASH_START, (FLASH_PAGES * PAGE_BYTES) as usize),
    }
}
