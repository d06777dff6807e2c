//! The four external interrupts: a flag each that follows a low level or remembers a falling edge.

/// TCON and XICON, one half: reacts to falling edges.
const EDGE: u8 = 0x01;
/// TCON and XICON: the flag.
const FLAG: u8 = 0x02;

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ExternalInput {
    by_edge: bool,
    flag: bool,
    is_high: bool,
}

impl ExternalInput {
    pub(super) fn new(is_high: bool) -> Self {
        Self {
            by_edge: false,
            flag: false,
            is_high,
        }
    }

    /// Its pin has this level now.
    pub(super) fn see(&mut self, is_high: bool) {
        self.flag |= self.by_edge && self.is_high && !is_high;
        self.is_high = is_high;
    }

    /// Whether it asks for an interrupt.
    pub(super) fn requests(&self) -> bool {
        if self.by_edge { self.flag } else { !self.is_high }
    }

    /// Whether its pin is low, which ends power-down.
    pub(super) fn is_low(&self) -> bool {
        !self.is_high
    }

    /// Its handler is called: a remembered edge is forgotten, a level is not.
    pub(super) fn acknowledge(&mut self) {
        self.flag = false;
    }

    /// Flag and kind, as the two lowest bits.
    pub(super) fn control(&self) -> u8 {
        let kind = if self.by_edge { EDGE } else { 0 };
        kind | if self.requests() { FLAG } else { 0 }
    }

    /// The program writes both; the flag of a level follows the pin again at once.
    pub(super) fn set_control(&mut self, bits: u8) {
        self.by_edge = bits & EDGE != 0;
        self.flag = bits & FLAG != 0;
    }
}
