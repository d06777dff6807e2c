//! The configuration words DEVCFG0 to DEVCFG3 (section 3): which clock the chip starts with, the watchdog, protection.
//!
//! ```
//! use pic32mx3_hal::configuration::{Configuration, PrimaryOscillator};
//! use pic32mx3_hal::configuration;
//!
//! /// An 8 MHz crystal, 80 MHz for everything, the monitor of the clock on.
//! const CONFIGURATION: Configuration = Configuration::new()
//!     .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
//!     .pll_to_80_mhz()
//!     .clock_monitor(true)
//!     .watchdog_period_ms(128);
//! configuration!(CONFIGURATION);
//! assert_eq!(CONFIGURATION.clocks().system_hz, 80_000_000);
//! ```
//!
//! What does not fit together does not compile: an input of the PLL outside of 4 to 5 MHz, more than 80 MHz.

use crate::clock::Clocks;

mod choices;
pub use choices::{
    InputDivider, Multiplier, OscillatorSource, OutputDivider, PeripheralDivider, PrimaryOscillator,
};

/// All four words. Begins as an erased chip with the debugger off: internal oscillator divided, no PLL, nothing protected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    user_id: u16,
    source: OscillatorSource,
    primary: PrimaryOscillator,
    crystal_hz: u32,
    input_divider: InputDivider,
    multiplier: Multiplier,
    output_divider: OutputDivider,
    peripheral_divider: PeripheralDivider,
    secondary_oscillator: bool,
    two_speed_start: bool,
    clock_monitor: bool,
    clock_switching: bool,
    watchdog_always: bool,
    watchdog_exponent: u8,
    debug_on_pair_2: bool,
}

/// Bits without meaning are ones.
const DEVCFG3_UNUSED: u32 = 0xFFFF_0000;
const DEVCFG2_UNUSED: u32 = 0xFFF8_7888 | 0x8700;
const DEVCFG1_UNUSED: u32 = 0xFF60_0858;
/// With write and code protection off (PWP, BWP and CP all ones), bit 31 zero, and the debugger off.
const DEVCFG0_UNPROTECTED: u32 = 0x6EF0_0FF4 | 0x110F_F000 | 0b11;
const INTERNAL_HZ: u32 = 8_000_000;

