//! Input capture 1 to 5 (here 0 to 4): what the timer showed at an edge, through a queue of four.

use crate::pins::{Level, Pin, Port, known};

/// IC1 to IC5.
pub(crate) const PINS: [Pin; 5] = [
    known(Port::D, 8),
    known(Port::D, 9),
    known(Port::D, 10),
    known(Port::D, 11),
    known(Port::D, 12),
];

const ON: u32 = 1 << 15;
const FIRST_RISING: u32 = 1 << 9;
const WIDE: u32 = 1 << 8;
const TIMER_2: u32 = 1 << 7;
const OVERFLOWN: u32 = 1 << 4;
const NOT_EMPTY: u32 = 1 << 3;
const WRITABLE: u32 = 0xE3E7;
/// General knowledge of the family; no source was found.
const DEPTH: usize = 4;

/// One module.
#[derive(Clone, Debug, Default)]
pub(crate) struct Capture {
    control: u32,
    queue: [u32; DEPTH],
    used: usize,
    overflown: bool,
    /// Rising edges that the prescaler of modes 4 and 5 still holds.
    held_edges: u8,
    /// Captures since the last interrupt.
    unreported: u32,
    /// The first edge of mode 6 was seen.
    begun: bool,
}

/// What an edge led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Captured {
    /// Nothing for others.
    Nothing,
    /// An interrupt.
    Interrupt,
}

impl Capture {
    /// Which timer's count it takes, by the number of the timer that counts: 2 or 3 as 1 or 2, a pair as 1.
    pub(crate) fn timer(&self) -> u8 {
        if self.control & (TIMER_2 | WIDE) != 0 {
            1
        } else {
            2
        }
    }

    /// Whether edges can lead to anything.
    pub(crate) fn is_on(&self) -> bool {
        self.control & ON != 0 && self.control & 7 != 0
    }

    /// The pin has this level now, and the timer this count.
    pub(crate) fn edge(&mut self, level: Level, count: u32) -> Captured {
        let rising = level.is_high();
        let taken = match self.control & 7 {
            1 => true,
            2 => !rising,
            3 => rising,
            4 => rising && self.every(4),
            5 => rising && self.every(16),
            6 => {
                self.begun |= rising == (self.control & FIRST_RISING != 0);
                self.begun
            }
            _ => false,
        };
        if taken && self.control & ON != 0 {
            self.keep(count)
        } else {
            Captured::Nothing
        }
    }

    fn every(&mut self, edges: u8) -> bool {
        self.held_edges = (self.held_edges + 1) % edges;
        self.held_edges == 0
    }

    fn keep(&mut self, count: u32) -> Captured {
        let count = if self.control & WIDE == 0 {
            count & 0xFFFF
        } else {
            count
        };
        if self.used == DEPTH {
            self.overflown = true;
        } else {
            self.queue[self.used] = count;
            self.used += 1;
        }
        self.unreported += 1;
        if self.unreported > self.control >> 5 & 3 {
            self.unreported = 0;
            Captured::Interrupt
        } else {
            Captured::Nothing
        }
    }

    /// Reads a register as the debugger would, without taking from the queue.
    pub(crate) fn peek(&self, word: u8) -> Option<u32> {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        Some(match word {
            0 => self.control | flag(self.overflown, OVERFLOWN) | flag(self.used > 0, NOT_EMPTY),
            1 => self.queue[0],
            _ => return None,
        })
    }

    /// The program has read ICxBUF.
    pub(crate) fn take(&mut self) {
        if self.used > 0 {
            self.used -= 1;
            // The last value stays in place and is read again from an empty queue.
            if self.used > 0 {
                self.queue.rotate_left(1);
            }
        }
        self.overflown &= self.used > 0;
    }

    /// Writes ICxCON.
    pub(crate) fn write_control(&mut self, value: u32) {
        let control = value & WRITABLE;
        if (control ^ self.control) & (ON | 7) != 0 {
            *self = Capture::default();
        }
        self.control = control;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn captured(control: u32, edges: &[Level]) -> (Vec<u32>, usize) {
        let mut capture = Capture::default();
        capture.write_control(control | ON);
        let (mut values, mut interrupts) = (Vec::new(), 0);
        for (count, &level) in (1..).zip(edges) {
            interrupts += usize::from(capture.edge(level, count) == Captured::Interrupt);
            while capture.peek(0).is_some_and(|control| control & NOT_EMPTY != 0) {
                values.extend(capture.peek(1));
                capture.take();
            }
        }
        (values, interrupts)
    }

    #[test]
    fn modes_choose_their_edges() {
        let edges: Vec<Level> = (0..40).map(|number| Level::of(number % 2 == 0)).collect();
        let odd = |first: u32, step: usize| (first..=40).step_by(step).collect::<Vec<u32>>();
        let table = [
            (1, odd(1, 1)),
            (2, odd(2, 2)),
            (3, odd(1, 2)),
            (4, odd(7, 8)),
            (5, odd(31, 32)),
        ];
        let first = [(6, odd(2, 1)), (6 | FIRST_RISING, odd(1, 1)), (7, Vec::new())];
        for (control, expected) in table.into_iter().chain(first) {
            let interrupts = expected.len();
            assert_eq!(
                captured(control, &edges),
                (expected, interrupts),
                "ICxCON {control:#x}"
            );
        }
        assert_eq!(captured(1 | 3 << 5, &edges).1, 10, "every fourth capture");
    }

    #[test]
    fn the_fifth_is_lost_and_said() {
        let mut capture = Capture::default();
        capture.write_control(ON | 1);
        for count in 1..=5 {
            capture.edge(Level::High, count);
        }
        assert_eq!(capture.peek(0), Some(ON | 1 | OVERFLOWN | NOT_EMPTY));
        for expected in 1..=4 {
            assert_eq!(capture.peek(1), Some(expected));
            capture.take();
        }
        assert_eq!(capture.peek(0), Some(ON | 1));
    }
}
