//! Bytes of memory that the program accesses, and the kind of the first access: a campaign that flips bits need not try
//! bytes that are never read.

use std::collections::HashMap;

use super::{Halt, Machine, Surroundings};

/// What the program did first to each byte of a word of memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Touch {
    /// Bytes that it read or executed before it wrote them, by bit; bit 0 is the byte at the word's own address.
    pub read: u8,
    /// Bytes that it wrote before it read them.
    pub written: u8,
    /// It executed the word.
    pub executed: bool,
}

/// Words and what was done to them first.
#[derive(Clone, Debug, Default)]
pub(super) struct Touches {
    first: HashMap<u32, Touch>,
}

/// What an instruction does to memory besides being fetched: bytes of one word, by bit.
enum Transfer {
    Load(u32, u8),
    Store(u32, u8),
    Nothing,
}

/// All bytes of a word.
const WHOLE: u8 = 0b1111;

impl Touches {
    fn of(&mut self, address: u32) -> &mut Touch {
        self.first.entry(address & 0x1FFF_FFFC).or_default()
    }

    fn read(&mut self, address: u32, bytes: u8) {
        let touch = self.of(address);
        touch.read |= bytes & !touch.written;
    }

    fn execute(&mut self, address: u32) {
        self.read(address, WHOLE);
        self.of(address).executed = true;
    }

    fn write(&mut self, address: u32, bytes: u8) {
        let touch = self.of(address);
        touch.written |= bytes & !touch.read;
    }
}

impl Machine {
    /// From now on the machine goes instruction by instruction and notes which bytes of memory the program touches. Not
    /// seen is what the very first instruction of an interrupt's handler loads or stores.
    pub fn note_touches(&mut self) {
        self.touches = Some(Box::default());
    }

    /// Physical addresses of words that were touched since the last call, each once, and what was done to their bytes
    /// first.
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
                touches.execute(self.cpu.pc().wrapping_sub(4));
                continue;
            }
            touches.execute(pc);
            let [own, slot] = transfers;
            touches.transfer(&own);
            if instruction.is_some_and(has_slot) {
                touches.execute(pc.wrapping_add(4));
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
        let byte = place & 3;
        match instruction >> 26 {
            // LB, LBU.
            0x20 | 0x24 => Transfer::Load(place, 1 << byte),
            // LH, LHU.
            0x21 | 0x25 => Transfer::Load(place, 0b11 << (byte & 2)),
            // LWL, LW, LWR, LL.
            0x22 | 0x23 | 0x26 | 0x30 => Transfer::Load(place, WHOLE),
            // SB.
            0x28 => Transfer::Store(place, 1 << byte),
            // SH.
            0x29 => Transfer::Store(place, 0b11 << (byte & 2)),
            // SW, SC. What SWL and SWR write is left out: the rest of the word keeps what it was.
            0x2B | 0x38 => Transfer::Store(place, WHOLE),
            _ => Transfer::Nothing,
        }
    }
}

impl Touches {
    fn transfer(&mut self, transfer: &Transfer) {
        match *transfer {
            Transfer::Load(place, bytes) => self.read(place, bytes),
            Transfer::Store(place, bytes) => self.write(place, bytes),
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
