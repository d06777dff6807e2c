//! Pins: the peripherals that own them, the observers of their changes, and their levels.

use super::analog::Trigger;
use super::buses::I2cLine;
use super::capture::{self, Captured};
use super::inputs::InputQueue;
use super::ports::{Changes, Field, bits};
use super::schedule::Slot;
use super::timers::Ticked;
use super::{Chip, Irq, Misuse, i2c, notice, parallel, serial, spi};
use crate::pins::{Level, Pin, PinDriver, Port, known};

/// INT0 to INT4.
const EXTERNAL: [Pin; 5] = [
    known(Port::F, 6),
    known(Port::E, 8),
    known(Port::E, 9),
    known(Port::A, 14),
    known(Port::A, 15),
];
/// T1CK to T5CK.
const TIMER_CLOCKS: [Pin; 5] = [
    known(Port::C, 14),
    known(Port::C, 1),
    known(Port::C, 2),
    known(Port::C, 3),
    known(Port::C, 4),
];
/// The crystal's second pin, which an external clock leaves free, and its first.
const CRYSTAL: (u16, u16) = (1 << 15, 1 << 12);
/// Where the register block that sets pull-ups has them.
const PULL_UPS: u8 = 2;

/// Whose input a pin is, besides change notice.
#[derive(Clone, Copy, Debug)]
enum Hearer {
    External(u8),
    Capture(u8),
    TimerClock(u8),
    Receiver(u8),
    SpiClock(u8),
    SpiSelect(u8),
    I2cData(u8),
    I2cClock(u8),
    Parallel,
}

/// Which bus a pin belongs to: SCK 1 is INT0 besides.
fn bus_of(pin: Pin) -> Option<Hearer> {
    let spis = (0..).zip(&spi::PINS).find_map(|(number, pins)| match pin {
        _ if pin == pins.clock => Some(Hearer::SpiClock(number)),
        _ if pin == pins.select => Some(Hearer::SpiSelect(number)),
        _ => None,
    });
    let parallel = [
        parallel::pins::READ,
        parallel::pins::WRITE,
        parallel::pins::SELECT,
    ];
    let spis = spis.or_else(|| parallel.contains(&pin).then_some(Hearer::Parallel));
    spis.or_else(|| {
        (0..)
            .zip(&i2c::PINS)
            .find_map(|(number, (data, clock))| match pin {
                _ if pin == *data => Some(Hearer::I2cData(number)),
                _ if pin == *clock => Some(Hearer::I2cClock(number)),
                _ => None,
            })
    })
}

fn hearer_of(pin: Pin) -> Option<Hearer> {
    let place = |pins: &[Pin]| {
        pins.iter()
            .position(|&known| known == pin)
            .and_then(|place| u8::try_from(place).ok())
    };
    place(&EXTERNAL)
        .map(Hearer::External)
        .or_else(|| place(&capture::PINS).map(Hearer::Capture))
        .or_else(|| place(&TIMER_CLOCKS).map(Hearer::TimerClock))
        .or_else(|| place(&serial::RECEIVE_PINS).map(Hearer::Receiver))
}

impl Chip {
    pub(super) fn serve_inputs(&mut self, cycle: u64) {
        while let Some((pin, level)) = self.inputs.take(cycle) {
            self.set_input(pin, Some(level), cycle);
        }
        self.schedule.set(Slot::Input, self.inputs.next());
    }

    /// The outside drives a pin, or leaves it alone.
    pub(crate) fn set_input(&mut self, pin: Pin, driven: Option<Level>, cycle: u64) {
        self.record.place.cycle = cycle;
        let changes = self.ports.set_outside(pin, driven, cycle);
        self.port_changed(pin.port(), changes, cycle);
        self.settle_request();
    }

    /// The board has a resistor from this pin to the supply.
    pub(crate) fn pull_up(&mut self, pin: Pin, cycle: u64) {
        let all = self.ports.field(pin.port(), Field::BoardPullUp) | pin.mask();
        let changes = self.ports.set_field((pin.port(), Field::BoardPullUp), all, cycle);
        self.port_changed(pin.port(), changes, cycle);
        self.settle_request();
    }

    pub(crate) fn schedule_input(&mut self, cycle: u64, pin: Pin, level: Level) {
        self.inputs.add(cycle, pin, level);
        self.schedule.set(Slot::Input, self.inputs.next());
    }

    /// Forgets what was scheduled.
    pub(crate) fn clear_inputs(&mut self) {
        self.inputs = InputQueue::default();
        self.schedule.set(Slot::Input, self.inputs.next());
    }

    /// A peripheral drives a pin or gives it back.
    pub(super) fn own(&mut self, pin: Pin, driven: Option<Level>, cycle: u64) {
        let changes = self.ports.own(pin, driven, cycle);
        self.port_changed(pin.port(), changes, cycle);
    }

    /// Tells those who listen to the pins of a port.
    pub(super) fn port_changed(&mut self, port: Port, changes: Changes, cycle: u64) {
        for pin in bits(changes.conflicts).filter_map(|bit| Pin::new(port, bit)) {
            self.record.misuse(Misuse::PinConflict(pin));
        }
        if changes.inputs & notice::bits_of(port) != 0 {
            self.notice.set_levels(port, self.ports.inputs(port));
            self.settle_notice();
        }
        let levels = self.ports.inputs(port);
        for pin in bits(changes.inputs).filter_map(|bit| Pin::new(port, bit)) {
            for hearer in hearer_of(pin).into_iter().chain(bus_of(pin)) {
                self.hear(hearer, Level::of(levels & pin.mask() != 0), cycle);
            }
        }
    }

