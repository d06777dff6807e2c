//! Access times of flash.

/// When the prefetch unit helps instruction fetches (CHECON.PREFEN).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefetch {
    /// Never.
    Off,
    /// Through KSEG0.
    Cached,
    /// Through KSEG1.
    Uncached,
    /// Through both.
    Both,
}

/// What CHECON says about flash accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashTiming {
    /// Cycles that a flash access takes beyond one, 0..=7.
    pub wait_states: u8,
    /// When they are hidden.
    pub prefetch: Prefetch,
}

impl FlashTiming {
    /// CHECON = 0x0000_0007.
    pub const AFTER_RESET: Self = Self {
        wait_states: 7,
        prefetch: Prefetch::Off,
    };

    /// From the value of CHECON: PFMWS in bits 2:0, PREFEN in bits 5:4.
    pub const fn from_register(checon: u32) -> Self {
        Self {
            wait_states: checon as u8 & 7,
            prefetch: match checon >> 4 & 3 {
                0 => Prefetch::Off,
                1 => Prefetch::Cached,
                2 => Prefetch::Uncached,
                _ => Prefetch::Both,
            },
        }
    }

    /// Whether fetches through the segment of a virtual address are prefetched.
    pub(crate) const fn prefetches(self, address: u32) -> bool {
        let cached = address >> 29 == 4;
        match self.prefetch {
            Prefetch::Off => false,
            Prefetch::Cached => cached,
            Prefetch::Uncached => !cached,
            Prefetch::Both => true,
        }
    }
}
