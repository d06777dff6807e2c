//! Instructions that the inner loop leaves: privileged ones, traps, branches that annul their slot, `ll` and `sc`, and
//! loads and stores of registers of the chip.

use super::data::AddressSpace;
use super::exception::{ExceptionCode, InstructionFault, REFILL_CYCLES};
use super::operation::{Operation, Uncommon};
use super::registers::{Source, WriteTarget};
use super::system::Coprocessor0Write;
use super::{Bus, Cpu, Width};
use crate::memory::Memory;

/// Where the core goes after an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// To the next one.
    Next,
    /// To this address after the next one.
    Branch(u32),
    /// To the next one, which is the delay slot of a branch that is not taken.
    NotTaken,
    /// Over the next one.
    Skip,
    /// To this address at once.
    Vector(u32),
    /// Nowhere: a breakpoint of the debugger is here.
    Stop,
}

impl Cpu {
    /// Executes the current instruction, which the inner loop did not.
    pub(super) fn execute<B: Bus>(
        &mut self,
        operation: Operation,
        memory: &mut Memory,
        bus: &mut B,
    ) -> Result<Flow, InstructionFault> {
        match operation {
            Operation::Uncommon(uncommon) => {
                self.execute_uncommon(uncommon, &mut AddressSpace { memory, bus })
            }
            _ => self.transfer(operation, memory, bus).map(|()| Flow::Next),
        }
    }

    fn execute_uncommon<B: Bus>(
        &mut self,
        uncommon: Uncommon,
        port: &mut AddressSpace<'_, B>,
    ) -> Result<Flow, InstructionFault> {
        if let Some(fault) = InstructionFault::of(uncommon) {
            return Err(fault);
        }
        match uncommon {
            Uncommon::Breakpoint => return Ok(Flow::Stop),
            Uncommon::Add { .. } | Uncommon::Sub { .. } | Uncommon::Addi { .. } => self.add(uncommon)?,
            Uncommon::Trap { condition, rs, rt } => {
                trap(condition.holds(self.registers.get(rs), self.registers.get(rt)))?;
            }
            Uncommon::TrapImmediate { condition, rs, value } => {
                let value = i32::from(value).cast_unsigned();
                trap(condition.holds(self.registers.get(rs), value))?;
            }
            Uncommon::BranchLikely { .. }
            | Uncommon::BranchLink { .. }
            | Uncommon::BranchLinkLikely { .. } => {
                return Ok(self.branch_uncommon(uncommon));
            }
            Uncommon::Ll { rt, base, offset } => {
                let address = self.offset(base, offset);
                let value = self.load(port, address, Width::Word)?;
                self.registers.set(rt, value);
                self.is_linked = true;
            }
            Uncommon::Sc { rt, to, base, offset } => {
                self.store_conditional(port, (rt, to), (base, offset))?
            }
            Uncommon::Sdbbp => {
                let without_probe = self.system.enter_debug(self.pc, self.in_slot);
                return Ok(Flow::Vector(self.debug_vector().unwrap_or(without_probe)));
            }
            Uncommon::Eret => {
                port.bus.exception_returned(self.cycle);
                return Ok(self.return_from_exception());
            }
            Uncommon::Deret => return self.return_from_debug(),
            Uncommon::Wait => {
                self.is_waiting = true;
                port.bus.waits(self.cycle);
            }
            _ => self.execute_privileged(uncommon),
        }
        Ok(Flow::Next)
    }

    /// Moves between general and system registers.
    fn execute_privileged(&mut self, uncommon: Uncommon) {
        match uncommon {
            Uncommon::Di { rt } => {
                let before = self.system.set_interrupts(false);
                self.registers.set(rt, before);
            }
            Uncommon::Ei { rt } => {
                let before = self.system.set_interrupts(true);
                self.registers.set(rt, before);
            }
            Uncommon::Mfc0 { rt, register, select } => {
                let value = self.system_register(register, select);
                self.registers.set(rt, value);
            }
            Uncommon::Mtc0 { rt, register, select } => {
                self.set_system_register(register, select, self.registers.get(rt));
            }
            Uncommon::Rdpgpr { rd, rt } => {
                let value = self.previous_registers().get(rt);
                self.registers.set(rd, value);
            }
            Uncommon::Wrpgpr { rd, rt } => {
                let value = self.registers.get(rt);
                self.previous_registers().set(rd, value);
            }
            Uncommon::Rdhwr { rt, register } => {
                let value = self.hardware_register(register);
                self.registers.set(rt, value);
            }
            // The others are executed by the callers.
            _ => {}
        }
    }

    fn previous_registers(&mut self) -> &mut super::registers::Registers {
        if self.system.previous_set() == self.system.current_set() {
            &mut self.registers
        } else {
            &mut self.other_registers
        }
    }

    /// What `rdhwr` reads: number of the core, step of `synci`, Count, cycles of SYSCLK for one count.
    fn hardware_register(&self, register: u8) -> u32 {
        match register {
            2 => self.timer.count(self.cycle),
            3 => 2,
            _ => 0,
        }
    }

