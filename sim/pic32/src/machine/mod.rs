//! The whole chip: core, memories and peripherals, with pins to set and to look at.
//!
//! [`Machine::run_until`] executes the program up to a cycle of the 80 MHz time base. Between two calls the caller acts
//! as the circuit: it sets inputs now or ahead of time and reads the outputs. Analog inputs are requested through
//! [`Surroundings`] at the moment at which the ADC samples. A machine can be cloned at any time; clones share flash
//! until one of them writes to it.
//!
//! [`crate::peripheral`] lists what of the chip is modelled.

mod accounting;
mod core_clock;
mod faults;
mod programming;
mod surroundings;
mod touches;
mod view;
mod wires;

pub use accounting::{Accounting, VectorAccount};
pub use surroundings::{Grounded, Outputs, Surroundings};
pub use touches::Touch;
pub use wires::{LineRate, Uart};

use crate::cpu::{Access, CoreReset, Cpu, Exception, Exit, Width};
use crate::image::Image;
use crate::memory::{BOOT_START, FLASH_START, Memory};
pub use crate::peripheral::ResetSource;

use crate::peripheral::{
    Chip, Irq, Misuse, MisuseRecord, NvmOperation, Order, PAGE_BYTES, ROW_BYTES, UnknownAccess,
};
use core_clock::CoreClock;
use view::View;

/// How many resets and exceptions are kept; those after them are only counted.
const KEPT: usize = 64;
/// Physical address of DEVCFG3, the first of the four configuration words.
const CONFIGURATION: u32 = BOOT_START + 0x2FF0;
/// Until when the core stands still while reset is held.
const HELD: u64 = u64::MAX;

/// Why [`Machine::run_until`] returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    /// The cycle that the caller named.
    Reached,
    /// A breakpoint of the debugger is at the next instruction, which was not executed.
    Breakpoint,
    /// A fault that [`Machine::stop_at`] names; running on goes on behind it.
    Fault(ProgramFault),
}

/// What the program did wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramFault {
    /// It raised an exception.
    Exception(Exception),
    /// It misused the chip for the first time in this way.
    Misuse(Misuse),
}

/// Which faults end [`Machine::run_until`]. All are recorded anyway.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StopAt {
    /// None: the chip goes on, too.
    #[default]
    Nothing,
    /// Exceptions that are no interrupts.
    Exceptions,
    /// These, and the first of each kind of misuse.
    ExceptionsAndMisuse,
}

/// A reset and where it came in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResetEvent {
    /// What caused it.
    pub source: ResetSource,
    /// When.
    pub cycle: u64,
    /// Virtual address of the instruction that would have been next.
    pub pc: u32,
}

/// An exception and when it was raised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExceptionRecord {
    /// What and where.
    pub exception: Exception,
    /// When.
    pub cycle: u64,
}

/// A PIC32MX360F256L with its program.
#[derive(Clone, Debug)]
pub struct Machine {
    cpu: Cpu,
    memory: Memory,
    chip: Chip,
    cycle: u64,
    clock: CoreClock,
    stalled_until: u64,
    stop_at: StopAt,
    accounting: Accounting,
    resets: Vec<ResetEvent>,
    reset_count: u64,
    unreported_resets: Vec<ResetSource>,
    exceptions: Vec<ExceptionRecord>,
    exception_count: u64,
    touches: Option<Box<touches::Touches>>,
    unfinished: Option<programming::UnfinishedOperation>,
    is_worn_out: bool,
}

impl Machine {
    /// A chip with this program right after power-on.
    pub fn new(image: &Image) -> Machine {
        let memory = Memory::new(image);
        let chip = Chip::new(configuration_of(&memory));
        Machine {
            cpu: Cpu::new(),
            clock: CoreClock::new(chip.system_clock(), 0, 0),
            memory,
            chip,
            cycle: 0,
            stalled_until: 0,
            stop_at: StopAt::Nothing,
            accounting: Accounting::new(0),
            resets: Vec::new(),
            reset_count: 0,
            unreported_resets: Vec::new(),
            exceptions: Vec::new(),
            exception_count: 0,
            touches: None,
            unfinished: None,
            is_worn_out: false,
        }
    }

