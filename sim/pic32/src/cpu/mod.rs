//! The M4K core: MIPS32 release 2 without floating point, TLB or caches, in fixed mapping.
//!
//! **Time.** An instruction takes one cycle and, besides:
//!
//! | what | cycles | confidence |
//! | --- | --- | --- |
//! | a load whose result the next instruction needs | 1 | estimated |
//! | reading a register of the chip | 2 | unknown |
//! | a load from RAM | BMXCON.BMXWSDRM | known |
//! | a load from flash | CHECON.PFMWS | known, without the lines for data |
//! | a jump to a line that the prefetch unit does not hold | CHECON.PFMWS | known, its replacement rule is not |
//! | each fetch from flash without prefetch | CHECON.PFMWS | estimated |
//! | HI or LO asked for before they are there | 1, after a division up to 32 | estimated |
//! | `mul` | 1 or 2 | estimated |
//! | entering or leaving a handler | 3, and the wait for its line of flash | estimated |
//!
//! Not modelled: waiting for the bus behind DMA, write buffers, MIPS16e, user mode (KUSEG leads nowhere on a part that
//! gives it no memory), debug mode beyond `sdbbp` and `deret`.
//!
//! **How it works.** Flash is decoded once ([`crate::memory`]). The inner loop (`inner.rs`) runs decoded code without any call;
//! it is left for uncommon instructions, for registers of the chip, and when the next event is due.

mod bus;
mod data;
pub(crate) mod decode;
mod exception;
mod inner;
mod multiplier;
mod open;
pub(crate) mod operation;
mod perform;
mod prefetch;
mod probe;
mod registers;
mod run;
mod system;
mod timer;
mod uncommon;

pub use bus::{Access, Bus, BusFault, Width};
pub use exception::{Exception, ExceptionCode};
pub use probe::ProbeAccess;

use multiplier::Multiplier;
use prefetch::PrefetchUnit;
use probe::Probe;
use registers::{Registers, Source, WriteTarget};
use system::Coprocessor0;
use timer::CoreTimer;

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

/// Why [`Cpu::run`] returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The cycle that the caller named.
    Reached,
    /// The peripherals must be served.
    Horizon,
    /// Count has become equal to Compare: the interrupt flag of the core timer is to be set.
    CoreTimer,
    /// The program wrote Cause.IP1 and IP0: these bits are the requests of the core software interrupts 1 and 0 now.
    SoftwareRequests(u8),
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
    /// A non-maskable interrupt: Status.NMI is set, ErrorEPC holds the address.
    NonMaskable,
}

/// The address of the first instruction after a reset.
const RESET_VECTOR: u32 = 0xBFC0_0000;
/// The number of the stack pointer.
const STACK_POINTER: u32 = 29;

/// The core.
#[derive(Clone, Debug)]
pub struct Cpu {
    cycle: u64,
    pc: u32,
    /// The instruction after the current one: not the next word in a delay slot.
    next: u32,
    /// The current instruction is in the delay slot of a branch.
    in_slot: bool,
    registers: Registers,
    /// The register set that is not in use.
    other_registers: Registers,
    is_shadow_active: bool,
    multiplier: Multiplier,
    system: Coprocessor0,
    timer: CoreTimer,
    prefetch: PrefetchUnit,
    /// The line of flash at which the last jump ended; nothing when the core came here otherwise.
    line: Option<u16>,
    request: Option<InterruptRequest>,
    is_waiting: bool,
    is_linked: bool,
    idle_cycles: u64,
    deepest_stack: u32,
    software_requests: u8,
    probe: Probe,
}

impl Default for Cpu {
    fn default() -> Self {
        Self::new()
    }
}

impl Cpu {
    /// A core right after power-on, at cycle 0. Registers that the chip leaves undefined are zero.
    pub fn new() -> Self {
        Self {
            cycle: 0,
            pc: RESET_VECTOR,
            next: RESET_VECTOR + 4,
            in_slot: false,
            registers: Registers::new(),
            other_registers: Registers::new(),
            is_shadow_active: false,
            multiplier: Multiplier::default(),
            system: Coprocessor0::new(),
            timer: CoreTimer::new(),
            prefetch: PrefetchUnit::new(),
            line: None,
            request: None,
            is_waiting: false,
            is_linked: false,
            idle_cycles: 0,
            deepest_stack: u32::MAX,
            software_requests: 0,
            probe: Probe::default(),
        }
    }

    /// Resets the core; time goes on, and general registers stay as they are.
    pub fn reset(&mut self, reset: CoreReset) {
        let restart = if self.in_slot {
            self.pc.wrapping_sub(4)
        } else {
            self.pc
        };
        self.system.reset(restart, reset == CoreReset::NonMaskable);
        self.select_set();
        if reset == CoreReset::Cold {
            self.timer.set_stopped(self.cycle, false);
            self.prefetch = PrefetchUnit::new();
            self.request = None;
            self.software_requests = 0;
        }
        self.forget_probe();
        self.is_waiting = false;
        self.is_linked = false;
        self.continue_at(RESET_VECTOR);
    }

    /// What the interrupt controller requests from now on; `None` for nothing. It is taken before the next instruction
    /// that may be interrupted, and stays until it is replaced.
    pub fn interrupt(&mut self, request: Option<InterruptRequest>) {
        self.request = request;
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

    /// Whether the core is in WAIT.
    pub fn is_waiting(&self) -> bool {
        self.is_waiting
    }

    /// Whether Cause.TI is set: Count has met Compare, and Compare was not written since.
    pub fn is_timer_pending(&self) -> bool {
        self.system.is_timer_pending()
    }

    /// The lowest value that a function's entry (`addiu sp, sp, -n`) has given the stack pointer; nothing before the
    /// first.
    pub fn deepest_stack(&self) -> Option<u32> {
        (self.deepest_stack != u32::MAX).then_some(self.deepest_stack)
    }

    /// Forgets the deepest stack pointer.
    pub fn clear_deepest_stack(&mut self) {
        self.deepest_stack = u32::MAX;
    }

    /// Address of the next instruction.
    pub fn pc(&self) -> u32 {
        self.pc
    }

    /// Goes on at another address.
    pub fn set_pc(&mut self, address: u32) {
        self.is_waiting = false;
        self.continue_at(address);
    }

    /// A general register of the set in use, 0..=31; higher numbers count modulo 32.
    pub fn register(&self, number: u8) -> u32 {
        self.registers.get(Source::new(u32::from(number)))
    }

    /// Changes a general register of the set in use; register 0 stays zero.
    pub fn set_register(&mut self, number: u8, value: u32) {
        self.registers.set(WriteTarget::new(u32::from(number)), value);
    }

    /// HI and LO.
    pub fn product(&self) -> (u32, u32) {
        let value = self.multiplier.value();
        ((value >> 32) as u32, value as u32)
    }

    /// Changes HI and LO.
    pub fn set_product(&mut self, high: u32, low: u32) {
        self.multiplier.set_value(u64::from(high) << 32 | u64::from(low));
    }
}
