//! The flash controller: the program programs its own flash, a word, a row or a page at a time.

use super::configuration::Configuration;
use super::rate::Rate;
use super::system::Lock;

/// A flash operation that may begin. Addresses are physical.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NvmOperation {
    /// One word.
    Word { address: u32, value: u32 },
    /// 512 bytes out of RAM.
    Row { address: u32, source: u32 },
    /// 4096 bytes are erased.
    Page { address: u32 },
    /// All of program flash is erased.
    All,
}

/// Bytes of a row.
pub(crate) const ROW_BYTES: u32 = 512;
/// Bytes of a page.
pub(crate) const PAGE_BYTES: u32 = 4096;

impl NvmOperation {
    /// How long it takes, in microseconds. General knowledge of the family; the longest of each range.
    const fn duration_us(self) -> u64 {
        match self {
            NvmOperation::Word { .. } => 40,
            NvmOperation::Row { .. } => 4_500,
            NvmOperation::Page { .. } => 20_000,
            NvmOperation::All => 80_000,
        }
    }

    pub(crate) const fn cycles(self) -> u64 {
        Rate::from_hz(1_000_000).cycles_for(self.duration_us())
    }

    const fn address(self) -> u32 {
        match self {
            NvmOperation::Word { address, .. }
            | NvmOperation::Row { address, .. }
            | NvmOperation::Page { address } => address,
            NvmOperation::All => PROGRAM_START,
        }
    }
}

const PROGRAM_START: u32 = 0x1D00_0000;
const PROGRAM_END: u32 = 0x1D04_0000;
const BOOT_START: u32 = 0x1FC0_0000;
const BOOT_END: u32 = 0x1FC0_3000;

const BUSY: u32 = 1 << 15;
const ENABLED: u32 = 1 << 14;
const FAILED: u32 = 1 << 13;
/// The detector of low voltage needs this long after WREN; general knowledge of the family.
const DETECTOR_CYCLES: u64 = Rate::from_hz(1_000_000).cycles_for(6);

/// What a write to the block led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Started {
    /// Nothing.
    Nothing,
    /// An operation begins.
    Operation(NvmOperation),
    /// WR was set without the keys: nothing begins.
    WithoutKeys,
    /// WR was set sooner than 6 us after WREN: the operation begins all the same here.
    TooSoon(NvmOperation),
}

/// The registers.
#[derive(Clone, Debug)]
pub(crate) struct Nvm {
    control: u32,
    key: Lock,
    address: u32,
    data: u32,
    source: u32,
    enabled_at: u64,
}

impl Nvm {
    pub(crate) fn new() -> Nvm {
        Nvm {
            control: 0,
            key: Lock::Closed,
            address: 0,
            data: 0,
            source: 0,
            enabled_at: 0,
        }
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => 0,
            2 => self.address,
            3 => self.data,
            4 => self.source,
            _ => return None,
        })
    }

    pub(crate) fn write(&mut self, word: u8, value: u32, now: (u64, &Configuration)) -> Started {
        match word {
            0 => return self.write_control(value, now),
            1 => self.key = self.key.after(value),
            2 => self.address = value,
            3 => self.data = value,
            _ => self.source = value,
        }
        Started::Nothing
    }

    fn write_control(&mut self, value: u32, (cycle, configuration): (u64, &Configuration)) -> Started {
        let key = std::mem::replace(&mut self.key, Lock::Closed);
        if self.control & BUSY != 0 {
            return Started::Nothing;
        }
        if value & ENABLED != 0 && self.control & ENABLED == 0 {
            self.enabled_at = cycle;
        }
        // Errors are cleared by the next operation.
        self.control = self.control & FAILED | value & (ENABLED | 0xF);
        if value & BUSY == 0 || value & ENABLED == 0 {
            return Started::Nothing;
        }
        if key != Lock::Open {
            return Started::WithoutKeys;
        }
        self.control &= !FAILED;
        match self
            .operation()
            .filter(|operation| is_allowed(*operation, configuration))
        {
            None => {
                self.control |= FAILED;
                Started::Nothing
            }
            Some(operation) => {
                self.control |= BUSY;
                let soon = cycle < self.enabled_at + DETECTOR_CYCLES;
                if soon {
                    Started::TooSoon(operation)
                } else {
                    Started::Operation(operation)
                }
            }
        }
    }

    fn operation(&self) -> Option<NvmOperation> {
        let aligned = |bytes: u32| self.address & !(bytes - 1);
        Some(match self.control & 0xF {
            1 => NvmOperation::Word {
                address: aligned(4),
                value: self.data,
            },
            3 => NvmOperation::Row {
                address: aligned(ROW_BYTES),
                source: self.source,
            },
            4 => NvmOperation::Page {
                address: aligned(PAGE_BYTES),
            },
            5 => NvmOperation::All,
            _ => return None,
        })
    }

    /// The operation is over.
    pub(crate) fn finish(&mut self) {
        self.control &= !BUSY;
    }

    /// It could not be done after all: a row source outside of RAM.
    pub(crate) fn fail(&mut self) {
        self.control |= FAILED;
    }
}

fn is_allowed(operation: NvmOperation, configuration: &Configuration) -> bool {
    match operation.address() {
        address @ PROGRAM_START..PROGRAM_END => {
            let page = (address - PROGRAM_START) / PAGE_BYTES;
            page >= configuration.protected_pages()
        }
        BOOT_START..BOOT_END => configuration.boot_is_writable(),
        _ => false,
    }
}
