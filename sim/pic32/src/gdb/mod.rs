//! The remote protocol of GDB: `target remote :PORT` in gdb-multiarch debugs the emulated program.
//!
//! [`Session`] is the protocol without I/O: bytes of the debugger go in, a [`DebugTarget`] is asked, bytes for the
//! debugger come out. [`serve`] joins it to a TCP connection. [`DebugChip`] is a machine with its surroundings as a
//! target.
//!
//! Supported: registers, memory (flash included, so that `load` works), software and hardware breakpoints, `step`,
//! `continue`, interruption, `monitor reset` and `monitor cycle`. Not supported: watchpoints, reverse execution,
//! threads. While the program is stopped, emulated time is stopped.

mod chip;
mod commands;
mod description;
mod packet;
mod session;
mod tcp;

pub use chip::DebugChip;
pub use session::Session;
pub use tcp::serve;

/// A register by the number that the target description gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GdbRegister {
    /// A general register, 0..=31.
    General(u8),
    /// CP0 Status.
    Status,
    /// LO.
    Low,
    /// HI.
    High,
    /// CP0 BadVAddr.
    BadAddress,
    /// CP0 Cause.
    Cause,
    /// Address of the next instruction.
    ProgramCounter,
}

/// Why a program has stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A step is done, or it never ran.
    Stepped,
    /// At a breakpoint.
    Breakpoint,
    /// The debugger asked for it.
    Interrupted,
    /// It read, wrote or executed what is not there.
    BadAddress,
    /// An instruction that the core does not have.
    BadInstruction,
    /// A trap, an overflow or a `break` of its own.
    Trapped,
}

/// No memory is at this address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no memory is at this address")]
pub struct NoMemory;

/// What can be debugged.
pub trait DebugTarget {
    /// What a register holds.
    fn register(&self, register: GdbRegister) -> u32;

    /// Changes a register; BadVAddr cannot be changed.
    fn set_register(&mut self, register: GdbRegister, value: u32);

    /// Reads memory or registers of the chip at a virtual address, without side effects.
    ///
    /// # Errors
    /// When a byte of it does not exist.
    fn read(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), NoMemory>;

    /// Writes RAM, flash or registers of the chip at a virtual address.
    ///
    /// # Errors
    /// When a byte of it does not exist.
    fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), NoMemory>;

    /// Puts a breakpoint before the instruction at a virtual address.
    ///
    /// # Errors
    /// When no instruction can be there.
    fn set_breakpoint(&mut self, address: u32) -> Result<(), NoMemory>;

    /// Takes a breakpoint away.
    ///
    /// # Errors
    /// When no instruction can be there.
    fn clear_breakpoint(&mut self, address: u32) -> Result<(), NoMemory>;

    /// Executes one instruction, with its delay slot.
    fn step(&mut self) -> Stop;

    /// Executes for a moment; nothing when the program would go on.
    fn run(&mut self) -> Option<Stop>;

    /// Resets the chip as its reset pin does.
    fn reset(&mut self);

    /// SYSCLK cycles since power-on.
    fn cycle(&self) -> u64;
}
