//! The pins of the bus.

use super::{ActiveLevel, SELECT_1_HIGH, SELECT_2_HIGH};
use crate::gpio::{Input, Output, Pin};
use crate::word::RegisterWord;

/// PMD0 to PMD7. The port turns them to outputs while it writes.
pub type DataPins8 = (
    Pin<'E', 0, Input>,
    Pin<'E', 1, Input>,
    Pin<'E', 2, Input>,
    Pin<'E', 3, Input>,
    Pin<'E', 4, Input>,
    Pin<'E', 5, Input>,
    Pin<'E', 6, Input>,
    Pin<'E', 7, Input>,
);

/// PMD0 to PMD7, and PMD8 to PMD15.
pub type DataPins16 = (
    DataPins8,
    (
        Pin<'G', 0, Input>,
        Pin<'G', 1, Input>,
        Pin<'F', 1, Input>,
        Pin<'F', 0, Input>,
        Pin<'D', 12, Input>,
        Pin<'D', 13, Input>,
        Pin<'D', 6, Input>,
        Pin<'D', 7, Input>,
    ),
);

/// What one access moves: `u8` or `u16`.
pub trait BusWord: RegisterWord {
    /// MODE16.
    #[doc(hidden)]
    const WIDTH: u32;
}

impl BusWord for u8 {
    const WIDTH: u32 = 0;
}
impl BusWord for u16 {
    const WIDTH: u32 = 1 << 10;
}

/// The data lines for words of one length.
pub trait DataPins<W: BusWord> {}
impl DataPins<u8> for DataPins8 {}
impl DataPins<u16> for DataPins16 {}

/// The pin of an address line, PMA0 to PMA13.
pub trait AddressPin {
    /// The number of the line.
    const LINE: u8;
}

macro_rules! address_pins {
    ($($line:literal $port:literal $number:literal;)*) => {
        $(impl AddressPin for Pin<$port, $number, Output> {
            const LINE: u8 = $line;
        })*
    };
}

// Those of the 100-pin package.
address_pins! {
    0 'B' 15;
    1 'B' 14;
    2 'G' 9;
    3 'G' 8;
    4 'G' 7;
    5 'G' 6;
    6 'A' 10;
    7 'A' 9;
    8 'F' 5;
    9 'F' 4;
    10 'B' 13;
    11 'B' 12;
    12 'B' 11;
    13 'B' 10;
}

/// Lines that a master drives besides data and strobes, and keeps for good: addresses and up to two selects.
#[derive(Debug, Default)]
pub struct AddressLines {
    /// PTEN.
    pub(super) pins: u32,
    /// CSF and the polarities.
    pub(super) control: u32,
}

/// CSF.
const ONE_SELECT: u32 = 1 << 6;
const TWO_SELECTS: u32 = 2 << 6;

impl AddressLines {
    /// None.
    #[must_use]
    pub const fn none() -> Self {
        Self { pins: 0, control: 0 }
    }

    /// These and one more address line.
    #[must_use]
    pub fn with<P: AddressPin>(self, _pin: P) -> Self {
        Self {
            pins: self.pins | 1 << P::LINE,
            ..self
        }
    }

    /// These and PMCS1, which is active in accesses whose address has bit 14. With it, bit 15 is PMCS2.
    #[must_use]
    pub fn with_select_1(self, _pin: Pin<'D', 11, Output>, active: ActiveLevel) -> Self {
        Self {
            pins: self.pins | 1 << 14,
            control: self.control & !ONE_SELECT | TWO_SELECTS | active.bit(SELECT_1_HIGH),
        }
    }

    /// These and PMCS2, which is active in accesses whose address has bit 15.
    #[must_use]
    pub fn with_select_2(self, _pin: Pin<'D', 10, Output>, active: ActiveLevel) -> Self {
        let function = match self.control & TWO_SELECTS {
            0 => ONE_SELECT,
            both => both,
        };
        Self {
            pins: self.pins | 1 << 15,
            control: self.control | function | active.bit(SELECT_2_HIGH),
        }
    }
}
