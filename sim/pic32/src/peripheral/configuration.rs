//! The configuration words DEVCFG0 to DEVCFG3, which are the last four words of boot flash.

/// Where the system clock comes from; the numbers are those of FNOSC, NOSC and COSC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Oscillator {
    /// The internal 8 MHz oscillator.
    Fast,
    /// The same through the PLL.
    FastPll,
    /// The crystal.
    Primary,
    /// The same through the PLL.
    PrimaryPll,
    /// The 32.768 kHz crystal, which this board does not have: its pins are used otherwise.
    Secondary,
    /// The internal 32 kHz oscillator.
    LowPower,
    /// The internal 8 MHz oscillator by 16.
    FastBy16,
    /// The internal 8 MHz oscillator by FRCDIV.
    FastDivided,
}

impl Oscillator {
    pub(crate) const fn of(field: u32) -> Oscillator {
        match field & 7 {
            0 => Oscillator::Fast,
            1 => Oscillator::FastPll,
            2 => Oscillator::Primary,
            3 => Oscillator::PrimaryPll,
            4 => Oscillator::Secondary,
            5 => Oscillator::LowPower,
            6 => Oscillator::FastBy16,
            _ => Oscillator::FastDivided,
        }
    }

    pub(crate) const fn field(self) -> u32 {
        self as u32
    }

    pub(crate) const fn needs_crystal(self) -> bool {
        matches!(self, Oscillator::Primary | Oscillator::PrimaryPll)
    }

    pub(crate) const fn has_pll(self) -> bool {
        matches!(self, Oscillator::FastPll | Oscillator::PrimaryPll)
    }
}

/// The words, by what they say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Configuration {
    words: [u32; 4],
}

impl Configuration {
    /// From the last 16 bytes of boot flash, which hold DEVCFG3 to DEVCFG0 in this order.
    pub(crate) fn of(bytes: [u8; 16]) -> Configuration {
        let all = u128::from_le_bytes(bytes);
        let word = |number: u32| (all >> (96 - 32 * number)) as u32;
        Configuration {
            words: [word(0), word(1), word(2), word(3)],
        }
    }

    const fn field(&self, word: usize, shift: u32, width: u32) -> u32 {
        self.words[word] >> shift & ((1 << width) - 1)
    }

    /// FNOSC.
    pub(crate) const fn oscillator(&self) -> Oscillator {
        Oscillator::of(self.field(1, 0, 3))
    }

    /// POSCMOD: whether there is a circuit for the crystal at all.
    pub(crate) const fn has_primary(&self) -> bool {
        self.field(1, 8, 2) != 3
    }

    /// POSCMOD XT or HS: both crystal pins are taken. With an external clock RC15 is free.
    pub(crate) const fn has_crystal(&self) -> bool {
        matches!(self.field(1, 8, 2), 1 | 2)
    }

    /// FPLLIDIV: by how much the PLL's input is divided.
    pub(crate) const fn pll_input_divider(&self) -> u64 {
        [1, 2, 3, 4, 5, 6, 10, 12][self.field(2, 0, 3) as usize]
    }

    /// FPLLMUL, as PLLMULT has it.
    pub(crate) const fn pll_multiplier_field(&self) -> u32 {
        self.field(2, 4, 3)
    }

    /// FPLLODIV, as PLLODIV has it.
    pub(crate) const fn pll_output_field(&self) -> u32 {
        self.field(2, 16, 3)
    }

    /// FPBDIV, as PBDIV has it.
    pub(crate) const fn peripheral_field(&self) -> u32 {
        self.field(1, 12, 2)
    }

    /// FCKSM: whether the program may change the clock.
    pub(crate) const fn may_switch(&self) -> bool {
        self.field(1, 14, 2) < 2
    }

    /// FCKSM: whether a clock that fails is replaced.
    pub(crate) const fn has_monitor(&self) -> bool {
        self.field(1, 14, 2) == 0
    }

    /// WDTPS: the watchdog barks after 2^n ms. Values above 20 count as 20.
    pub(crate) const fn watchdog_exponent(&self) -> u32 {
        let field = self.field(1, 16, 5);
        if field > 20 { 20 } else { field }
    }

    /// FWDTEN.
    pub(crate) const fn watchdog_always(&self) -> bool {
        self.field(1, 23, 1) == 1
    }

    /// BWP: whether boot flash can be programmed.
    pub(crate) const fn boot_is_writable(&self) -> bool {
        self.field(0, 24, 1) == 1
    }

    /// PWP: how many pages from the start of program flash cannot be programmed.
    pub(crate) const fn protected_pages(&self) -> u32 {
        0xFF - self.field(0, 12, 8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_original_settings_are_read_as_the_reference_says() {
        let words = 0x7FFF_FFFF_FF74_CEDB_FFF8_FFD9_FFFF_FFFFu128;
        let configuration = Configuration::of(words.to_le_bytes());
        assert_eq!(configuration.oscillator(), Oscillator::PrimaryPll);
        assert_eq!(configuration.pll_input_divider(), 2);
        assert_eq!(configuration.pll_multiplier_field(), 5);
        assert_eq!(configuration.pll_output_field(), 0);
        assert_eq!(configuration.peripheral_field(), 0);
        assert!(configuration.has_crystal() && !configuration.may_switch() && !configuration.has_monitor());
        assert!(!configuration.watchdog_always() && configuration.boot_is_writable());
        assert_eq!(
            (configuration.watchdog_exponent(), configuration.protected_pages()),
            (20, 0)
        );
    }
}
