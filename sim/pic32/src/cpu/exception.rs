//! Exceptions: what they are, and how the core enters them.

use super::Cpu;
use super::operation::Uncommon;

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
    /// An instruction that this core does not have; `jalx` and with it MIPS16e among them.
    Reserved = 10,
    /// A coprocessor that this core does not have.
    CoprocessorUnusable = 11,
    /// Overflow of `add`, `addi` or `sub`.
    Overflow = 12,
    /// A trap instruction whose condition held.
    Trap = 13,
}

/// Cycles from the end of the interrupted instruction to the first one of a handler, and from `eret` to the instruction
/// that it returns to: the pipeline is refilled. General knowledge of five-stage pipelines, not confirmed by a source; the
/// wait for flash is counted besides.
pub(super) const REFILL_CYCLES: u64 = 3;

/// Why an instruction could not be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InstructionFault {
    pub(super) code: ExceptionCode,
    pub(super) accessed: Option<u32>,
    /// The coprocessor that is missing.
    pub(super) unit: u8,
}

impl InstructionFault {
    pub(super) const fn plain(code: ExceptionCode) -> Self {
        Self {
            code,
            accessed: None,
            unit: 0,
        }
    }

    pub(super) const fn at(code: ExceptionCode, accessed: u32) -> Self {
        Self {
            code,
            accessed: Some(accessed),
            unit: 0,
        }
    }

    pub(super) const fn coprocessor(unit: u8) -> Self {
        Self {
            code: ExceptionCode::CoprocessorUnusable,
            accessed: None,
            unit,
        }
    }

    /// What an instruction raises that does nothing else.
    pub(super) const fn of(uncommon: Uncommon) -> Option<Self> {
        match uncommon {
            Uncommon::Syscall => Some(Self::plain(ExceptionCode::Syscall)),
            Uncommon::Break => Some(Self::plain(ExceptionCode::Breakpoint)),
            Uncommon::Reserved => Some(Self::plain(ExceptionCode::Reserved)),
            Uncommon::CoprocessorUnusable { unit } => Some(Self::coprocessor(unit)),
            _ => None,
        }
    }
}

impl Cpu {
    /// Enters the handler of an exception; the instruction takes no effect.
    pub(super) fn raise(&mut self, fault: InstructionFault) -> Exception {
        let address = self.pc;
        if let (Some(accessed), ExceptionCode::AddressLoad | ExceptionCode::AddressStore) =
            (fault.accessed, fault.code)
        {
            self.system.set_bad_address(accessed);
        }
        let vector = self.system.enter(fault, address, self.in_slot);
        self.vector_to(vector);
        Exception {
            code: fault.code,
            address,
            accessed: fault.accessed,
        }
    }

    /// Goes on at an address that is no branch target.
    pub(super) fn vector_to(&mut self, address: u32) {
        self.select_set();
        self.continue_at(address);
        self.cycle += REFILL_CYCLES;
    }

    /// The next instruction is at this address.
    pub(super) fn continue_at(&mut self, address: u32) {
        self.pc = address;
        self.next = address.wrapping_add(4);
        self.in_slot = false;
        self.line = None;
    }

    /// Brings the register set into use that SRSCtl names.
    pub(super) fn select_set(&mut self) {
        let wanted = self.system.current_set() != 0;
        if wanted != self.is_shadow_active {
            std::mem::swap(&mut self.registers, &mut self.other_registers);
            self.is_shadow_active = wanted;
        }
    }
}
