//! Timers 0 and 1 together, with their start bits and flags.
//!
//! They are brought up to date when something looks at them. A timer counts at the end of each cycle; started in one
//! cycle it counts from the next one on. Rollover is an event only where it can interrupt.

use super::timer::{Mode, Timer};

/// TCON: start bits of the two timers.
const RUN: [u8; 2] = [0x10, 0x40];
/// TCON: their overflow flags.
const OVERFLOW: [u8; 2] = [0x20, 0x80];

/// Both timers.
#[derive(Clone, Debug)]
pub(super) struct Timers {
    timers: [Timer; 2],
    runs: [bool; 2],
    overflowed: [bool; 2],
    /// Up to which cycle they have counted.
    cycle: u64,
}

impl Timers {
    pub(super) fn new(cycle: u64) -> Self {
        Self {
            timers: [Timer::new(); 2],
            runs: [false; 2],
            overflowed: [false; 2],
            cycle,
        }
    }

    /// Timer 0 uses the start bit and the flag of timer 1 for its upper half.
    fn is_split(&self) -> bool {
        self.timers[0].mode() == Mode::Split
    }

    fn counts_cycles(&self, number: usize) -> bool {
        let timer = &self.timers[number];
        self.is_started(number) && !timer.is_external() && timer.is_let()
    }

    /// Timer 1 cannot be stopped by TR1 while timer 0 has that bit; its own mode 3 stops it.
    fn is_started(&self, number: usize) -> bool {
        match number {
            0 => self.runs[0],
            _ => (self.runs[1] || self.is_split()) && self.timers[1].mode() != Mode::Split,
        }
    }

    /// Counts up to `cycle`.
    pub(super) fn advance(&mut self, cycle: u64) {
        let counts = cycle.saturating_sub(self.cycle);
        self.cycle = self.cycle.max(cycle);
        if counts == 0 {
            return;
        }
        for number in 0..2 {
            if self.counts_cycles(number) {
                self.count(number, counts);
            }
        }
        if self.is_split() && self.runs[1] {
            let sum = u64::from(self.timers[0].high) + counts;
            self.timers[0].high = sum as u8;
            self.overflowed[1] |= sum > 0xFF;
        }
    }

    fn count(&mut self, number: usize, counts: u64) {
        let overflowed = self.timers[number].count(counts);
        self.overflowed[number] |= overflowed && (number == 0 || !self.is_split());
    }

    /// Time passes in which the chip has no clock.
    pub(super) fn skip_to(&mut self, cycle: u64) {
        self.cycle = cycle;
    }

    /// The pin of an external interrupt changed, which is the gate of the timer with the same number.
    pub(super) fn gate(&mut self, number: usize, is_open: bool) {
        self.timers[number].gate_is_open = is_open;
    }

    /// A falling edge on its counting pin.
    pub(super) fn pulse(&mut self, number: usize) {
        let timer = &self.timers[number];
        if self.is_started(number) && timer.is_external() && timer.is_let() {
            self.count(number, 1);
        }
    }

    /// The next overflow that sets a flag which is not set yet, of the timers whose interrupt is enabled.
    pub(super) fn next(&self, enabled: [bool; 2]) -> u64 {
        let mut next = u64::MAX;
        for (number, is_enabled) in enabled.into_iter().enumerate() {
            let sets_flag = number == 0 || !self.is_split();
            if is_enabled && sets_flag && !self.overflowed[number] && self.counts_cycles(number) {
                next = next.min(self.cycle + self.timers[number].left());
            }
        }
        if enabled[1] && self.is_split() && self.runs[1] && !self.overflowed[1] {
            next = next.min(self.cycle + 0x100 - u64::from(self.timers[0].high));
        }
        next
    }

    /// Whether the flag of a timer is set.
    pub(super) fn has_overflowed(&self, number: usize) -> bool {
        self.overflowed[number]
    }

    /// The interrupt's handler is called, which clears the flag.
    pub(super) fn acknowledge(&mut self, number: usize) {
        self.overflowed[number] = false;
    }

    /// Their part of TCON.
    pub(super) fn control(&self) -> u8 {
        let mut control = 0;
        for number in 0..2 {
            control |= if self.runs[number] { RUN[number] } else { 0 };
            control |= if self.overflowed[number] {
                OVERFLOW[number]
            } else {
                0
            };
        }
        control
    }

    pub(super) fn set_control(&mut self, tcon: u8) {
        for number in 0..2 {
            self.runs[number] = tcon & RUN[number] != 0;
            self.overflowed[number] = tcon & OVERFLOW[number] != 0;
        }
    }

    /// TMOD.
    pub(super) fn modes(&self) -> u8 {
        self.timers[0].control() | self.timers[1].control() << 4
    }

    pub(super) fn set_modes(&mut self, tmod: u8) {
        self.timers[0].configure(tmod);
        self.timers[1].configure(tmod >> 4);
    }

    /// A timer, to read its bytes.
    pub(super) fn timer(&self, number: usize) -> &Timer {
        &self.timers[number]
    }

    /// A timer, to write its bytes.
    pub(super) fn timer_mut(&mut self, number: usize) -> &mut Timer {
        &mut self.timers[number]
    }

    /// Cycles between two overflows of timer 1, if it overflows by itself.
    pub(super) fn period_of_timer_1(&self) -> Option<u64> {
        if !self.counts_cycles(1) {
            return None;
        }
        Some(match self.timers[1].mode() {
            Mode::Bits13 => 0x2000,
            Mode::Bits16 => 0x1_0000,
            Mode::Refilled => 0x100 - u64::from(self.timers[1].high),
            Mode::Split => return None,
        })
    }
}
