//! Everything of the chip except core and memories: the special function registers and what stands behind them.

mod inputs;
mod ports;
mod rate;
mod record;
mod schedule;

pub use rate::{CYCLES_PER_S, NEVER, Rate};
pub use record::{Direction, Misuse, MisuseRecord, UnknownAccess};

use crate::pins::{Level, Output, Pin, Port};
use inputs::Inputs;
use ports::{Changes, Ports, bits};
use record::Record;
use schedule::{Schedule, Slot};

/// The peripherals, and what the outside does to the pins.
#[derive(Clone, Debug)]
pub(crate) struct Chip {
    pub(crate) record: Record,
    schedule: Schedule,
    ports: Ports,
    inputs: Inputs,
}

impl Chip {
    pub(crate) fn new() -> Chip {
        Chip {
            record: Record::default(),
            schedule: Schedule::new(),
            ports: Ports::new(),
            inputs: Inputs::default(),
        }
    }

    /// The cycle of the next event.
    pub(crate) fn next_event(&self) -> u64 {
        self.schedule.next()
    }

    /// Lets happen what is due at `cycle` or before.
    pub(crate) fn serve(&mut self, cycle: u64) {
        while let Some((slot, due)) = self.schedule.take_due(cycle) {
            if slot == Slot::Input {
                self.serve_inputs(due);
            }
        }
    }

    fn serve_inputs(&mut self, cycle: u64) {
        while let Some((pin, level)) = self.inputs.take(cycle) {
            self.set_input(pin, Some(level), cycle);
        }
        self.schedule.set(Slot::Input, self.inputs.next());
    }

    pub(crate) fn set_input(&mut self, pin: Pin, driven: Option<Level>, cycle: u64) {
        let changes = self.ports.set_outside(pin, driven, cycle);
        self.port_changed(pin.port(), changes);
    }

    pub(crate) fn schedule_input(&mut self, cycle: u64, pin: Pin, level: Level) {
        self.inputs.add(cycle, pin, level);
        self.schedule.set(Slot::Input, self.inputs.next());
    }

    fn port_changed(&mut self, port: Port, changes: Changes) {
        for pin in bits(changes.conflicts).filter_map(|bit| Pin::new(port, bit)) {
            self.record.misuse(Misuse::PinConflict(pin));
        }
    }

    pub(crate) fn output(&self, pin: Pin, _cycle: u64) -> Output {
        self.ports.output(pin)
    }

    pub(crate) fn level(&self, pin: Pin, _cycle: u64) -> Level {
        Level::of(self.ports.levels(pin.port()) & pin.mask() != 0)
    }

    pub(crate) fn changed(&self, pin: Pin) -> u64 {
        self.ports.changed(pin)
    }

    pub(crate) fn high_cycles(&self, pin: Pin, cycle: u64) -> u64 {
        self.ports.high_cycles(pin, cycle)
    }

    pub(crate) fn watch(&mut self, pin: Pin) {
        self.ports.watch(pin);
    }

    pub(crate) fn take_edges(&mut self, pin: Pin, _cycle: u64) -> Vec<(u64, Level)> {
        self.ports.take_edges(pin)
    }
}
