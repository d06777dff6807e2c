//! The whole chip: core, memories and peripherals, with pins to set and to look at.
//!
//! [`Machine::run_until`] executes the program up to a cycle of the 80 MHz time base. Between two calls the caller plays the
//! circuit: it sets inputs now or ahead of time and reads what the chip did with its outputs. Analog inputs are asked for
//! through [`Surroundings`] at the very moment at which the converter samples. A machine can be cloned at any time; clones
//! share flash until one of them writes to it.

mod surroundings;

pub use surroundings::{Grounded, Outputs, Surroundings};

use crate::cpu::{Access, Bus, BusFault, Cpu, Exit};
use crate::image::Image;
use crate::memory::Memory;
use crate::peripheral::{Chip, Direction, MisuseRecord, UnknownAccess};
use crate::pins::{Level, Output, Pin};

/// Why [`Machine::run_until`] returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    /// The cycle that the caller named.
    Reached,
    /// A breakpoint of the debugger is at the next instruction, which was not executed.
    Breakpoint,
}

/// A PIC32MX360F256L with its program.
#[derive(Clone, Debug)]
pub struct Machine {
    cpu: Cpu,
    memory: Memory,
    chip: Chip,
    cycle: u64,
}

impl Machine {
    /// A chip with this program right after power-on.
    pub fn new(image: &Image) -> Machine {
        Machine {
            cpu: Cpu::new(),
            memory: Memory::new(image),
            chip: Chip::new(),
            cycle: 0,
        }
    }

    /// Runs until this cycle since power-on, or until something named stops the program before.
    pub fn run_until(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) -> Halt {
        let _ = surroundings;
        while self.cycle < cycle {
            self.chip.serve(self.cycle);
            let exit = self.cpu.run(&mut self.memory, &mut self.chip, cycle);
            self.cycle = self.cpu.cycle();
            if exit == Exit::Breakpoint {
                return Halt::Breakpoint;
            }
        }
        Halt::Reached
    }

    /// Cycles of the 80 MHz time base since power-on.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The outside drives this pin from now on.
    pub fn set_input(&mut self, pin: Pin, level: Level) {
        self.chip.set_input(pin, Some(level), self.cycle);
    }

    /// The outside leaves this pin alone from now on: the chip's own pull-up, if it is on, or ground is what it reads.
    pub fn release_input(&mut self, pin: Pin) {
        self.chip.set_input(pin, None, self.cycle);
    }

    /// The outside will drive this pin from a cycle to come (a cycle of the past counts as now).
    pub fn schedule_input(&mut self, cycle: u64, pin: Pin, level: Level) {
        self.chip.schedule_input(cycle.max(self.cycle), pin, level);
    }

    /// What the chip does to this pin now.
    pub fn output(&self, pin: Pin) -> Output {
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
        self.chip.watch(pin);
    }

    /// The level changes of a watched pin since the last call, in time order: cycle and level after it. Nothing for a pin
    /// that is not watched.
    pub fn take_edges(&mut self, pin: Pin) -> Vec<(u64, Level)> {
        self.chip.take_edges(pin, self.cycle)
    }

    /// Registers that the program used and the reference does not name, each once.
    pub fn unknown_accesses(&self) -> &[UnknownAccess] {
        &self.chip.record.unknown
    }

    /// What the program did that works by luck or not at all, each kind once.
    pub fn misuses(&self) -> &[MisuseRecord] {
        &self.chip.record.misuses
    }
}

impl Bus for Chip {
    fn load(&mut self, access: Access) -> Result<u32, BusFault> {
        self.record.unknown(access.address, Direction::Read);
        Ok(0)
    }

    fn store(&mut self, access: Access, _value: u32) -> Result<(), BusFault> {
        self.record.unknown(access.address, Direction::Write);
        Ok(())
    }

    fn horizon(&self) -> u64 {
        self.next_event()
    }
}
