//! Change notice: one interrupt for 22 pins, asserted while a pin differs from what its port showed when it was last read.

use crate::pins::Port;

const ON: u32 = 1 << 15;
const CONTROL_WRITABLE: u32 = 0xE000;
const INPUTS: u32 = (1 << 22) - 1;

/// The registers and the reference.
#[derive(Clone, Debug)]
pub(crate) struct ChangeNotice {
    control: u32,
    enabled: u32,
    pull_ups: u32,
    /// Levels at the last reading of each pin's port.
    reference: u32,
    levels: u32,
}

impl ChangeNotice {
    pub(crate) fn new() -> ChangeNotice {
        ChangeNotice {
            control: 0,
            enabled: 0,
            pull_ups: 0,
            reference: 0,
            levels: 0,
        }
    }

    /// After a reset; what pins showed stays.
    pub(crate) fn reset(&mut self) {
        *self = ChangeNotice {
            reference: self.reference,
            levels: self.levels,
            ..ChangeNotice::new()
        };
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => self.enabled,
            2 => self.pull_ups,
            _ => return None,
        })
    }

    pub(crate) fn write(&mut self, word: u8, value: u32) {
        match word {
            0 => self.control = value & CONTROL_WRITABLE,
            1 => self.enabled = value & INPUTS,
            _ => self.pull_ups = value & INPUTS,
        }
    }

    /// Which bits of a port have their pull-up on.
    pub(crate) fn pull_ups(&self, port: Port) -> u16 {
        to_port(self.pull_ups, port)
    }

    /// The inputs of a port have these levels now.
    pub(crate) fn set_levels(&mut self, port: Port, levels: u16) {
        self.levels = self.levels & !inputs_of(port) | from_port(levels, port);
    }

    /// The program has read the port: its levels are the reference now.
    pub(crate) fn note_read(&mut self, port: Port) {
        let mask = inputs_of(port);
        self.reference = self.reference & !mask | self.levels & mask;
    }

    /// Whether the interrupt is asserted.
    pub(crate) fn is_mismatched(&self) -> bool {
        self.control & ON != 0 && (self.levels ^ self.reference) & self.enabled != 0
    }
}

/// Inputs by port, worked out once: (number of the input, bit of the port).
const TABLE: [&[(u8, u8)]; 7] = [
    &[],
    &[(2, 0), (3, 1), (4, 2), (5, 3), (6, 4), (7, 5), (12, 15)],
    &[(0, 14), (1, 13)],
    &[(13, 4), (14, 5), (15, 6), (16, 7), (19, 13), (20, 14), (21, 15)],
    &[],
    &[(17, 4), (18, 5)],
    &[(8, 6), (9, 7), (10, 8), (11, 9)],
];

fn from_port(levels: u16, port: Port) -> u32 {
    TABLE[port.index()].iter().fold(0, |inputs, &(input, bit)| {
        inputs | u32::from(levels >> bit & 1) << input
    })
}

fn to_port(inputs: u32, port: Port) -> u16 {
    TABLE[port.index()].iter().fold(0, |bits, &(input, bit)| {
        if inputs >> input & 1 != 0 {
            bits | 1 << bit
        } else {
            bits
        }
    })
}

fn inputs_of(port: Port) -> u32 {
    from_port(u16::MAX, port)
}

/// Bits of a port that have a change-notice input.
pub(crate) fn bits_of(port: Port) -> u16 {
    to_port(INPUTS, port)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pins::Pin;

    #[test]
    fn both_tables_are_the_same() {
        let mut seen = 0;
        for port in Port::ALL {
            for &(input, bit) in TABLE[port.index()] {
                assert_eq!(Pin::of_change_notice(input), Pin::new(port, bit));
                seen += 1;
            }
        }
        assert_eq!(seen, 22);
    }
}