    fn hear(&mut self, hearer: Hearer, level: Level, cycle: u64) {
        match hearer {
            Hearer::External(number) => {
                if level.is_high() == self.interrupts.is_rising(number) {
                    self.interrupts.raise(Irq::external(number), cycle);
                    if number == 0 {
                        self.trigger_analog(Trigger::External0, cycle);
                    }
                }
            }
            Hearer::Capture(number) => {
                let capture = &mut self.captures[usize::from(number)];
                if capture.is_on() {
                    let count = self.timers.counter(capture.timer()).count_at(cycle);
                    if capture.edge(level, count) == Captured::Interrupt {
                        self.interrupts.raise(Irq::capture(number), cycle);
                    }
                }
            }
            Hearer::TimerClock(number) => {
                self.advance_timers(cycle);
                let now = self.now(cycle);
                if self.timers.clock_pin(number, level, now) == Ticked::Flag {
                    let flagged = self.timers.interrupt_of(number);
                    self.interrupts.raise(Irq::timer(flagged), cycle);
                }
                self.settle_timers(cycle);
            }
            Hearer::Receiver(number) => {
                let now = self.now(cycle);
                let serial = &mut self.serials[usize::from(number)];
                if !serial.loops_back() {
                    serial.edge(level, now);
                    self.settle_serial(number);
                }
            }
            Hearer::SpiClock(number) => self.hear_spi_clock(number, level, cycle),
            Hearer::SpiSelect(number) => self.hear_spi_select(number, level, cycle),
            Hearer::I2cData(number) => self.hear_i2c((number, I2cLine::Data), level, cycle),
            Hearer::I2cClock(number) => self.hear_i2c((number, I2cLine::Clock), level, cycle),
            Hearer::Parallel => self.hear_parallel(cycle),
        }
    }

    /// The interrupt of change notice follows its pins.
    pub(super) fn settle_notice(&mut self) {
        let cycle = self.record.place.cycle;
        self.interrupts
            .set_line(Irq::CHANGE_NOTICE, self.notice.is_mismatched(), cycle);
    }

    pub(super) fn write_notice(&mut self, word: u8, value: u32, cycle: u64) {
        self.notice.write(word, value);
        if word == PULL_UPS {
            for port in Port::ALL {
                let changes = self
                    .ports
                    .set_field((port, Field::PullUp), self.notice.pull_ups(port), cycle);
                self.port_changed(port, changes, cycle);
            }
        }
        self.settle_notice();
    }

    /// AD1PCFG says which pins of port B are analog.
    pub(super) fn settle_analog_pins(&mut self, cycle: u64) {
        let changes = self
            .ports
            .set_field((Port::B, Field::Analog), self.analog.analog_pins(), cycle);
        self.port_changed(Port::B, changes, cycle);
    }

    /// Pins that something holds as inputs whatever TRIS says: JTAG, trace, the crystal, receivers.
    pub(super) fn settle_held_pins(&mut self, cycle: u64) {
        let (a, g) = self.system.held_pins();
        let configuration = self.clock.configuration();
        let crystal = match (configuration.has_primary(), configuration.has_crystal()) {
            (true, true) => CRYSTAL.0 | CRYSTAL.1,
            (true, false) => CRYSTAL.1,
            (false, _) => 0,
        };
        let receivers = serial::RECEIVE_PINS
            .iter()
            .zip(&self.serials)
            .filter(|(_, serial)| serial.holds_receive_pin())
            .fold(0, |mask, (pin, _)| mask | pin.mask());
        for (port, held) in [
            (Port::A, a),
            (Port::C, crystal),
            (Port::F, receivers),
            (Port::G, g),
        ] {
            let changes = self.ports.set_field((port, Field::Held), held, cycle);
            self.port_changed(port, changes, cycle);
        }
    }

    /// What the program reads from a port at `cycle`.
    pub(super) fn port_inputs(&self, port: Port, cycle: u64) -> u16 {
        let inputs = self.ports.inputs(port);
        if port != Port::D {
            return inputs;
        }
        super::compare::PINS
            .iter()
            .fold(inputs, |inputs, &pin| match self.modulated_level(pin, cycle) {
                Some(level) => inputs & !pin.mask() | if level.is_high() { pin.mask() } else { 0 },
                None => inputs,
            })
    }

    /// What the chip does to a pin.
    pub(crate) fn output(&self, pin: Pin, cycle: u64) -> PinDriver {
        self.modulated_level(pin, cycle)
            .map_or_else(|| self.ports.output(pin), PinDriver::from)
    }

    /// What a voltmeter sees on a pin.
    pub(crate) fn level(&self, pin: Pin, cycle: u64) -> Level {
        let stored = Level::of(self.ports.levels(pin.port()) & pin.mask() != 0);
        self.modulated_level(pin, cycle).unwrap_or(stored)
    }

    /// When the chip last began or ceased to drive a pin high, PWM left out.
    pub(crate) fn changed(&self, pin: Pin) -> u64 {
        self.ports.changed(pin)
    }

    pub(crate) fn high_cycles(&self, pin: Pin, cycle: u64) -> u64 {
        self.ports.high_cycles(pin, cycle) + self.modulated_high_cycles(pin, cycle)
    }

    pub(crate) fn watch(&mut self, pin: Pin, cycle: u64) {
        self.advance_outputs(cycle);
        self.ports.watch(pin);
    }

    pub(crate) fn take_edges(&mut self, pin: Pin, cycle: u64) -> Vec<(u64, Level)> {
        self.advance_outputs(cycle);
        self.ports.take_edges(pin)
    }
}
