//! What the program did that works by luck or not at all.

use crate::cpu::{CoreFault, External};

/// A misuse of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misuse {
    /// See the fault.
    Core(CoreFault),
    /// MOVX beyond the memory on the chip: it moves the pins P0, P2, P3.6 and P3.7.
    ExternalBus(External),
    /// A register that the part's reference does not name.
    UnknownRegister(u8),
    /// SBUF was written while a byte was being sent, which is cut off.
    SentTooEarly,
    /// ISP_TRIG without ISPEN.
    FlashNotEnabled,
    /// An address that is not in data flash.
    FlashAddress(u16),
    /// A waiting time that does not exist.
    FlashWait(u8),
    /// A command that does not exist.
    FlashCommand(u8),
    /// T2OE: the clock on P1.0, which is not modelled.
    ClockOutput,
}

impl Misuse {
    /// Whether it is the same kind. An address of memory may differ, a register may not.
    fn is_like(&self, other: &Misuse) -> bool {
        match (self, other) {
            (Misuse::UnknownRegister(register), Misuse::UnknownRegister(other)) => register == other,
            (Misuse::Core(fault), Misuse::Core(other)) => fault == other,
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }
}

/// A kind of misuse and where it came first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MisuseRecord {
    /// What.
    pub misuse: Misuse,
    /// When first.
    pub cycle: u64,
    /// Address of the instruction.
    pub pc: u16,
    /// How often.
    pub count: u64,
}

/// All of them, each kind once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    records: Vec<MisuseRecord>,
    /// Records that do not know their instruction yet.
    unplaced: bool,
}

impl Record {
    pub(super) fn note(&mut self, misuse: Misuse, cycle: u64) {
        if let Some(record) = self
            .records
            .iter_mut()
            .find(|record| record.misuse.is_like(&misuse))
        {
            record.count += 1;
            return;
        }
        self.unplaced = true;
        self.records.push(MisuseRecord {
            misuse,
            cycle,
            pc: 0,
            count: 0,
        });
    }

    /// Whether an instruction must be named for a new record.
    pub(super) fn is_unplaced(&self) -> bool {
        self.unplaced
    }

    /// Names the instruction that caused what is new.
    pub(super) fn place(&mut self, pc: u16) {
        if !std::mem::take(&mut self.unplaced) {
            return;
        }
        for record in self.records.iter_mut().filter(|record| record.count == 0) {
            record.pc = pc;
            record.count = 1;
        }
    }

    pub(super) fn all(&self) -> &[MisuseRecord] {
        &self.records
    }
}
