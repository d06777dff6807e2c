//! Debug mode with a probe: what the core reads and writes in the probe's window comes over the wires of the programmer.
//!
//! Instructions that the core fetches there, and words that it loads and stores there, are *pending* until the probe
//! completes them; until then the core waits. Everything else of debug mode is the core's own business (`system.rs`).

use super::decode::decode;
use super::inner::{Leave, Region};
use super::operation::Operation;
use super::uncommon::Flow;
use super::{Bus, CoreReset, Cpu, Exit};
use crate::memory::{Code, Memory};

/// The probe's window.
const WINDOW_START: u32 = 0xFF20_0000;
const WINDOW_END: u32 = 0xFF30_0000;
/// The registers of debug mode follow it, up to here: the core answers for them itself. All read 0, which says of the first one (DCR) that
/// there are no hardware breakpoints, and stores change nothing.
const REGISTERS_END: u32 = 0xFF40_0000;
/// The address of the first instruction that the probe supplies.
const DEBUG_VECTOR: u32 = 0xFF20_0200;

/// An access of the core to the probe's window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeAccess {
    /// It wants the instruction, or the word, at this address.
    Read {
        /// Where.
        address: u32,
    },
    /// It stores this word.
    Write {
        /// Where.
        address: u32,
        /// What.
        value: u32,
    },
}

/// What the core and the probe exchange.
#[derive(Clone, Debug, Default)]
pub(super) struct Probe {
    is_enabled: bool,
    pending: Option<ProbeAccess>,
    /// What the probe supplied for the pending read, or that it took the pending store.
    answer: Option<u32>,
    /// The instruction at the current address, kept until it is done: its own load may wait, too.
    instruction: Option<u32>,
}

impl Probe {
    /// The answer to this access. Without one the access is pending from now on.
    fn exchange(&mut self, access: ProbeAccess) -> Option<u32> {
        let answer = self.answer.take();
        self.pending = match answer {
            Some(_) => None,
            None => Some(access),
        };
        answer
    }
}

impl Cpu {
    /// Resets the core into debug mode: its first instruction comes from the probe.
    pub(crate) fn reset_to_probe(&mut self) {
        self.reset(CoreReset::Cold);
        self.probe = Probe {
            is_enabled: true,
            ..Probe::default()
        };
        self.system.enter_debug(self.pc, false);
        self.continue_at(DEBUG_VECTOR);
    }

    /// Where debug mode begins while a probe supplies the instructions.
    pub(super) fn debug_vector(&self) -> Option<u32> {
        self.probe.is_enabled.then_some(DEBUG_VECTOR)
    }

    /// Whether the core is in debug mode.
    pub(crate) fn is_debugging(&self) -> bool {
        self.system.is_debugging()
    }

    /// The access that waits for the probe.
    pub(crate) fn probe_access(&self) -> Option<ProbeAccess> {
        self.probe.pending.filter(|_| self.probe.answer.is_none())
    }

    /// The probe completes the pending access; `word` is what a read gets.
    pub(crate) fn complete_probe_access(&mut self, word: u32) {
        if self.probe.pending.is_some() {
            self.probe.answer = Some(word);
        }
    }

    pub(super) fn forget_probe(&mut self) {
        self.probe = Probe::default();
    }

    /// Whether the next instruction comes from the probe.
    pub(super) fn is_in_window(&self) -> bool {
        self.probe.is_enabled && (WINDOW_START..WINDOW_END).contains(&self.pc)
    }

    /// Executes one instruction of the probe, or waits for it up to `limit`.
    pub(super) fn run_probed<B: Bus>(
        &mut self,
        memory: &mut Memory,
        bus: &mut B,
        limit: u64,
    ) -> Option<Exit> {
        let access = ProbeAccess::Read { address: self.pc };
        if self.probe.instruction.is_none() {
            self.probe.instruction = self.probe.exchange(access);
        }
        let Some(word) = self.probe.instruction else {
            self.cycle = self.cycle.max(limit);
            return None;
        };
        let operation = decode(word);
        let region = Region {
            base: self.pc,
            first_line: None,
            fetch: 1,
            flash_wait: u64::from(memory.flash_timing().wait_states),
            ram_wait: u64::from(memory.ram_wait_states()),
        };
        let (before, once) = (self.pc, self.cycle + 1);
        let leave = self.run_region(
            memory.open(Code::Ram(operation), &mut [Operation::Nop]),
            region,
            once,
        );
        let exit = match leave {
            Leave::Uncommon(operation) => {
                self.execute_outside((operation, region.fetch), (memory, bus), limit)
            }
            Leave::Limit | Leave::Outside => None,
        };
        if self.pc != before {
            self.probe.instruction = None;
        }
        exit
    }

    /// A load or store of the probe's window, if the instruction is one: done, or waiting.
    pub(super) fn reach_window(&mut self, operation: Operation) -> Option<WindowFlow> {
        if !self.probe.is_enabled {
            return None;
        }
        let (base, offset) = match operation {
            Operation::Lw { base, offset, .. } | Operation::Sw { base, offset, .. } => (base, offset),
            _ => return None,
        };
        let address = self.registers.sum(base, offset);
        if !(WINDOW_START..REGISTERS_END).contains(&address) || address & 3 != 0 {
            return None;
        }
        if address >= WINDOW_END {
            if let Operation::Lw { to, .. } = operation {
                self.registers.set(to.rt, 0);
            }
            return Some(WindowFlow::Done(Flow::Next));
        }
        let access = match operation {
            Operation::Sw { rt, .. } => ProbeAccess::Write {
                address,
                value: self.registers.get(rt),
            },
            _ => ProbeAccess::Read { address },
        };
        let Some(word) = self.probe.exchange(access) else {
            return Some(WindowFlow::Waits);
        };
        if let Operation::Lw { to, .. } = operation {
            self.registers.set(to.rt, word);
        }
        Some(WindowFlow::Done(Flow::Next))
    }
}

/// How an access to the window went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WindowFlow {
    /// The probe has not completed it.
    Waits,
    /// It is done.
    Done(Flow),
}
