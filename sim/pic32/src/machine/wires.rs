//! Interface of the pins to the outside.

use super::Machine;
use crate::peripheral::{CYCLES_PER_S, DmaRequests, Sent};
use crate::pins::{Level, Pin, PinDriver, Port, known};

/// One of the two UARTs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Uart {
    /// Transmits on RF3, receives on RF2.
    One,
    /// Transmits on RF5, receives on RF4.
    Two,
}

impl Uart {
    /// The pin that it receives on.
    pub const fn receive_pin(self) -> Pin {
        match self {
            Uart::One => known(Port::F, 2),
            Uart::Two => known(Port::F, 4),
        }
    }

    const fn number(self) -> u8 {
        self as u8
    }
}

/// How the outside sends characters: 8 data bits, no parity, one stop bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineRate {
    /// Bits per second, at least 1.
    pub baud: u32,
}

impl Machine {
    /// The outside drives this pin from now on.
    pub fn set_input(&mut self, pin: Pin, level: Level) {
        self.chip.set_input(pin, Some(level), self.cycle);
    }

    /// The outside leaves this pin alone from now on: the chip's own pull-up, if it is on, or ground is what it reads.
    pub fn release_input(&mut self, pin: Pin) {
        self.chip.set_input(pin, None, self.cycle);
    }

    /// The board has a resistor from this pin to the supply: it reads high while it is not driven.
    pub fn pull_up(&mut self, pin: Pin) {
        self.chip.pull_up(pin, self.cycle);
    }

    /// The board has a crystal of 32.768 kHz on RC13 and RC14, which swings as soon as the program wants it.
    pub fn fit_watch_crystal(&mut self) {
        self.chip.fit_watch_crystal(self.cycle);
    }

    /// How requests that stay up start cells of DMA from now on: no source tells which one the chip does.
    pub fn set_dma_requests(&mut self, requests: DmaRequests) {
        self.chip.set_dma_requests(requests);
    }

    /// The outside will drive this pin from a cycle to come (a cycle of the past counts as now).
    pub fn schedule_input(&mut self, cycle: u64, pin: Pin, level: Level) {
        self.chip.schedule_input(cycle.max(self.cycle), pin, level);
    }

    /// Forgets all that was scheduled for cycles to come.
    pub fn clear_scheduled_inputs(&mut self) {
        self.chip.clear_inputs();
    }

    /// What the chip does to this pin now.
    pub fn output(&self, pin: Pin) -> PinDriver {
        self.chip.output(pin, self.cycle)
    }

    /// What a voltmeter would see on this pin now.
    pub fn level(&self, pin: Pin) -> Level {
        self.chip.level(pin, self.cycle)
    }

    /// For how many cycles since power-on the chip has driven this pin high, exact also for PWM: the mean duty of an
    /// interval is the difference of two such numbers over its length.
    pub fn high_cycles(&self, pin: Pin) -> u64 {
        self.chip.high_cycles(pin, self.cycle)
    }

    /// From now on the level changes of this pin are written down.
    pub fn watch(&mut self, pin: Pin) {
        self.chip.watch(pin, self.cycle);
    }

    /// The level changes of a watched pin since the last call, in time order: cycle and level after it. Nothing for a
    /// pin that is not watched.
    pub fn take_edges(&mut self, pin: Pin) -> Vec<(u64, Level)> {
        self.chip.take_edges(pin, self.cycle)
    }

    /// The outside sends characters to a UART on its receive pin, as [`Machine::send_characters`] does.
    pub fn send_to_uart(&mut self, uart: Uart, characters: &[u8], begin: (u64, LineRate)) -> u64 {
        self.send_characters(uart.receive_pin(), characters, begin)
    }

    /// The outside sends characters as levels on a pin, one after the other without a pause; the first start bit begins
    /// at `cycle`, or now if that is past. Returns the cycle at which the last stop bit ends.
    pub fn send_characters(&mut self, pin: Pin, characters: &[u8], (cycle, rate): (u64, LineRate)) -> u64 {
        let begin = cycle.max(self.cycle);
        let bit_begin = |bit: u64| begin + bit * CYCLES_PER_S / u64::from(rate.baud.max(1));
        let mut bit = 0;
        for &character in characters {
            // Start bit 0, eight data bits, stop bit 1.
            let levels = 0x200 | u16::from(character) << 1;
            for number in 0..10 {
                self.schedule_input(bit_begin(bit), pin, Level::of(levels >> number & 1 != 0));
                bit += 1;
            }
        }
        bit_begin(bit)
    }

    /// What a UART has sent since the last call, with the cycle at which each character or break ended.
    pub fn take_sent(&mut self, uart: Uart) -> Vec<(u64, Sent)> {
        self.chip.take_sent(uart.number())
    }
}
