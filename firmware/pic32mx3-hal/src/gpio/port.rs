//! Whole ports.

use super::Level;
use crate::register::map::{AD1PCFG, port_direction, port_input, port_latch, port_open_drain};

/// A port. Its functions need no ownership of pins: they take or change many bits in one access, and serve code that runs
/// when the program is broken. Nothing keeps them from disturbing a pin that has an owner; memory remains safe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Port {
    /// RA
    A = 0,
    /// RB
    B = 1,
    /// RC
    C = 2,
    /// RD
    D = 3,
    /// RE
    E = 4,
    /// RF
    F = 5,
    /// RG
    G = 6,
}

impl Port {
    /// All ports.
    pub const ALL: [Self; 7] = [Self::A, Self::B, Self::C, Self::D, Self::E, Self::F, Self::G];

    /// The port of a letter, A to G.
    #[must_use]
    pub const fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'A' => Self::A,
            'B' => Self::B,
            'C' => Self::C,
            'D' => Self::D,
            'E' => Self::E,
            'F' => Self::F,
            'G' => Self::G,
            _ => return None,
        })
    }

    const fn index(self) -> u32 {
        self as u32
    }

    /// The levels of its pins, whatever their direction; analog pins read as low. It also informs the change notice that
    /// these levels are known now.
    #[inline(always)]
    #[must_use]
    pub fn read(self) -> u16 {
        port_input(self.index()).read() as u16
    }

    /// The levels its outputs shall have.
    #[inline(always)]
    #[must_use]
    pub fn latch(self) -> u16 {
        port_latch(self.index()).read() as u16
    }

    /// Makes the outputs in `bits` high.
    #[inline(always)]
    pub fn set(self, bits: u16) {
        port_latch(self.index()).set(u32::from(bits));
    }

    /// Makes the outputs in `bits` low.
    #[inline(always)]
    pub fn clear(self, bits: u16) {
        port_latch(self.index()).clear(u32::from(bits));
    }

    /// Changes the level of the outputs in `bits`.
    #[inline(always)]
    pub fn invert(self, bits: u16) {
        port_latch(self.index()).invert(u32::from(bits));
    }

    /// Gives the outputs in `mask` the levels in `values`: each bit changes at most once, those that become low first.
    #[inline(always)]
    pub fn write(self, mask: u16, values: u16) {
        self.clear(mask & !values);
        self.set(mask & values);
    }

    /// Gives one output a level.
    #[inline(always)]
    pub fn put(self, number: u8, level: Level) {
        match level {
            Level::Low => self.clear(1 << number),
            Level::High => self.set(1 << number),
        }
    }

    /// Lets go of the pins in `bits`: they become inputs.
    #[inline(always)]
    pub fn release(self, bits: u16) {
        port_direction(self.index()).set(u32::from(bits));
    }

    /// Makes the pins in `bits` outputs; their latches should have been set before.
    #[inline(always)]
    pub fn drive(self, bits: u16) {
        port_direction(self.index()).clear(u32::from(bits));
    }

    /// Which pins are outputs.
    #[must_use]
    pub fn driven(self) -> u16 {
        !(port_direction(self.index()).read() as u16)
    }

    /// Makes the outputs in `bits` open drain: they pull down and never up.
    pub fn set_open_drain(self, bits: u16) {
        port_open_drain(self.index()).set(u32::from(bits));
    }

    /// Makes the outputs in `bits` ordinary ones.
    pub fn clear_open_drain(self, bits: u16) {
        port_open_drain(self.index()).clear(u32::from(bits));
    }

    /// Makes the pins in `bits` digital. Only those of port B have an analog side.
    pub fn make_digital(self, bits: u16) {
        if self == Self::B {
            AD1PCFG.set(u32::from(bits));
        }
    }

    /// Makes the pins in `bits` analog: they read as low. Only those of port B have an analog side.
    pub fn make_analog(self, bits: u16) {
        if self == Self::B {
            AD1PCFG.clear(u32::from(bits));
        }
    }
}
