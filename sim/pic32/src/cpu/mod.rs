//! The M4K core: MIPS32 release 2 without floating point, TLB or caches, in fixed mapping.

mod bus;

pub use bus::{Access, Bus, BusFault, Width};

use crate::memory::Memory;

/// What the interrupt controller asks for at the moment (EIC mode).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterruptRequest {
    /// Requested priority level, 1..=7.
    pub level: u8,
    /// Vector number, 0..=63; 0 when INTCON.MVEC = 0.
    pub vector: u8,
    /// Register set for the handler, 0 or 1.
    pub shadow_set: u8,
}

/// An exception that was entered and is no interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exception {
    /// What it is.
    pub code: ExceptionCode,
    /// Virtual address of the instruction that caused it.
    pub address: u32,
    /// The address that was accessed, for address and bus errors.
    pub accessed: Option<u32>,
}

/// Cause.ExcCode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExceptionCode {
    /// Address error on a fetch or load.
    AddressLoad = 4,
    /// Address error on a store.
    AddressStore = 5,
    /// Bus error on a fetch.
    BusFetch = 6,
    /// Bus error on a load or store.
    BusData = 7,
    /// `syscall`.
    Syscall = 8,
    /// `break`.
    Breakpoint = 9,
    /// An instruction that this core does not have.
    Reserved = 10,
    /// A coprocessor that this core does not have.
    CoprocessorUnusable = 11,
    /// Overflow of `add`, `addi` or `sub`.
    Overflow = 12,
    /// A trap instruction whose condition held.
    Trap = 13,
}

/// Why [`Cpu::run`] returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The cycle that the caller named.
    Reached,
    /// The peripherals want to be served.
    Horizon,
    /// Count has become equal to Compare: the interrupt flag of the core timer is to be set.
    CoreTimer,
    /// A breakpoint of the debugger is at the next instruction, which was not executed.
    Breakpoint,
    /// An exception other than an interrupt was entered; running on executes its handler.
    Exception(Exception),
}

/// An interrupt that was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken {
    /// What was requested.
    pub request: InterruptRequest,
    /// Cycle at which the handler's first instruction begins.
    pub cycle: u64,
}

/// How the core comes up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoreReset {
    /// Power-on and everything like it.
    Cold,
    /// A non-maskable interrupt: Status.NMI is set, ErrorEPC tells where it was.
    NonMaskable,
}

/// The core.
#[derive(Clone, Debug)]
pub struct Cpu {
    cycle: u64,
    pc: u32,
    registers: [u32; 32],
    request: Option<InterruptRequest>,
    idle_cycles: u64,
}

impl Default for Cpu {
    fn default() -> Self {
        Self::new()
    }
}

impl Cpu {
    /// A core right after power-on, at cycle 0.
    pub fn new() -> Self {
        Self {
            cycle: 0,
            pc: 0xBFC0_0000,
            registers: [0; 32],
            request: None,
            idle_cycles: 0,
        }
    }

    /// Executes until `until_cycle`, the horizon of the bus, a match of the core timer, a breakpoint or an exception;
    /// at least up to the begin of the first instruction that is not before the earliest of these. In WAIT time goes on
    /// without instructions.
    pub fn run<B: Bus>(&mut self, memory: &mut Memory, bus: &mut B, until_cycle: u64) -> Exit {
        let _ = (memory, self.request, self.idle_cycles);
        let end = until_cycle.min(bus.horizon());
        self.cycle = self.cycle.max(end);
        if end == until_cycle {
            Exit::Reached
        } else {
            Exit::Horizon
        }
    }

    /// Executes one instruction, with its delay slot if it has one; interrupts are taken first.
    pub fn step<B: Bus>(&mut self, memory: &mut Memory, bus: &mut B) -> Exit {
        let next = self.cycle + 1;
        self.run(memory, bus, next)
    }

    /// What the interrupt controller requests from now on; `None` for nothing. It is taken before the next instruction
    /// that may be interrupted, and stays until it is replaced.
    pub fn interrupt(&mut self, request: Option<InterruptRequest>) {
        self.request = request;
    }

    /// The interrupt that was taken since the last call.
    pub fn take_taken(&mut self) -> Option<Taken> {
        None
    }

    /// Resets the core; time goes on.
    pub fn reset(&mut self, reset: CoreReset) {
        let _ = reset;
        self.pc = 0xBFC0_0000;
    }

    /// SYSCLK cycles since power-on.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Lets time pass without instructions up to `cycle`: flash operations stall the core, a start-up takes its time.
    pub fn stall_until(&mut self, cycle: u64) {
        self.cycle = self.cycle.max(cycle);
    }

    /// Cycles spent in WAIT.
    pub fn idle_cycles(&self) -> u64 {
        self.idle_cycles
    }

    /// Address of the next instruction.
    pub fn pc(&self) -> u32 {
        self.pc
    }

    /// A general register of the current set, 0..=31; higher numbers count modulo 32.
    pub fn register(&self, number: u8) -> u32 {
        self.registers[usize::from(number & 31)]
    }
}
