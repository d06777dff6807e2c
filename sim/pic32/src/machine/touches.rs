//! Which words of memory the program touches, and how first: a campaign that breaks memory need not try words that nobody
//! reads.

use std::collections::HashMap;

use super::{Halt, Machine, Surroundings};

/// The first thing that the program did to a word of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// It read it, or a part of it, or executed it.
    Read,
    /// It wrote all of it.
    Written,
}

/// Words and what was done to them first.
#[derive(Clone, Debug, Default)]
pub(super) struct Touches {
    first: HashMap<u32, Touch>,
}

/// What an instruction does to memory besides being fetched.
enum Transfer {
    Load(u32),
    StoreWord(u32),
    Nothing,
}

impl Touches {
    fn note(&mut self, address: u32, touch: Touch) {
        self.first.entry(address & 0x1FFF_FFFC).or_insert(touch);
    }
}

impl Machine {
    /// From now on the machine goes instruction by instruction and notes which words of memory the program touches. Not
    /// seen is what the very first instruction of an interrupt's handler loads or stores. A store to a part of a word is
    /// left out: the rest of the word keeps what it was.
    pub fn note_touches(&mut self) {
        self.touches = Some(Box::default());
    }

    /// Physical addresses of words that were touched since the last call, each once, and what was done to them first.
    pub fn take_touches(&mut self) -> impl Iterator<Item = (u32, Touch)> + use<> {
        let touches = self.touches.as_deref_mut().map(std::mem::take);
        touches.unwrap_or_default().first.into_iter()
    }

    /// [`Machine::run_until`] with notes.
    pub(super) fn run_noting(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) -> Halt {
        while self.cycle < cycle {
            let (pc, entries) = (self.cpu.pc(), self.accounting.entries());
            let instruction = self.instruction(pc);
            let transfers = [pc, pc.wrapping_add(4)].map(|address| self.transfer(address));
            let halt = if self.cpu.is_waiting() {
                self.idle_noting(cycle, surroundings)
            } else {
                self.step(surroundings)
            };
            if halt != Halt::Reached {
                return halt;
            }
            let Some(touches) = self.touches.as_deref_mut() else {
                break;
            };
            if self.accounting.entries() != entries {
                touches.note(self.cpu.pc().wrapping_sub(4), Touch::Read);
                continue;
            }
            touches.note(pc, Touch::Read);
            let [own, slot] = transfers;
            touches.transfer(&own);
            if instruction.is_some_and(has_slot) {
                touches.note(pc.wrapping_add(4), Touch::Read);
                touches.transfer(&slot);
            }
        }
        self.run_plainly(cycle, surroundings)
    }

    /// One cycle of WAIT, in which an interrupt may end it, and then all up to the next event.
    fn idle_noting(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) -> Halt {
        let halt = self.step(surroundings);
        if halt == Halt::Reached && self.cpu.is_waiting() {
            let next = cycle.min(self.chip.next_event());
            if next > self.cycle {
                return self.advance(next).unwrap_or(Halt::Reached);
            }
        }
        halt
    }

    fn instruction(&self, address: u32) -> Option<u32> {
        let mut bytes = [0; 4];
        self.memory.read(address & 0x1FFF_FFFC, &mut bytes).ok()?;
        Some(u32::from_le_bytes(bytes))
    }

    fn transfer(&self, address: u32) -> Transfer {
        let Some(instruction) = self.instruction(address) else {
            return Transfer::Nothing;
        };
        let base = (instruction >> 21 & 31) as u8;
        let offset = i32::from(instruction as i16).cast_unsigned();
        let place = self.cpu.register(base).wrapping_add(offset);
        match instruction >> 26 {
            // LB to LWR, LL.
            0x20..=0x26 | 0x30 => Transfer::Load(place),
            // SW, SC.
            0x2B | 0x38 => Transfer::StoreWord(place),
            _ => Transfer::Nothing,
        }
    }
}

impl Touches {
    fn transfer(&mut self, transfer: &Transfer) {
        match *transfer {
            Transfer::Load(place) => self.note(place, Touch::Read),
            Transfer::StoreWord(place) => self.note(place, Touch::Written),
            Transfer::Nothing => {}
        }
    }
}

/// Whether the instruction is a jump or branch.
fn has_slot(instruction: u32) -> bool {
    match instruction >> 26 {
        // JR and JALR.
        0 => matches!(instruction & 0x3F, 8 | 9),
        1..=7 | 0x14..=0x17 => true,
        _ => false,
    }
}
