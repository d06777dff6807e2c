//! SPI and I2C between their registers and their pins.

use super::i2c::{self, I2cWrite};
use super::rate::Now;
use super::schedule::Slot;
use super::spi::{self, SpiWrite};
use super::{Chip, Irq, Misuse};
use crate::pins::{Level, Pin};

/// One of the two lines of an I2C bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum I2cLine {
    Data,
    Clock,
}

/// What happened behind the interrupt lines of a UART or SPI since the last look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct BusEvents {
    /// A character or word went from its queue into the shift register.
    pub(super) left: bool,
    /// One came.
    pub(super) came: bool,
}

impl Chip {
    /// Whether the program would read a pin as high.
    pub(super) fn reads_high(&self, pin: Pin) -> bool {
        self.ports.inputs(pin.port()) & pin.mask() != 0
    }

    pub(super) fn change_bus_clock(&mut self, number: u8, now: Now) {
        self.spis[usize::from(number)].change_clock(now);
        self.i2cs[usize::from(number)].change_clock(now);
        let spi = self.spis[usize::from(number)].next_event();
        let i2c = self.i2cs[usize::from(number)].next_event();
        self.schedule.set(Slot::Spi(number), spi);
        self.schedule.set(Slot::I2c(number), i2c);
    }

    pub(super) fn write_spi(&mut self, (number, word): (u8, u8), value: u32, cycle: u64) {
        let now = self.now(cycle);
        let wrong = match self.spis[usize::from(number)].write(word, value, now) {
            SpiWrite::Fine => None,
            SpiWrite::Replaced => Some(Misuse::SpiBufferFull(number + 1)),
            SpiWrite::Combination => Some(Misuse::SpiSettings(number + 1)),
            SpiWrite::TooFast => Some(Misuse::SpiTooFast(number + 1)),
        };
        if let Some(misuse) = wrong {
            self.record.misuse(misuse);
        }
        self.settle_spi_pins(number, cycle);
    }

    pub(super) fn serve_spi(&mut self, number: u8, cycle: u64) {
        let now = self.now(cycle);
        let input = self.reads_high(spi::PINS[usize::from(number)].input);
        self.spis[usize::from(number)].tick(now, input);
        self.settle_spi_pins(number, cycle);
    }

    pub(super) fn hear_spi_clock(&mut self, number: u8, level: Level, cycle: u64) {
        let input = self.reads_high(spi::PINS[usize::from(number)].input);
        self.spis[usize::from(number)].hear_clock(level, input);
        self.settle_heard_spi(number, cycle);
    }

    pub(super) fn hear_spi_select(&mut self, number: u8, level: Level, cycle: u64) {
        self.spis[usize::from(number)].hear_select(level.is_high());
        self.settle_heard_spi(number, cycle);
    }

    /// An SPI that is off leaves its pins to others.
    fn settle_heard_spi(&mut self, number: u8, cycle: u64) {
        if self.spis[usize::from(number)].is_on() {
            self.settle_spi_pins(number, cycle);
        }
    }

    /// What an SPI does to its pins, and what follows from its buffers.
    fn settle_spi_pins(&mut self, number: u8, cycle: u64) {
        let pins = spi::PINS[usize::from(number)];
        let outputs = self.spis[usize::from(number)].outputs();
        // Data stands before the clock's edge that comes with it.
        self.own(pins.output, outputs.output, cycle);
        self.own(pins.select, outputs.select, cycle);
        self.own(pins.clock, outputs.clock, cycle);
        self.settle_spi(number);
    }

    /// Interrupt lines and events of an SPI.
    pub(super) fn settle_spi(&mut self, number: u8) {
        let cycle = self.record.place.cycle;
        let spi = &mut self.spis[usize::from(number)];
        let events = std::mem::take(&mut spi.events);
        let lines = spi.lines();
        self.schedule.set(Slot::Spi(number), spi.next_event());
        for (irq, asserted) in [
            (Irq::spi_fault(number), lines.fault),
            (Irq::spi_transmit(number), lines.transmit),
            (Irq::spi_receive(number), lines.receive),
        ] {
            self.interrupts.set_line(irq, asserted, cycle);
        }
        self.note_bus_events(events, (Irq::spi_transmit(number), Irq::spi_receive(number)));
    }

    pub(super) fn note_bus_events(&mut self, events: BusEvents, (transmit, receive): (Irq, Irq)) {
        for (irq, happened) in [(transmit, events.left), (receive, events.came)] {
            if happened {
                self.interrupts.note_event(irq);
            }
        }
    }

    pub(super) fn write_i2c(&mut self, (number, word): (u8, u8), value: u32, cycle: u64) {
        let now = self.now(cycle);
        let (data, clock) = i2c::PINS[usize::from(number)];
        match self.i2cs[usize::from(number)].write(word, value, now) {
            I2cWrite::Fine => {}
            I2cWrite::StepIgnored => self.record.misuse(Misuse::I2cStepIgnored(number + 1)),
            I2cWrite::Divider => self.record.misuse(Misuse::I2cDivider(number + 1)),
        }
        if self.i2cs[usize::from(number)].releases().is_none() {
            self.own(data, None, cycle);
            self.own(clock, None, cycle);
        }
        self.settle_i2c(number, cycle);
    }

    pub(super) fn serve_i2c(&mut self, number: u8, cycle: u64) {
        let now = self.now(cycle);
        self.i2cs[usize::from(number)].tick(now);
        self.settle_i2c(number, cycle);
    }

    pub(super) fn hear_i2c(&mut self, (number, line): (u8, I2cLine), level: Level, cycle: u64) {
        let now = self.now(cycle);
        let i2c = &mut self.i2cs[usize::from(number)];
        match line {
            I2cLine::Data => i2c.hear_data(level.is_high()),
            I2cLine::Clock => i2c.hear_clock(level.is_high(), now),
        }
        self.settle_i2c(number, cycle);
    }

    /// What an I2C does to its lines, what it asks for, and when it goes on.
    fn settle_i2c(&mut self, number: u8, cycle: u64) {
        let place = usize::from(number);
        let (data, clock) = i2c::PINS[place];
        // One line at a time: what the first one leads to may change the other.
        if let Some((releases, _)) = self.i2cs[place].releases() {
            let changes = self.ports.own_open_drain(data, releases, cycle);
            self.port_changed(data.port(), changes, cycle);
        }
        if let Some((_, releases)) = self.i2cs[place].releases() {
            let changes = self.ports.own_open_drain(clock, releases, cycle);
            self.port_changed(clock.port(), changes, cycle);
        }
        let events = self.i2cs[place].take_events();
        for (irq, happened) in [
            (Irq::i2c_collision(number), events.collision),
            (Irq::i2c_slave(number), events.slave),
            (Irq::i2c_master(number), events.master),
        ] {
            if happened {
                self.interrupts.raise(irq, cycle);
            }
        }
        let due = self.i2cs[place].next_event();
        self.schedule.set(Slot::I2c(number), due);
    }
}