impl Configuration {
    /// The internal 8 MHz oscillator, everything optional off.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            user_id: 0xFFFF,
            source: OscillatorSource::Internal,
            primary: PrimaryOscillator::Off,
            crystal_hz: 0,
            input_divider: InputDivider::By2,
            multiplier: Multiplier::Times20,
            output_divider: OutputDivider::By1,
            peripheral_divider: PeripheralDivider::By1,
            secondary_oscillator: false,
            two_speed_start: true,
            clock_monitor: false,
            clock_switching: false,
            watchdog_always: false,
            watchdog_exponent: 20,
            debug_on_pair_2: true,
        }
    }

    /// A number for free use, readable from outside.
    #[must_use]
    pub const fn user_id(mut self, user_id: u16) -> Self {
        self.user_id = user_id;
        self
    }

    /// A crystal or clock on OSC1, in Hz, as source of the system clock without PLL.
    #[must_use]
    pub const fn primary_oscillator(mut self, kind: PrimaryOscillator, hz: u32) -> Self {
        self.primary = kind;
        self.crystal_hz = hz;
        self.source = OscillatorSource::Primary;
        self
    }

    /// Puts the PLL behind the present source.
    #[must_use]
    pub const fn pll(mut self, input: InputDivider, multiplier: Multiplier, output: OutputDivider) -> Self {
        self.source = match self.source {
            OscillatorSource::Primary | OscillatorSource::PrimaryPll => OscillatorSource::PrimaryPll,
            _ => OscillatorSource::InternalPll,
        };
        self.input_divider = input;
        self.multiplier = multiplier;
        self.output_divider = output;
        self
    }

    /// The PLL from 8 MHz to 80 MHz: / 2 x 20 / 1.
    #[must_use]
    pub const fn pll_to_80_mhz(self) -> Self {
        self.pll(InputDivider::By2, Multiplier::Times20, OutputDivider::By1)
    }

    /// Another source of the system clock.
    #[must_use]
    pub const fn oscillator(mut self, source: OscillatorSource) -> Self {
        self.source = source;
        self
    }

    /// How much slower than the processor the peripherals run.
    #[must_use]
    pub const fn peripheral_divider(mut self, divider: PeripheralDivider) -> Self {
        self.peripheral_divider = divider;
        self
    }

    /// Whether the 32 kHz oscillator takes RC13 and RC14.
    #[must_use]
    pub const fn secondary_oscillator(mut self, on: bool) -> Self {
        self.secondary_oscillator = on;
        self
    }

    /// Whether the program begins with the internal oscillator, ten times slower, until the crystal swings and the PLL is in
    /// step ([`crate::clock::pll_is_locked`]). On in an erased chip. Off, the chip waits, and a dead crystal keeps it from
    /// starting at all.
    #[must_use]
    pub const fn two_speed_start(mut self, on: bool) -> Self {
        self.two_speed_start = on;
        self
    }

    /// Whether the chip goes on with its internal oscillator when the clock fails, and asks for an interrupt. Includes
    /// clock switching.
    #[must_use]
    pub const fn clock_monitor(mut self, on: bool) -> Self {
        self.clock_monitor = on;
        self
    }

    /// Whether the program may change the clock source.
    #[must_use]
    pub const fn clock_switching(mut self, on: bool) -> Self {
        self.clock_switching = on;
        self
    }

    /// The watchdog's period: the greatest power of two that is not above `period_ms`, from 1 ms to 17 minutes. Its clock
    /// is not exact: see [`crate::watchdog`].
    #[must_use]
    pub const fn watchdog_period_ms(mut self, period_ms: u32) -> Self {
        assert!(period_ms > 0, "a watchdog without a period would reset at once");
        let exponent = period_ms.ilog2();
        self.watchdog_exponent = if exponent > 20 { 20 } else { exponent as u8 };
        self
    }

    /// The watchdog runs from the start and cannot be stopped.
    #[must_use]
    pub const fn watchdog_always(mut self) -> Self {
        self.watchdog_always = true;
        self
    }

    /// Debugger and programmer use PGC1 and PGD1 (RB1, RB0) instead of the second pair (RB6, RB7).
    #[must_use]
    pub const fn programming_pair_1(mut self) -> Self {
        self.debug_on_pair_2 = false;
        self
    }

    pub(crate) const fn source(&self) -> OscillatorSource {
        self.source
    }

    /// Multiplier, divider behind the PLL and the peripherals' divider, as OSCCON has them.
    pub(crate) const fn dividers(&self) -> (u32, u32, u32) {
        (
            self.multiplier as u32,
            self.output_divider as u32,
            self.peripheral_divider as u32,
        )
    }

    /// The frequencies that come of it. Fails (to compile, in a constant) when they are impossible.
    #[must_use]
    pub const fn clocks(&self) -> Clocks {
        let input = match self.source {
            OscillatorSource::Primary | OscillatorSource::PrimaryPll => self.crystal_hz,
            OscillatorSource::Secondary => 32_768,
            OscillatorSource::LowPower => 31_250,
            _ => INTERNAL_HZ,
        };
        let system_hz = match self.source {
            OscillatorSource::PrimaryPll | OscillatorSource::InternalPll => {
                let reference = input / self.input_divider.factor();
                assert!(
                    reference >= 4_000_000 && reference <= 5_000_000,
                    "the input of the PLL must be 4 to 5 MHz"
                );
                reference * self.multiplier.factor() / self.output_divider.factor()
            }
            OscillatorSource::InternalBy16 => input / 16,
            // FRCDIV is 2 after a reset.
            OscillatorSource::InternalDivided => input / 2,
            _ => input,
        };
        assert!(system_hz <= 80_000_000, "the chip runs at 80 MHz at most");
        Clocks {
            system_hz,
            peripheral_hz: system_hz / self.peripheral_divider.factor(),
        }
    }

    /// The words in the order of their addresses: DEVCFG3, 2, 1, 0.
    #[must_use]
    pub const fn words(&self) -> [u32; 4] {
        let _ = self.clocks();
        let devcfg3 = DEVCFG3_UNUSED | self.user_id as u32;
        let devcfg2 = DEVCFG2_UNUSED
            | self.input_divider as u32
            | ((self.multiplier as u32) << 4)
            | ((self.output_divider as u32) << 16);
        let monitor = match (self.clock_monitor, self.clock_switching) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => 3,
        };
        let devcfg1 = DEVCFG1_UNUSED
            | self.source as u32
            | ((self.secondary_oscillator as u32) << 5)
            | ((self.two_speed_start as u32) << 7)
            | ((self.primary as u32) << 8)
            // OSCIOFNC: no clock on RC15.
            | (1 << 10)
            | ((self.peripheral_divider as u32) << 12)
            | (monitor << 14)
            | ((self.watchdog_exponent as u32) << 16)
            | ((self.watchdog_always as u32) << 23);
        let devcfg0 = DEVCFG0_UNPROTECTED | ((self.debug_on_pair_2 as u32) << 3);
        [devcfg3, devcfg2, devcfg1, devcfg0]
    }
}