    /// A register of coprocessor 0 by its number and select field, as `mfc0` reads it; 0 for one that does not exist.
    pub fn system_register(&self, register: u8, select: u8) -> u32 {
        match (register, select) {
            (9, 0) => self.timer.count(self.cycle),
            (11, 0) => self.timer.compare(),
            _ => self.system.read(register, select),
        }
    }

    /// Writes a register of coprocessor 0 as `mtc0` does.
    pub fn set_system_register(&mut self, register: u8, select: u8, value: u32) {
        match self.system.write(register, select, value) {
            Coprocessor0Write::Plain => {}
            Coprocessor0Write::Count(value) => self.timer.set_count(self.cycle, value),
            Coprocessor0Write::Compare(value) => self.timer.set_compare(self.cycle, value),
            Coprocessor0Write::Cause => self.timer.set_stopped(self.cycle, self.system.is_count_stopped()),
        }
    }

    fn add(&mut self, uncommon: Uncommon) -> Result<(), InstructionFault> {
        let value = |register: Source| self.registers.get(register).cast_signed();
        let (to, sum) = match uncommon {
            Uncommon::Add { rd, rs, rt } => (rd, value(rs).checked_add(value(rt))),
            Uncommon::Sub { rd, rs, rt } => (rd, value(rs).checked_sub(value(rt))),
            Uncommon::Addi {
                rt,
                rs,
                value: addend,
            } => (rt, value(rs).checked_add(i32::from(addend))),
            _ => return Ok(()),
        };
        let sum = sum.ok_or(InstructionFault::plain(ExceptionCode::Overflow))?;
        self.registers.set(to, sum.cast_unsigned());
        Ok(())
    }

    fn branch_uncommon(&mut self, uncommon: Uncommon) -> Flow {
        let (condition, (rs, rt), words) = match uncommon {
            Uncommon::BranchLikely {
                condition,
                rs,
                rt,
                words,
            } => (condition, (rs, rt), words),
            Uncommon::BranchLink { condition, rs, words }
            | Uncommon::BranchLinkLikely { condition, rs, words } => (condition, (rs, Source::new(0)), words),
            _ => return Flow::Next,
        };
        let is_taken = condition.holds(self.registers.get(rs), self.registers.get(rt));
        if !matches!(uncommon, Uncommon::BranchLikely { .. }) {
            self.registers.set(WriteTarget::new(31), self.pc.wrapping_add(8));
        }
        let is_likely = !matches!(uncommon, Uncommon::BranchLink { .. });
        match (is_taken, is_likely) {
            (true, _) => Flow::Branch(self.next.wrapping_add_signed(i32::from(words) * 4)),
            (false, true) => Flow::Skip,
            (false, false) => Flow::NotTaken,
        }
    }

    fn store_conditional<B: Bus>(
        &mut self,
        port: &mut AddressSpace<'_, B>,
        (rt, to): (Source, WriteTarget),
        (base, offset): (Source, i16),
    ) -> Result<(), InstructionFault> {
        let address = self.offset(base, offset);
        if address & 3 != 0 {
            return Err(InstructionFault::at(ExceptionCode::AddressStore, address));
        }
        if self.is_linked {
            self.store(port, (address, Width::Word), self.registers.get(rt))?;
        }
        self.registers.set(to, u32::from(self.is_linked));
        self.is_linked = false;
        Ok(())
    }

    fn offset(&self, base: Source, offset: i16) -> u32 {
        self.registers.get(base).wrapping_add_signed(i32::from(offset))
    }

    fn return_from_exception(&mut self) -> Flow {
        let address = self.system.leave();
        self.select_set();
        self.is_linked = false;
        Flow::Vector(address)
    }

    fn return_from_debug(&mut self) -> Result<Flow, InstructionFault> {
        let address = self.system.leave_debug();
        address
            .map(Flow::Vector)
            .ok_or(InstructionFault::plain(ExceptionCode::Reserved))
    }

    /// Goes where an instruction leads.
    pub(super) fn go(&mut self, flow: Flow, cycles: u64) {
        if flow == Flow::Stop {
            return;
        }
        self.cycle += cycles;
        let next = self.next;
        self.pc = next;
        self.next = next.wrapping_add(4);
        self.in_slot = matches!(flow, Flow::Branch(_) | Flow::NotTaken);
        match flow {
            Flow::Next | Flow::NotTaken | Flow::Stop => {}
            Flow::Branch(target) => self.next = target,
            Flow::Skip => self.continue_at(next.wrapping_add(4)),
            Flow::Vector(target) => {
                self.continue_at(target);
                self.cycle += REFILL_CYCLES;
            }
        }
    }
}

fn trap(holds: bool) -> Result<(), InstructionFault> {
    match holds {
        true => Err(InstructionFault::plain(ExceptionCode::Trap)),
        false => Ok(()),
    }
}