    /// Which faults end [`Machine::run_until`] from now on.
    pub fn stop_at(&mut self, stop_at: StopAt) {
        self.stop_at = stop_at;
    }

    /// Resets the chip now. RAM and general registers keep what they have, also at power-on (on the chip they hold
    /// anything).
    pub fn reset(&mut self, source: ResetSource) {
        self.reset_count += 1;
        if self.unreported_resets.len() < KEPT {
            self.unreported_resets.push(source);
        }
        if self.resets.len() < KEPT {
            self.resets.push(ResetEvent {
                source,
                cycle: self.cycle,
                pc: self.cpu.pc(),
            });
        }
        self.accounting.forget_active(self.cycle);
        self.stalled_until = self.cycle;
        self.memory.reset();
        self.cpu.reset(CoreReset::Cold);
        self.chip
            .reset(source, self.cycle, configuration_of(&self.memory));
    }

    /// Runs until this cycle since power-on, or until something named stops the program before. Everything that is due
    /// at that cycle has happened then, except the instruction that begins with it.
    pub fn run_until(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) -> Halt {
        if self.touches.is_some() {
            return self.run_noting(cycle, surroundings);
        }
        self.run_plainly(cycle, surroundings)
    }

    fn run_plainly(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) -> Halt {
        loop {
            let misuses = self.chip.record.misuses.len();
            self.settle(surroundings);
            if self.cycle >= cycle {
                self.accounting.charge(self.cycle);
                return Halt::Reached;
            }
            let halt = self.advance(cycle);
            let halt = halt.or_else(|| self.new_misuse(misuses));
            if let Some(halt) = halt {
                self.settle(surroundings);
                return halt;
            }
        }
    }

    /// Executes one instruction, with its delay slot if it has one; in WAIT, or while the core stands still, one cycle
    /// passes.
    pub fn step(&mut self, surroundings: &mut dyn Surroundings) -> Halt {
        loop {
            self.settle(surroundings);
            let before = self.cycle;
            let halt = if self.clock.is_stopped() || self.stalled_until > self.cycle {
                self.advance(self.cycle + 1)
            } else {
                self.advance_by(|cpu, memory, view| cpu.step(memory, view))
            };
            self.settle(surroundings);
            if let Some(halt) = halt {
                return halt;
            }
            if self.cycle != before {
                return Halt::Reached;
            }
        }
    }

