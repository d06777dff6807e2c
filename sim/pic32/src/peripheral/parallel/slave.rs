//! The parallel port as a slave: four bytes each way, which another machine's strobes take and give.

/// PMSTAT: each output buffer is empty, all are, one was read while it was empty.
const OUTPUT_EMPTY: u32 = 1 << 7;
const UNDERFLOW: u32 = 1 << 6;
/// Each input buffer is full from bit 8 on, all are, one was written while it was full.
const INPUT_FULL_SHIFT: u32 = 8;
const INPUT_FULL: u32 = 1 << 15;
const OVERFLOW: u32 = 1 << 14;

/// Which buffer the strobes use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BufferChoice {
    /// The first.
    First,
    /// The one that PMA1:PMA0 name.
    Addressed,
    /// One after the other.
    InTurn,
}

/// The slave's buffers and what the lines did.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlaveBuffers {
    full: u8,
    empty: u8,
    overflow: bool,
    underflow: bool,
    read_turn: u8,
    write_turn: u8,
    /// The buffer that is on the data lines.
    reading: Option<u8>,
    writing: Option<u8>,
}

impl Default for SlaveBuffers {
    fn default() -> SlaveBuffers {
        SlaveBuffers {
            full: 0,
            empty: 0xF,
            overflow: false,
            underflow: false,
            read_turn: 0,
            write_turn: 0,
            reading: None,
            writing: None,
        }
    }
}

/// The strobes and the address of the other machine, active or not.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlaveLines {
    pub(super) reads: bool,
    pub(super) writes: bool,
    pub(super) address: u8,
}

/// What ended with a strobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlaveAccess {
    /// This buffer was read.
    Read(u8),
    /// This buffer is to take what is on the lines; not when it was full.
    Written { buffer: u8, takes: bool },
}

impl SlaveAccess {
    pub(super) fn buffer(self) -> u8 {
        match self {
            SlaveAccess::Read(buffer) | SlaveAccess::Written { buffer, .. } => buffer,
        }
    }
}

impl SlaveBuffers {
    /// PMSTAT.
    pub(super) fn status(&self, choice: BufferChoice) -> u32 {
        let used = if choice == BufferChoice::First { 1 } else { 0xF };
        let flag = |set: bool, bit: u32| if set { bit } else { 0 };
        u32::from(self.empty)
            | u32::from(self.full) << INPUT_FULL_SHIFT
            | flag(self.empty & used == used, OUTPUT_EMPTY)
            | flag(self.full & used == used, INPUT_FULL)
            | flag(self.underflow, UNDERFLOW)
            | flag(self.overflow, OVERFLOW)
    }

    /// PMSTAT is written.
    pub(super) fn clear_status(&mut self, value: u32) {
        self.underflow &= value & UNDERFLOW != 0;
        self.overflow &= value & OVERFLOW != 0;
    }

    /// The program reads PMDIN.
    pub(super) fn take_input(&mut self) {
        self.full = 0;
    }

    /// The program writes PMDOUT.
    pub(super) fn give_output(&mut self) {
        self.empty = 0;
    }

    /// The buffer that is on the data lines now.
    pub(super) fn reading(&self) -> Option<u8> {
        self.reading
    }

    /// The lines are these now.
    pub(super) fn follow(&mut self, lines: SlaveLines, choice: BufferChoice) -> Option<SlaveAccess> {
        let chosen = |turn: u8| match choice {
            BufferChoice::First => 0,
            BufferChoice::Addressed => lines.address,
            BufferChoice::InTurn => turn,
        };
        if lines.reads && self.reading.is_none() {
            self.reading = Some(chosen(self.read_turn));
        } else if !lines.reads
            && let Some(buffer) = self.reading.take()
        {
            self.underflow |= self.empty >> buffer & 1 != 0;
            self.empty |= 1 << buffer;
            self.read_turn = (buffer + 1) % 4;
            return Some(SlaveAccess::Read(buffer));
        }
        if lines.writes && self.writing.is_none() {
            self.writing = Some(chosen(self.write_turn));
        } else if !lines.writes
            && let Some(buffer) = self.writing.take()
        {
            let takes = self.full >> buffer & 1 == 0;
            self.overflow |= !takes;
            self.full |= 1 << buffer;
            self.write_turn = (buffer + 1) % 4;
            return Some(SlaveAccess::Written { buffer, takes });
        }
        None
    }
}
