//! Flash wait states, the prefetch cache and the bus matrix.

use crate::memory::{FlashTiming, Prefetch};

/// The cycles that a flash access takes limit the clock: 30 MHz for each.
const HZ_PER_ACCESS: u64 = 30_000_000;
const CHECON_WRITABLE: u32 = 0x0001_0337;
const RAM_WAIT: u32 = 1 << 6;
const BMXCON_WRITABLE: u32 = 0x041F_0047;
/// Words of the prefetch block; the one between CHEMIS and CHEPFABT does not exist.
const CACHE_WORDS: usize = 13;

/// The registers.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    cache: [u32; CACHE_WORDS],
    control: u32,
    /// BMXDKPBA, BMXDUDBA, BMXDUPBA.
    ram_partition: [u32; 3],
    user_flash: u32,
}

impl Matrix {
    pub(crate) fn new() -> Matrix {
        let mut cache = [0; CACHE_WORDS];
        cache[0] = 7;
        Matrix {
            cache,
            control: 0x001F_0041,
            ram_partition: [0; 3],
            user_flash: 0,
        }
    }

    pub(crate) fn read_cache(&self, word: u8) -> Option<u32> {
        self.cache.get(usize::from(word)).filter(|_| word != 11).copied()
    }

    pub(crate) fn write_cache(&mut self, word: u8, value: u32) {
        if let Some(place) = self.cache.get_mut(usize::from(word)) {
            *place = if word == 0 { value & CHECON_WRITABLE } else { value };
        }
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1..=3 => self.ram_partition[usize::from(word - 1)],
            4 => 0x8000,
            5 => self.user_flash,
            6 => 0x4_0000,
            7 => 0x3000,
            _ => return None,
        })
    }

    pub(crate) fn write(&mut self, word: u8, value: u32) {
        match word {
            0 => self.control = value & BMXCON_WRITABLE,
            // RAM is divided in steps of 2 KiB.
            1..=3 => self.ram_partition[usize::from(word - 1)] = value & 0xF800,
            5 => self.user_flash = value & 0x7_F800,
            _ => {}
        }
    }

    /// What CHECON says about flash.
    pub(crate) fn flash_timing(&self) -> FlashTiming {
        let control = self.cache[0];
        let prefetch = match control >> 4 & 3 {
            0 => Prefetch::Off,
            1 => Prefetch::Cached,
            2 => Prefetch::Uncached,
            _ => Prefetch::Both,
        };
        FlashTiming {
            wait_states: u8::try_from(control & 7).unwrap_or(7),
            prefetch,
        }
    }

    /// BMXCON.BMXWSDRM.
    pub(crate) fn ram_wait_states(&self) -> u8 {
        u8::from(self.control & RAM_WAIT != 0)
    }

    /// Offsets in RAM that may be executed in kernel mode: from BMXDKPBA to BMXDUDBA, and none while BMXDKPBA is 0.
    pub(crate) fn ram_code(&self) -> std::ops::Range<u32> {
        match self.ram_partition {
            [0, ..] => 0..0,
            [start, end, _] => start..end,
        }
    }

    /// Whether flash is read faster than it can at this system clock.
    pub(crate) fn is_too_fast(&self, system_hz: u64) -> bool {
        let accesses = u64::from(self.flash_timing().wait_states) + 1;
        system_hz > accesses * HZ_PER_ACCESS
    }
}
