//! The inner loop: runs decoded code until something happens that it leaves to others.
//!
//! It calls nothing, so that everything it needs stays in registers of the host. The state of the core is taken over at
//! its begin and handed back at its end. Addresses of instructions are indexes into the code here; an address outside
//! of the code is an index beyond its end, from which the address can be had back (see [`Region::address`]).

use super::Cpu;
use super::operation::Operation;
use super::prefetch::line_of;
use crate::memory::Open;

/// Code that is executed without a break, and what its fetches cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Virtual address of its first instruction.
    pub(super) base: u32,
    /// Its first line in the prefetch unit; none when its fetches do not go through the unit.
    pub(super) first_line: Option<u16>,
    /// Cycles that each instruction takes.
    pub(super) fetch: u64,
    /// Cycles that a fetch or load from flash takes beyond one.
    pub(super) flash_wait: u64,
    /// Cycles that a load from RAM takes beyond one.
    pub(super) ram_wait: u64,
}

/// Why the inner loop ended. The next instruction is the one that it could not execute.
#[derive(Clone, Copy, Debug)]
pub(super) enum Leave {
    /// The cycle is reached.
    Limit,
    /// The next instruction lies elsewhere.
    Outside,
    /// This one is for others: an uncommon one, or a load or store of something else than memory.
    Uncommon(Operation),
}

impl Region {
    /// The index of an address. A misaligned address has an index beyond all code.
    #[inline(always)]
    pub(super) fn index(self, address: u32) -> usize {
        address.wrapping_sub(self.base).rotate_right(2) as usize
    }

    /// The address of an index. Indexes of more than 32 bits come from running or branching over an end of the code.
    pub(super) fn address(self, index: usize) -> u32 {
        let offset = match u32::try_from(index) {
            Ok(index) => index.rotate_left(2),
            Err(_) => (index as u32).wrapping_mul(4),
        };
        self.base.wrapping_add(offset)
    }

    /// The index of a jump's target.
    #[inline(always)]
    pub(super) fn jump(self, target: u32) -> usize {
        self.index(self.base & 0xF000_0000 | target)
    }

    /// The address after the delay slot of the instruction at `index`.
    #[inline(always)]
    pub(super) fn link(self, index: usize) -> u32 {
        self.base.wrapping_add(index as u32 * 4).wrapping_add(8)
    }
}

/// State of the inner loop.
#[derive(Clone, Copy, Debug)]
struct LoopState {
    index: usize,
    next: usize,
    cycle: u64,
    /// The cycle at which the delay slot of the last branch begins: the instruction at that cycle is the slot.
    slot: u64,
    /// The line at which the last jump ended.
    line: u16,
}

impl LoopState {
    fn new(cpu: &Cpu, region: Region) -> Self {
        Self {
            index: region.index(cpu.pc),
            next: region.index(cpu.next),
            cycle: cpu.cycle,
            slot: if cpu.in_slot { cpu.cycle } else { u64::MAX },
            line: cpu.line.unwrap_or(0),
        }
    }

    /// Goes on to the next instruction and gives the index of this one.
    #[inline(always)]
    fn advance(&mut self, cycles: u64) -> usize {
        let at = self.index;
        self.index = self.next;
        self.next = self.index.wrapping_add(1);
        self.cycle += cycles;
        at
    }

    /// Takes [`Self::advance`] back.
    fn undo(&mut self, at: usize, cycles: u64) {
        self.next = self.index;
        self.index = at;
        self.cycle -= cycles;
    }

    fn save(self, cpu: &mut Cpu, region: Region) {
        cpu.pc = region.address(self.index);
        // The word behind the one before the code has an index of its own, which is not 0.
        cpu.next = match self.next == self.index.wrapping_add(1) {
            true => cpu.pc.wrapping_add(4),
            false => region.address(self.next),
        };
        cpu.cycle = self.cycle;
        cpu.in_slot = self.slot == self.cycle;
        cpu.line = region.first_line.map(|_| self.line);
    }
}

/// What the loop has to do after an instruction.
#[derive(Clone, Copy, Debug)]
pub(super) enum After {
    /// To go on.
    Next,
    /// To wait for some cycles.
    Wait(u64),
    /// To go on; the next instruction is a delay slot.
    Slot,
    /// To go to this index after the delay slot.
    Jump(usize),
    /// To leave: it was not done.
    Refused,
}

/// What instructions work on besides the core.
#[derive(Debug)]
pub(super) struct ExecutionContext<'a> {
    pub(super) memory: Open<'a>,
    pub(super) region: Region,
    /// Index of the instruction.
    pub(super) at: usize,
    /// The cycle at which it ends if it need not wait.
    pub(super) end: u64,
}

impl Cpu {
    /// Executes from the current instruction on, up to the first one that does not begin before `limit`.
    pub(super) fn run_region(&mut self, memory: Open<'_>, region: Region, limit: u64) -> Leave {
        let code = memory.code;
        let mut frame = LoopState::new(self, region);
        let mut scene = ExecutionContext {
            memory,
            region,
            at: 0,
            end: 0,
        };
        let leave = loop {
            if frame.cycle >= limit {
                break Leave::Limit;
            }
            let Some(operation) = code.get(frame.index) else {
                break Leave::Outside;
            };
            scene.at = frame.advance(region.fetch);
            scene.end = frame.cycle;
            match self.perform(operation, &mut scene) {
                After::Next => {}
                After::Wait(cycles) => frame.cycle += cycles,
                After::Slot => frame.slot = frame.cycle,
                After::Jump(target) => self.follow(&mut frame, region, target),
                After::Refused => {
                    frame.undo(scene.at, region.fetch);
                    break Leave::Uncommon(*operation);
                }
            }
        };
        frame.save(self, region);
        if matches!(leave, Leave::Outside) {
            self.line = None;
        }
        leave
    }

    /// Fetches the line of flash where execution begins when the core comes from elsewhere.
    pub(super) fn arrive(&mut self, region: Region) {
        let Some(first) = region.first_line else { return };
        if self.line.is_some() {
            return;
        }
        let line = line_of(first, region.index(self.pc));
        if self.prefetch.misses(line) {
            self.cycle += region.flash_wait;
        }
        self.line = Some(line);
    }

    /// A jump is taken after the next instruction.
    #[inline(always)]
    fn follow(&mut self, frame: &mut LoopState, region: Region, target: usize) {
        if let Some(first) = region.first_line {
            let (end, line) = (line_of(first, frame.index), line_of(first, target));
            if self.prefetch.jump(frame.line, end, line) {
                frame.cycle += region.flash_wait;
            }
            frame.line = line;
        }
        frame.next = target;
        frame.slot = frame.cycle;
    }
}
