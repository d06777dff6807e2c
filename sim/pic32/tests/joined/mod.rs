//! Two chips whose pins are joined by wires, a few cycles at a time.

use pic32::machine::{Grounded, Halt, Machine};
use pic32::pins::{Level, Pin, PinDriver};

/// How far the chips may be apart: shorter than any time on the wires of these tests.
const STEP_CYCLES: u64 = 5;

/// A wire from an output of the first chip to an input of the second, or the other way round.
#[derive(Clone, Copy)]
pub(crate) enum Wire {
    /// From the first to the second.
    Forth(Pin, Pin),
    /// From the second to the first.
    Back(Pin, Pin),
    /// Both may pull it low, and a resistor pulls it up.
    Open(Pin, Pin),
}

/// Two chips and what joins them.
pub(crate) struct JoinedChips {
    pub(crate) first: Machine,
    pub(crate) second: Machine,
    wires: Vec<Wire>,
}

impl JoinedChips {
    pub(crate) fn new(first: Machine, second: Machine, wires: Vec<Wire>) -> JoinedChips {
        let mut joined = JoinedChips { first, second, wires };
        for wire in joined.wires.clone() {
            if let Wire::Open(first, second) = wire {
                joined.first.pull_up(first);
                joined.second.pull_up(second);
            }
        }
        joined
    }

    /// The chips run so many cycles.
    pub(crate) fn run(&mut self, cycles: u64) {
        let end = self.first.cycle() + cycles;
        while self.first.cycle() < end {
            let next = self.first.cycle() + STEP_CYCLES;
            run(&mut self.first, next);
            run(&mut self.second, next);
            for wire in &self.wires {
                match *wire {
                    Wire::Forth(from, to) => follow(&mut self.second, to, self.first.output(from)),
                    Wire::Back(from, to) => follow(&mut self.first, to, self.second.output(from)),
                    Wire::Open(one, other) => {
                        let (low_here, low_there) = (
                            self.first.output(one) == PinDriver::Low,
                            self.second.output(other) == PinDriver::Low,
                        );
                        pull(&mut self.first, one, low_there);
                        pull(&mut self.second, other, low_here);
                    }
                }
            }
        }
    }
}

fn follow(machine: &mut Machine, to: Pin, driver: PinDriver) {
    match driver.level() {
        Some(level) => machine.set_input(to, level),
        None => machine.release_input(to),
    }
}

fn pull(machine: &mut Machine, to: Pin, low: bool) {
    if low {
        machine.set_input(to, Level::Low);
    } else {
        machine.release_input(to);
    }
}

fn run(machine: &mut Machine, cycle: u64) {
    assert_eq!(machine.run_until(cycle, &mut Grounded), Halt::Reached);
}

fn pin(name: &str) -> Pin {
    name.parse().expect("a pin")
}

pub(crate) fn forth(from: &str, to: &str) -> Wire {
    Wire::Forth(pin(from), pin(to))
}

pub(crate) fn back(from: &str, to: &str) -> Wire {
    Wire::Back(pin(from), pin(to))
}

pub(crate) fn open(one: &str, other: &str) -> Wire {
    Wire::Open(pin(one), pin(other))
}
