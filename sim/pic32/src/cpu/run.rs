//! The outer loop: events, interrupts, and the inner loop between them.

use super::exception::{ExceptionCode, InstructionFault};
use super::inner::{Leave, Region};
use super::operation::Operation;
use super::probe::WindowFlow;
use super::uncommon::Flow;
use super::{Bus, Cpu, Exit, Taken};
use crate::memory::{Code, Memory};

/// The lines of boot flash in the prefetch unit begin here; those of program flash at 0.
const BOOT_LINES: u16 = 0x4000;

impl Cpu {
    /// Executes until `until_cycle`, the horizon of the bus, a match of the core timer, a breakpoint or an exception;
    /// at least up to the begin of the first instruction that is not before the earliest of these. In WAIT time goes on
    /// without instructions.
    pub fn run<B: Bus>(&mut self, memory: &mut Memory, bus: &mut B, until_cycle: u64) -> Exit {
        loop {
            let horizon = bus.horizon();
            if let Some(exit) = self.due(until_cycle, horizon) {
                return exit;
            }
            self.accept_interrupt(bus);
            let limit = until_cycle.min(horizon).min(self.timer.due());
            if self.is_waiting {
                self.idle_cycles += limit.saturating_sub(self.cycle);
                self.cycle = self.cycle.max(limit);
            } else if let Some(exit) = self.run_code(memory, bus, limit) {
                return exit;
            }
        }
    }

    /// Executes one instruction, with its delay slot if it has one; interrupts are taken first. In WAIT one cycle passes.
    pub fn step<B: Bus>(&mut self, memory: &mut Memory, bus: &mut B) -> Exit {
        loop {
            // To wait for flash is no step.
            if let Some((code, start)) = self.fetch(memory) {
                self.arrive(self.region(memory, code, start));
            }
            let exit = self.run(memory, bus, self.cycle + 1);
            if exit != Exit::Reached || !self.in_slot {
                return exit;
            }
        }
    }

    fn due(&mut self, until_cycle: u64, horizon: u64) -> Option<Exit> {
        if self.cycle >= self.timer.due() {
            self.timer.serve(self.cycle);
            self.system.set_timer_pending();
            return Some(Exit::CoreTimer);
        }
        let requests = self.system.software_requests();
        if requests != self.software_requests {
            self.software_requests = requests;
            return Some(Exit::SoftwareRequests(requests));
        }
        match self.cycle {
            cycle if cycle >= horizon => Some(Exit::Horizon),
            cycle if cycle >= until_cycle => Some(Exit::Reached),
            _ => None,
        }
    }

    /// Enters the handler of what is requested, if it may be interrupted for that. A request above the current level ends
    /// WAIT even while interrupts are off: so do cores of this family by general knowledge, no source confirms it.
    fn accept_interrupt<B: Bus>(&mut self, bus: &mut B) {
        let Some(request) = self
            .request
            .filter(|request| self.system.is_above_level(*request))
        else {
            return;
        };
        self.is_waiting = false;
        if !self.system.accepts_interrupts() {
            return;
        }
        let vector = self.system.enter_interrupt(request, self.pc, self.in_slot);
        self.vector_to(vector);
        bus.interrupt_taken(Taken {
            request,
            cycle: self.cycle,
        });
    }

    /// Runs the code at the current address up to `limit`, or executes the one instruction that ended it.
    fn run_code<B: Bus>(&mut self, memory: &mut Memory, bus: &mut B, limit: u64) -> Option<Exit> {
        if self.is_in_window() {
            return self.run_probed(memory, bus, limit);
        }
        let Some((code, start)) = self.fetch(memory) else {
            return Some(Exit::Exception(self.raise(self.fetch_fault())));
        };
        let region = self.region(memory, code, start);
        self.arrive(region);
        let leave = self.run_region(memory.open(code, &mut [Operation::Nop]), region, limit);
        let Leave::Uncommon(operation) = leave else {
            return None;
        };
        self.execute_outside((operation, region.fetch), (memory, bus), limit)
    }

    /// Executes an instruction that the inner loop left; it takes `fetch` cycles. One that waits for the probe waits up to
    /// `limit`.
    pub(super) fn execute_outside<B: Bus>(
        &mut self,
        (operation, fetch): (Operation, u64),
        (memory, bus): (&mut Memory, &mut B),
        limit: u64,
    ) -> Option<Exit> {
        let outcome = match self.reach_window(operation) {
            Some(WindowFlow::Waits) => {
                self.cycle = self.cycle.max(limit);
                return None;
            }
            Some(WindowFlow::Done(flow)) => Ok(flow),
            None => self.execute(operation, memory, bus),
        };
        match outcome {
            Ok(Flow::Stop) => Some(Exit::Breakpoint),
            Ok(flow) => {
                self.go(flow, fetch);
                None
            }
            Err(fault) => Some(Exit::Exception(self.raise(fault))),
        }
    }

    /// The code at the current address and where it begins.
    fn fetch(&self, memory: &Memory) -> Option<(Code, u32)> {
        if self.pc & 3 != 0 || self.system.is_user() {
            return None;
        }
        let physical = self.physical(self.pc)?;
        let (code, start) = memory.code(physical)?;
        Some((code, self.pc.wrapping_sub(physical - start)))
    }

    /// What is wrong with the current address. In user mode the kernel's segments may not be named; this part has no memory
    /// for the user's.
    fn fetch_fault(&self) -> InstructionFault {
        let is_forbidden = self.system.is_user() && self.pc >> 31 != 0;
        match self.pc & 3 != 0 || is_forbidden {
            true => InstructionFault::at(ExceptionCode::AddressLoad, self.pc),
            false => InstructionFault::at(ExceptionCode::BusFetch, self.pc),
        }
    }

    fn region(&self, memory: &Memory, code: Code, base: u32) -> Region {
        let timing = memory.flash_timing();
        let flash_wait = u64::from(timing.wait_states);
        let is_flash = !matches!(code, Code::Ram(_));
        let is_prefetched = is_flash && timing.prefetches(self.pc);
        let first_line = if code == Code::Boot { BOOT_LINES } else { 0 };
        Region {
            base,
            first_line: is_prefetched.then_some(first_line),
            fetch: if is_flash && !is_prefetched {
                1 + flash_wait
            } else {
                1
            },
            flash_wait,
            ram_wait: u64::from(memory.ram_wait_states()),
        }
    }
}
