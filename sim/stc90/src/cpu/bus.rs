//! What the core sees of the rest of the chip.

/// Where MOVX goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum External {
    /// By DPTR: sixteen bits.
    Long(u16),
    /// By R0 or R1: eight bits. What the upper half is, the chip decides.
    Short(u8),
}

/// A fault of the program that the core notices by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoreFault {
    /// The opcode 0xA5, or code where there is no flash.
    ReservedInstruction,
    /// A byte of code was read where there is no flash.
    DataBeyondFlash,
    /// The stack pointer went over 0xFF, and what was pushed lies at the bottom of memory.
    StackWrapped,
}

/// Special function registers outside of the core, external memory and interrupts.
///
/// `cycle` is the cycle since power-on in which the access takes effect: the end of the first cycle of its instruction.
pub trait Bus {
    /// Reads a register; of a port its pins.
    fn read(&mut self, address: u8, cycle: u64) -> u8;

    /// Reads a register for an instruction that writes it back; of a port its latch.
    fn read_latch(&mut self, address: u8, cycle: u64) -> u8;

    /// Writes a register.
    fn write(&mut self, address: u8, value: u8, cycle: u64);

    /// MOVX from external memory.
    fn read_external(&mut self, place: External, cycle: u64) -> u8;

    /// MOVX to external memory.
    fn write_external(&mut self, place: External, value: u8, cycle: u64);

    /// RETI was executed.
    fn end_interrupt(&mut self);

    /// The core noticed a fault in the instruction that it executes.
    fn note(&mut self, fault: CoreFault, cycle: u64);

    /// The cycle at which the core stops executing, because something else is due.
    fn horizon(&self) -> u64;
}
