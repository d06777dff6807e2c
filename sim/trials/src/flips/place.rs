//! Locations of flipped bits.

use home::Pcg;
use pic32::machine::Machine;
use serde::Serialize;

/// Kind of storage of a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BitStorage {
    /// RAM that the program uses: its variables, and the stack down to the deepest place it has reached.
    Ram,
    /// Flash that the image fills, boot flash, configuration words and calibration record included.
    Flash,
    /// General registers, HI and LO, and the program counter.
    Core,
    /// Registers of the chip's peripherals.
    Chip,
}

impl BitStorage {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Ram, Self::Flash, Self::Core, Self::Chip];

    /// A name for tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ram => "RAM",
            Self::Flash => "flash",
            Self::Core => "core registers",
            Self::Chip => "chip registers",
        }
    }
}

/// One bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct BitLocation {
    /// Its storage.
    pub storage: BitStorage,
    /// Physical address of its word; of a core register its number (32 HI, 33 LO, 34 the program counter).
    pub address: u32,
    /// Bit of the word, 0 to 31.
    pub bit: u8,
}

const HIGH: u32 = 32;
const LOW: u32 = 33;
const PROGRAM_COUNTER: u32 = 34;

/// Physical addresses.
const RAM_BYTES: u32 = 0x8000;
const PROGRAM: std::ops::Range<u32> = 0x1D00_0000..0x1D04_0000;
const BOOT: std::ops::Range<u32> = 0x1FC0_0000..0x1FC0_3000;
const REGISTERS: std::ops::Range<u32> = 0x1F80_0000..0x1F89_0000;
/// The calibration record and the configuration words.
const CALIBRATION: u32 = 0x1D03_F000;
const CONFIGURATION: u32 = 0x1FC0_2FF0;
/// Distance of registers; between them are their CLR, SET and INV.
const REGISTER_STEP: usize = 16;
/// Percentages of flips in RAM, flash and the core's registers; the rest hit registers of the chip.
const SHARES: [u32; 3] = [45, 45, 5];

/// All words in which bits are flipped.
#[derive(Clone, Debug)]
pub(super) struct BitLocations {
    ram: Vec<u32>,
    flash: Vec<u32>,
    chip: Vec<u32>,
}

impl BitLocations {
    /// The words of a machine whose program has run for a while, and whose variables end at this physical address.
    #[must_use]
    pub(super) fn of(machine: &mut Machine, variables_end: u32) -> Self {
        let stack = machine.deepest_stack().unwrap_or(RAM_BYTES) & 0x7FFC;
        let filled = |address: &u32| {
            let mut word = [0; 4];
            machine.memory().read(*address, &mut word).is_ok() && word != [0xFF; 4]
        };
        let words = PROGRAM.step_by(4).chain(BOOT.step_by(4));
        let flash = words.filter(filled).collect();
        let chip = REGISTERS.step_by(REGISTER_STEP);
        Self {
            ram: (0..variables_end)
                .step_by(4)
                .chain((stack..RAM_BYTES).step_by(4))
                .collect(),
            flash,
            chip: chip
                .filter(|address| machine.peek_register(*address).is_some())
                .collect(),
        }
    }

    /// Registers of the chip.
    #[must_use]
    pub(super) fn chip(&self) -> &[u32] {
        &self.chip
    }

    /// Any bit, each of its storage alike.
    pub(super) fn draw(&self, random: &mut Pcg) -> BitLocation {
        let [ram, flash, core] = SHARES;
        let number = random.below(100);
        let mut any = |words: &[u32]| {
            let number = random.below(words.len().max(1) as u32) as usize;
            words.get(number).copied().unwrap_or_default()
        };
        let (storage, address) = match number {
            _ if number < ram => (BitStorage::Ram, any(&self.ram)),
            _ if number < ram + flash => (BitStorage::Flash, any(&self.flash)),
            _ if number < ram + flash + core => (BitStorage::Core, 1 + random.below(PROGRAM_COUNTER)),
            _ => (BitStorage::Chip, any(&self.chip)),
        };
        BitLocation {
            storage,
            address,
            bit: random.below(32) as u8,
        }
    }
}

impl BitLocation {
    /// Whether it belongs to what the firmware checks of its image: all but configuration words and calibration record.
    #[must_use]
    pub(super) const fn is_in_image(self) -> bool {
        matches!(self.storage, BitStorage::Flash)
            && (self.address < CALIBRATION || self.address >= BOOT.start && self.address < CONFIGURATION)
    }

    /// Physical address of its byte.
    #[must_use]
    pub(super) fn byte(self) -> u32 {
        self.address + u32::from(self.bit / 8)
    }

    /// Flips it.
    pub(super) fn flip(self, machine: &mut Machine) {
        let mask = 1 << self.bit;
        let byte = self.byte();
        match self.storage {
            // The places were taken from the machine itself, so they are there.
            BitStorage::Ram => machine.flip_ram_bit(byte, self.bit % 8).unwrap_or_default(),
            BitStorage::Flash => machine.flip_flash_bit(byte, self.bit % 8).unwrap_or_default(),
            BitStorage::Core => self.flip_core(machine, mask),
            BitStorage::Chip => {
                let value = machine.peek_register(self.address).unwrap_or_default();
                machine.write_register(self.address, value ^ mask);
            }
        }
    }

    fn flip_core(self, machine: &mut Machine, mask: u32) {
        let core = machine.cpu_mut();
        let (high, low) = core.product();
        match self.address {
            HIGH => core.set_product(high ^ mask, low),
            LOW => core.set_product(high, low ^ mask),
            PROGRAM_COUNTER => core.set_pc(core.pc() ^ mask),
            number => {
                let number = number as u8;
                core.set_register(number, core.register(number) ^ mask);
            }
        }
    }
}