impl Default for Configuration {
    fn default() -> Self {
        Self::new()
    }
}

/// Puts a [`Configuration`] into the image, at 0x1FC02FF0.
#[macro_export]
macro_rules! configuration {
    ($configuration:expr) => {
        const _: () = {
            #[cfg_attr(target_arch = "mips", unsafe(link_section = ".devcfg"))]
            #[cfg_attr(target_arch = "mips", unsafe(no_mangle))]
            #[used]
            static DEVCFG: [u32; 4] = $crate::configuration::Configuration::words(&$configuration);
        };
    };
}

#[cfg(test)]
mod tests {
    use super::{Configuration, PrimaryOscillator};

    const ROBOT: Configuration = Configuration::new()
        .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
        .pll_to_80_mhz();

    /// Section 3 computes these four words from the settings of an older program: the same clock, no monitor, watchdog by
    /// software with 2^20. Two-speed start-up is on there as here.
    #[test]
    fn known_settings_give_the_known_words() {
        assert_eq!(
            ROBOT.words(),
            [0xFFFF_FFFF, 0xFFF8_FFD9, 0xFF74_CEDB, 0x7FFF_FFFF]
        );
        assert_eq!(ROBOT.clocks().system_hz, 80_000_000);
        assert_eq!(ROBOT.clocks().peripheral_hz, 80_000_000);
    }

    #[test]
    fn each_setting_changes_its_own_bits_only() {
        let base = ROBOT.words();
        let changed = |configuration: Configuration| {
            let words = configuration.words();
            [0, 1, 2, 3].map(|index: usize| words[index] ^ base[index])
        };
        assert_eq!(changed(ROBOT.clock_monitor(true)), [0, 0, 0xC000, 0]);
        assert_eq!(changed(ROBOT.clock_switching(true)), [0, 0, 0x8000, 0]);
        assert_eq!(changed(ROBOT.watchdog_period_ms(128)), [0, 0, 0x0013_0000, 0]);
        assert_eq!(changed(ROBOT.watchdog_always()), [0, 0, 0x0080_0000, 0]);
        assert_eq!(changed(ROBOT.secondary_oscillator(true)), [0, 0, 0x20, 0]);
        assert_eq!(changed(ROBOT.two_speed_start(false)), [0, 0, 0x80, 0]);
        assert_eq!(changed(ROBOT.programming_pair_1()), [0, 0, 0, 8]);
        assert_eq!(changed(ROBOT.user_id(0x1234)), [0xEDCB, 0, 0, 0]);
    }
}
