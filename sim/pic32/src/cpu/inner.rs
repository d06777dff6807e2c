//! The inner loop: runs decoded code until something happens that it leaves to others.
//!
//! It calls nothing, so that everything it needs stays in registers of the host. The state of the core is taken over at its
//! begin and handed back at its end. Addresses of instructions are indexes into the code here; an address outside of the
//! code is an index beyond its end, from which the address can be had back (see [`Region::address`]).

use super::Cpu;
use super::operation::Operation;
use super::prefetch::line_of;
use super::registers::Target;
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
    fn jump(self, target: u32) -> usize {
        self.index(self.base & 0xF000_0000 | target)
    }

    /// The address after the delay slot of the instruction at `index`.
    #[inline(always)]
    fn link(self, index: usize) -> u32 {
        self.base.wrapping_add(index as u32 * 4).wrapping_add(8)
    }
}

/// Where the inner loop stands.
#[derive(Clone, Copy, Debug)]
struct Frame {
    index: usize,
    next: usize,
    cycle: u64,
    /// The cycle at which the delay slot of the last branch begins: the instruction at that cycle is the slot.
    slot: u64,
    /// The line at which the last jump ended.
    line: u16,
}

impl Frame {
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
        cpu.next = region.address(self.next);
        cpu.cycle = self.cycle;
        cpu.in_slot = self.slot == self.cycle;
        cpu.line = region.first_line.map(|_| self.line);
    }
}

/// What became of an instruction in one of the groups below.
#[derive(Clone, Copy, Debug)]
pub(super) enum Outcome<T> {
    /// It is of another group.
    Other,
    /// It is of this group but cannot be done here.
    Refused,
    /// It was done.
    Done(T),
}

impl Cpu {
    /// Executes from the current instruction on, up to the first one that does not begin before `limit`.
    pub(super) fn run_region(&mut self, mut memory: Open<'_>, region: Region, limit: u64) -> Leave {
        let code = memory.code;
        let mut frame = Frame::new(self, region);
        let leave = loop {
            if frame.cycle >= limit {
                break Leave::Limit;
            }
            let Some(operation) = code.get(frame.index) else {
                break Leave::Outside;
            };
            let at = frame.advance(region.fetch);
            // The order matters for nothing but speed: all of it becomes one jump table.
            if let Outcome::Done(()) = self.compute(operation) {
                continue;
            }
            match self.access(operation, &mut memory, region) {
                Outcome::Done(wait) => {
                    frame.cycle += wait;
                    continue;
                }
                Outcome::Refused => {
                    frame.undo(at, region.fetch);
                    break Leave::Uncommon(*operation);
                }
                Outcome::Other => {}
            }
            if let Outcome::Done(end) = self.multiply(operation, frame.cycle) {
                frame.cycle = end;
                continue;
            }
            match self.branch(operation, at, region) {
                Outcome::Done(target) => self.follow(&mut frame, region, target),
                Outcome::Refused => frame.slot = frame.cycle,
                Outcome::Other => {
                    frame.undo(at, region.fetch);
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
    fn follow(&mut self, frame: &mut Frame, region: Region, target: usize) {
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

    /// Branches and jumps, which give the index of their target; refused is what is not taken.
    #[inline(always)]
    fn branch(&mut self, operation: &Operation, at: usize, region: Region) -> Outcome<usize> {
        let r = &mut self.registers;
        let (is_taken, words) = match *operation {
            Operation::Beq { rs, rt, words } => (r.get(rs) == r.get(rt), words),
            Operation::Bne { rs, rt, words } => (r.get(rs) != r.get(rt), words),
            Operation::Blez { rs, words } => (signed(r.get(rs)) <= 0, words),
            Operation::Bgtz { rs, words } => (signed(r.get(rs)) > 0, words),
            Operation::Bltz { rs, words } => (signed(r.get(rs)) < 0, words),
            Operation::Bgez { rs, words } => (signed(r.get(rs)) >= 0, words),
            Operation::J { target } => return Outcome::Done(region.jump(target)),
            Operation::Jal { target } => {
                r.set(Target::new(31), region.link(at));
                return Outcome::Done(region.jump(target));
            }
            Operation::Jr { rs } => return Outcome::Done(region.index(r.get(rs))),
            Operation::Jalr { rd, rs } => {
                let target = r.get(rs);
                r.set(rd, region.link(at));
                return Outcome::Done(region.index(target));
            }
            _ => return Outcome::Other,
        };
        match is_taken {
            true => Outcome::Done(at.wrapping_add_signed(words as isize)),
            false => Outcome::Refused,
        }
    }
}

#[inline(always)]
fn signed(value: u32) -> i32 {
    value.cast_signed()
}
