//! What is decided outside of the program: the crystal, and the options that a flasher writes.

/// Clocks of a machine cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockMode {
    /// Six clocks: 6T.
    Six,
    /// Twelve clocks, as the first 8051 had.
    Twelve,
}

impl ClockMode {
    /// How many.
    #[must_use]
    pub const fn clocks(self) -> u32 {
        match self {
            ClockMode::Six => 6,
            ClockMode::Twelve => 12,
        }
    }
}

/// Crystal and options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Frequency of the crystal.
    pub crystal_hz: u32,
    /// Option byte, bit 0.
    pub clock_mode: ClockMode,
    /// Option byte, bit 7: the watchdog runs from power-up on.
    pub watchdog_at_power_up: bool,
    /// How long the boot loader looks for its host before it starts the program. What the chip needs is not known.
    pub loader_cycles: u64,
}

impl Options {
    /// As the Relax is said to be set up: 30 MHz and 6T.
    pub const RELAX: Self = Self {
        crystal_hz: 30_000_000,
        clock_mode: ClockMode::Six,
        watchdog_at_power_up: false,
        loader_cycles: 0,
    };

    /// Machine cycles in a second.
    #[must_use]
    pub fn cycles_per_s(&self) -> f64 {
        f64::from(self.crystal_hz) / f64::from(self.clock_mode.clocks())
    }
}
