//! Both comparators and the reference voltage. Levels are looked at every 300 ns, which is also how long an output takes to follow.

use super::rate::NEVER;
use crate::pins::{Level, Pin, Port, known};

/// C1OUT and C2OUT.
pub(crate) const OUTPUT_PINS: [Pin; 2] = [known(Port::B, 8), known(Port::B, 9)];
/// The inverting and the other input of each, by analog channel.
const MINUS: [u8; 2] = [4, 2];
const PLUS: [u8; 2] = [5, 3];

const ON: u32 = 1 << 15;
const OUTPUT_ENABLED: u32 = 1 << 14;
const INVERTED: u32 = 1 << 13;
const OUTPUT: u32 = 1 << 8;
const RISES: u32 = 1 << 6;
const FALLS: u32 = 1 << 7;
const PLUS_IS_REFERENCE: u32 = 1 << 4;
const WRITABLE: u32 = 0xE0D3;
const RESET: u32 = 0x00C3;
const STATUS_WRITABLE: u32 = 1 << 13;

const REFERENCE_LOW: u32 = 1 << 5;
const REFERENCE_PINS: u32 = 1 << 4;
const REFERENCE_WRITABLE: u32 = 0x807F;

/// General knowledge of the family says 150 to 400 ns.
const RESPONSE_CYCLES: u64 = 24;
/// The supply in counts of the analog converter.
const SUPPLY: u32 = 1023;
/// Levels are compared in parts of a count, so that steps of the reference (24ths and 32nds of the supply) are whole numbers.
const PARTS: u32 = 96;
/// 1.2 V of 3.3 V.
const INTERNAL: u32 = SUPPLY * PARTS * 12 / 33;

/// What one input of a comparator is connected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ComparatorInput {
    Channel(u8),
    /// A voltage of the chip, in parts of a count.
    Parts(u32),
}

impl ComparatorInput {
    /// Its level, with that of the channel as the converter would see it.
    pub(crate) fn parts(self, sample: impl FnOnce(u8) -> u16) -> u32 {
        match self {
            ComparatorInput::Channel(channel) => u32::from(sample(channel).min(1023)) * PARTS,
            ComparatorInput::Parts(parts) => parts,
        }
    }
}

/// The registers and outputs.
#[derive(Clone, Debug)]
pub(crate) struct Comparators {
    controls: [u32; 2],
    status: u32,
    reference: u32,
    outputs: [bool; 2],
    due: u64,
}

impl Comparators {
    pub(crate) fn new() -> Comparators {
        Comparators {
            controls: [RESET; 2],
            status: 0,
            reference: 0,
            outputs: [false; 2],
            due: NEVER,
        }
    }

    fn is_on(&self, number: u8) -> bool {
        self.controls[usize::from(number)] & ON != 0
    }

    pub(crate) fn next_event(&self) -> u64 {
        self.due
    }

    /// Both inputs of one that is on: the other one's first.
    pub(crate) fn inputs(&self, number: u8) -> Option<(ComparatorInput, ComparatorInput)> {
        let own = usize::from(number);
        let control = self.controls[own];
        let plus = match control & PLUS_IS_REFERENCE {
            0 => ComparatorInput::Channel(PLUS[own]),
            _ => ComparatorInput::Parts(self.reference_parts()),
        };
        let minus = match control & 3 {
            0 => ComparatorInput::Channel(MINUS[own]),
            1 => ComparatorInput::Channel(PLUS[own]),
            2 => ComparatorInput::Channel(PLUS[1 - own]),
            _ => ComparatorInput::Parts(INTERNAL),
        };
        self.is_on(number).then_some((plus, minus))
    }

    /// The reference: 24ths of the supply, or a quarter and 32nds.
    fn reference_parts(&self) -> u32 {
        let steps = self.reference & 15;
        match self.reference & (ON | REFERENCE_LOW) {
            ON => SUPPLY * (PARTS / 4 + steps * PARTS / 32),
            low if low & ON != 0 => SUPPLY * steps * PARTS / 24,
            _ => 0,
        }
    }

    /// The reference is to come from pins.
    pub(crate) fn has_other_reference(&self) -> bool {
        self.reference & (ON | REFERENCE_PINS) == ON | REFERENCE_PINS
    }

    /// Whether plus is above minus now; `true` when that is an interrupt.
    pub(crate) fn follow(&mut self, number: u8, above: bool) -> bool {
        let place = usize::from(number);
        let control = self.controls[place];
        let high = above != (control & INVERTED != 0);
        let before = std::mem::replace(&mut self.outputs[place], high);
        let wanted = if high { RISES } else { FALLS };
        high != before && control & wanted != 0
    }

    /// They are looked at again.
    pub(crate) fn next_look(&mut self, cycle: u64) {
        let any = self.is_on(0) || self.is_on(1);
        self.due = if any { cycle + RESPONSE_CYCLES } else { NEVER };
    }

    /// What one does to its pin.
    pub(crate) fn output(&self, number: u8) -> Option<Level> {
        let place = usize::from(number);
        let both = ON | OUTPUT_ENABLED;
        (self.controls[place] & both == both).then(|| Level::of(self.outputs[place]))
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        match word {
            0 | 1 => {
                let place = usize::from(word);
                Some(self.controls[place] | flag(self.outputs[place], OUTPUT))
            }
            6 => Some(self.status | flag(self.outputs[0], 1) | flag(self.outputs[1], 2)),
            _ => None,
        }
    }

    pub(crate) fn read_reference(&self) -> u32 {
        self.reference
    }

    pub(crate) fn write(&mut self, word: u8, value: u32, cycle: u64) {
        match word {
            0 | 1 => {
                let place = usize::from(word);
                self.controls[place] = value & WRITABLE;
                if value & ON == 0 {
                    self.outputs[place] = false;
                }
                self.next_look(cycle);
            }
            6 => self.status = value & STATUS_WRITABLE,
            _ => {}
        }
    }

    pub(crate) fn write_reference(&mut self, value: u32) {
        self.reference = value & REFERENCE_WRITABLE;
    }
}