    /// Lets happen what is due, and what it asks of core and memories.
    fn settle(&mut self, surroundings: &mut dyn Surroundings) {
        loop {
            self.chip.serve(self.cycle, surroundings);
            let Some(order) = self.chip.take_order() else {
                break;
            };
            self.obey(order);
        }
        if let Some(request) = self.chip.take_request() {
            self.cpu.interrupt(request);
        }
        self.chip.wake_if_requested(self.cycle);
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Reset(source) => self.reset(source),
            Order::Bark if self.is_watchdog_suspended() => self.chip.restart_watchdog(self.cycle),
            Order::Bark if self.cpu.is_waiting() => {
                self.accounting.forget_active(self.cycle);
                self.chip.bark_at_idle(self.cycle);
                self.cpu.reset(CoreReset::NonMaskable);
            }
            Order::Bark => self.reset(ResetSource::Watchdog),
            Order::Clock => {
                self.clock = CoreClock::new(self.chip.system_clock(), self.cycle, self.cpu.cycle());
            }
            Order::Matrix => {
                self.memory.set_flash_timing(self.chip.flash_timing());
                self.memory.set_ram_wait_states(self.chip.ram_wait_states());
                self.memory.set_ram_code(self.chip.ram_code());
            }
            Order::Flash(operation) => self.program(operation),
            Order::Dma { cycle } => self.chip.move_by_dma(&mut self.memory, cycle),
        }
    }

    /// While reset is held, and in debug mode (Microchip's text for sister parts), the watchdog does not count: a programmer takes
    /// as long as it takes.
    fn is_watchdog_suspended(&self) -> bool {
        self.stalled_until == HELD || self.cpu.is_debugging()
    }

    /// Flash changes when the operation begins, so that a reset in its midst finds it done, as the chip would have it.
    fn program(&mut self, operation: NvmOperation) {
        let done = match operation {
            _ if self.is_worn_out => false,
            NvmOperation::Word { address, value } => self.write_flash(address, &value.to_le_bytes()),
            NvmOperation::Row { address, source } => {
                let mut row = [0; ROW_BYTES as usize];
                self.memory
                    .read(source, &mut row)
                    .is_ok_and(|()| source < FLASH_START)
                    && self.write_flash(address, &row)
            }
            NvmOperation::Page { address } => self.erase(address),
            NvmOperation::All => (0..FLASH_PAGES).all(|page| self.erase(FLASH_START + page * PAGE_BYTES)),
        };
        if !done {
            self.chip.flash_failed();
        }
        self.unfinished = Some(programming::UnfinishedOperation {
            operation,
            until: self.cycle + operation.cycles(),
        });
        // The core waits for flash only if its next instruction is there.
        if self.cpu.pc() & 0x1FFF_FFFF >= FLASH_START {
            self.stalled_until = self.cycle + operation.cycles();
        }
    }

    /// Programming can clear bits only.
    fn write_flash(&mut self, address: u32, bytes: &[u8]) -> bool {
        let mut merged = bytes.to_vec();
        if self.memory.read(address, &mut merged).is_err() {
            return false;
        }
        for (kept, new) in merged.iter_mut().zip(bytes) {
            *kept &= new;
        }
        self.memory.write(address, &merged).is_ok()
    }

    fn erase(&mut self, address: u32) -> bool {
        self.memory.write(address, &[0xFF; PAGE_BYTES as usize]).is_ok()
    }

    /// Goes on until something is due, at most until `cycle`.
    fn advance(&mut self, cycle: u64) -> Option<Halt> {
        let stalled = self.stalled_until > self.cycle;
        if !stalled && !self.clock.is_stopped() {
            let until = self.clock.core_of(cycle);
            return self.advance_by(|cpu, memory, view| cpu.run(memory, view, until));
        }
        let mut next = cycle.min(self.chip.next_event());
        if stalled {
            next = next.min(self.stalled_until);
        }
        self.cycle = self.cycle.max(next);
        if !self.clock.is_stopped() {
            self.cpu.stall_until(self.clock.core_of(self.cycle));
        }
        None
    }

    fn advance_by(&mut self, run: impl FnOnce(&mut Cpu, &mut Memory, &mut View<'_>) -> Exit) -> Option<Halt> {
        let idle_before = self.cpu.idle_cycles();
        let clock = self.clock;
        let mut view = View {
            chip: &mut self.chip,
            clock,
            accounting: &mut self.accounting,
        };
        let exit = run(&mut self.cpu, &mut self.memory, &mut view);
        self.cycle = clock.base_of(self.cpu.cycle());
        let idle = self.cpu.idle_cycles() - idle_before;
        if idle > 0 {
            self.accounting
                .add_idle(self.chip.system_clock().cycles_for(idle));
        }
        self.chip.note_wait(self.cpu.is_waiting(), self.cycle);
        match exit {
            Exit::Reached | Exit::Horizon => None,
            Exit::CoreTimer => {
                self.chip.raise(Irq::CORE_TIMER, self.cycle);
                None
            }
            Exit::SoftwareRequests(requests) => {
                for number in (0..2).filter(|number| requests >> number & 1 != 0) {
                    self.chip.raise(Irq::software(number), self.cycle);
                }
                None
            }
            Exit::Breakpoint => Some(Halt::Breakpoint),
            Exit::Exception(exception) => self.note_exception(exception),
        }
    }

    fn note_exception(&mut self, exception: Exception) -> Option<Halt> {
        self.exception_count += 1;
        if self.exceptions.len() < KEPT {
            self.exceptions.push(ExceptionRecord {
                exception,
                cycle: self.cycle,
            });
        }
        (self.stop_at != StopAt::Nothing).then_some(Halt::Fault(ProgramFault::Exception(exception)))
    }

    /// The first misuse after the first `known` ones, if misuse is to stop the machine.
    fn new_misuse(&self, known: usize) -> Option<Halt> {
        let misuse = self
            .chip
            .record
            .misuses
            .get(known)
            .filter(|_| self.stop_at == StopAt::ExceptionsAndMisuse);
        misuse.map(|record| Halt::Fault(ProgramFault::Misuse(record.misuse)))
    }

    /// Cycles of the 80 MHz time base since power-on.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Whether the core has no clock: the crystal is dead, and nothing replaces it.
    pub fn is_clock_dead(&self) -> bool {
        self.clock.is_stopped() && !self.chip.is_asleep()
    }

    /// The core.
    pub fn cpu(&self) -> &Cpu {
        &self.cpu
    }

    /// The core, for a debugger.
    pub fn cpu_mut(&mut self) -> &mut Cpu {
        &mut self.cpu
    }

    /// The memories.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The memories, for a debugger or a programmer.
    pub fn memory_mut(&mut self) -> &mut Memory {
        &mut self.memory
    }

    /// The value of the special function register at a physical address or its KSEG1 alias, without what reading it
    /// sets in motion; nothing for addresses that the reference does not name.
    pub fn peek_register(&mut self, address: u32) -> Option<u32> {
        self.chip.peek_address(address & 0x1FFF_FFFF, self.cycle)
    }

    /// Reads a special function register as the program would, with what that sets in motion. Physical address or KSEG1
    /// alias.
    pub fn read_register(&mut self, address: u32) -> u32 {
        self.chip.load(self.access_from_outside(address))
    }

    /// Writes a special function register as the program would: a debugger does. Physical address or KSEG1 alias.
    pub fn write_register(&mut self, address: u32, value: u32) {
        self.chip.store(self.access_from_outside(address), value);
    }

    fn access_from_outside(&self, address: u32) -> Access {
        Access {
            address: address & 0x1FFF_FFFC,
            width: Width::Word,
            cycle: self.cycle,
            pc: self.cpu.pc(),
        }
    }

    /// Registers that the program used and the reference does not name, each once.
    pub fn unknown_accesses(&self) -> &[UnknownAccess] {
        &self.chip.record.unknown
    }

    /// What the program did that works by luck or not at all, each kind once.
    pub fn misuses(&self) -> &[MisuseRecord] {
        &self.chip.record.misuses
    }

    /// Forgets unknown accesses and misuse.
    pub fn clear_records(&mut self) {
        self.chip.record.unknown.clear();
        self.chip.record.misuses.clear();
    }

    /// The first 64 resets after power-on.
    pub fn resets(&self) -> &[ResetEvent] {
        &self.resets
    }

    /// What has reset the chip since the last call, at most 64 of them.
    pub fn take_resets(&mut self) -> Vec<ResetSource> {
        std::mem::take(&mut self.unreported_resets)
    }

    /// How many resets there were.
    pub fn reset_count(&self) -> u64 {
        self.reset_count
    }

    /// RCON, as a debugger sees it.
    pub fn reset_causes(&self) -> u32 {
        self.chip.reset_causes()
    }

    /// The first 64 exceptions that were no interrupts.
    pub fn exceptions(&self) -> &[ExceptionRecord] {
        &self.exceptions
    }

    /// How many exceptions there were that were no interrupts.
    pub fn exception_count(&self) -> u64 {
        self.exception_count
    }
}

/// Pages of program flash.
const FLASH_PAGES: u32 = 64;

fn configuration_of(memory: &Memory) -> [u8; 16] {
    let mut words = [0xFF; 16];
    match memory.read(CONFIGURATION, &mut words) {
        Ok(()) => words,
        Err(_) => [0xFF; 16],
    }
}
