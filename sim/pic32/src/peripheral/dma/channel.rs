//! One DMA channel: its registers, and what a byte that it has moved leads to.

const CHEN: u32 = 1 << 7;
const EVENT_DETECTED: u32 = 1 << 2;
const AUTO_ENABLE: u32 = 1 << 4;
const CHAINED: u32 = 1 << 5;
const EVENTS_WHILE_OFF: u32 = 1 << 6;
const CHAINED_TO_HIGHER: u32 = 1 << 8;
const CONTROL_WRITABLE: u32 = 0x1F3;

const ABORT_BY_IRQ: u32 = 1 << 3;
const START_BY_IRQ: u32 = 1 << 4;
const PATTERN: u32 = 1 << 5;
const ABORT: u32 = 1 << 6;
const FORCE: u32 = 1 << 7;
const EVENTS_WRITABLE: u32 = 0x00FF_FF38;
const EVENTS_RESET: u32 = 0x00FF_FF00;

const INTERRUPTS_WRITABLE: u32 = 0x00FF_00FF;
const ADDRESS_ERROR: u32 = 1 << 0;
const ABORTED: u32 = 1 << 1;
const CELL_DONE: u32 = 1 << 2;
const BLOCK_DONE: u32 = 1 << 3;
const DESTINATION_HALF: u32 = 1 << 4;
const DESTINATION_DONE: u32 = 1 << 5;
const SOURCE_HALF: u32 = 1 << 6;
const SOURCE_DONE: u32 = 1 << 7;

/// One side of a transfer.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    start: u32,
    size: u32,
    pointer: u32,
}

impl Side {
    /// The physical address of the next byte.
    pub(super) fn address(self) -> u32 {
        self.start.wrapping_add(self.pointer)
    }

    pub(super) fn bytes(self) -> u32 {
        whole(self.size)
    }

    /// The widest access that begins at the next byte: a power of two.
    fn fitting(self) -> u32 {
        let left = self.bytes() - self.pointer;
        let aligned = 1 << self.address().trailing_zeros().min(2);
        [4, 2, 1]
            .into_iter()
            .find(|&width| width <= left && width <= aligned)
            .unwrap_or(1)
    }

    /// Flags of half and whole that moving on by so many bytes sets.
    fn advance(&mut self, bytes: u32, (half, done): (u32, u32)) -> u32 {
        let middle = self.bytes() / 2;
        let before = self.pointer;
        self.pointer += bytes;
        let mut flags = if before < middle && self.pointer >= middle {
            half
        } else {
            0
        };
        if self.pointer >= self.bytes() {
            self.pointer = 0;
            flags |= done;
        }
        flags
    }
}

/// Sizes have 8 bits, and 0 stands for 256.
const fn whole(size: u32) -> u32 {
    match size {
        0 => 256,
        size => size,
    }
}

/// What a channel's write was wrong about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChannelWrite {
    /// Nothing.
    Fine,
    /// Addresses or sizes change while the channel is on.
    WhileOn,
    /// Auto enable and chaining together.
    Combination,
}

/// One channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct DmaChannel {
    control: u32,
    events: u32,
    interrupts: u32,
    pub(super) source: Side,
    pub(super) destination: Side,
    cell_size: u32,
    cell_pointer: u32,
    pattern: u32,
    /// Bytes of the block that were moved.
    moved: u32,
    /// A cell is to be moved, or under way.
    cell: bool,
    /// A start event that no cell has begun for.
    event: bool,
}

impl DmaChannel {
    pub(super) const OFF: DmaChannel = DmaChannel {
        control: 0,
        events: EVENTS_RESET,
        interrupts: 0,
        source: Side {
            start: 0,
            size: 0,
            pointer: 0,
        },
        destination: Side {
            start: 0,
            size: 0,
            pointer: 0,
        },
        cell_size: 0,
        cell_pointer: 0,
        pattern: 0,
        moved: 0,
        cell: false,
        event: false,
    };

    pub(super) fn read(&self, word: u8) -> u32 {
        match word {
            0 => self.control | if self.event { EVENT_DETECTED } else { 0 },
            1 => self.events,
            2 => self.interrupts,
            3 => self.source.start,
            4 => self.destination.start,
            5 => self.source.size,
            6 => self.destination.size,
            7 => self.source.pointer,
            8 => self.destination.pointer,
            9 => self.cell_size,
            10 => self.cell_pointer,
            _ => self.pattern,
        }
    }

    pub(super) fn write(&mut self, word: u8, value: u32) -> ChannelWrite {
        let was_on = self.is_on();
        match word {
            0 => return self.write_control(value),
            1 => self.write_events(value),
            2 => self.interrupts = value & INTERRUPTS_WRITABLE,
            3 => self.source.start = value,
            4 => self.destination.start = value,
            5 => self.source.size = value & 0xFF,
            6 => self.destination.size = value & 0xFF,
            9 => self.cell_size = value & 0xFF,
            11 => self.pattern = value & 0xFF,
            _ => {}
        }
        match word {
            3..=6 | 9 | 11 if was_on => ChannelWrite::WhileOn,
            _ => ChannelWrite::Fine,
        }
    }

    fn write_control(&mut self, value: u32) -> ChannelWrite {
        self.control = value & CONTROL_WRITABLE;
        match self.control & (AUTO_ENABLE | CHAINED) {
            both if both == AUTO_ENABLE | CHAINED => ChannelWrite::Combination,
            _ => ChannelWrite::Fine,
        }
    }

    fn write_events(&mut self, value: u32) {
        self.events = value & EVENTS_WRITABLE;
        if value & ABORT != 0 {
            self.abort();
        }
        if value & FORCE != 0 {
            self.note_event();
        }
    }

    fn is_on(&self) -> bool {
        self.control & CHEN != 0
    }

    /// 0..=3, 3 the highest.
    pub(super) fn priority(&self) -> u32 {
        self.control & 3
    }

    /// Whether there is something to move now. `lines` are the level-type requests that are up.
    pub(super) fn wants_to_move(&self, lines: u64) -> bool {
        self.is_on() && (self.cell || self.event || self.is_called_by(lines))
    }

    fn is_called_by(&self, requests: u64) -> bool {
        self.events & START_BY_IRQ != 0 && requests >> (self.events >> 8 & 0x3F) & 1 != 0
    }

    fn is_ended_by(&self, requests: u64) -> bool {
        self.events & ABORT_BY_IRQ != 0 && requests >> (self.events >> 16 & 0x3F) & 1 != 0
    }

    /// The requests that it listens to.
    pub(super) fn listens_to(&self) -> u64 {
        let number = |shift: u32| 1_u64 << (self.events >> shift & 0x3F);
        let start = if self.events & START_BY_IRQ != 0 {
            number(8)
        } else {
            0
        };
        let abort = if self.events & ABORT_BY_IRQ != 0 {
            number(16)
        } else {
            0
        };
        start | abort
    }

    /// Requests that were raised.
    pub(super) fn hear(&mut self, requests: u64) {
        if self.is_on() && self.is_ended_by(requests) {
            self.abort();
        } else if self.is_called_by(requests) {
            self.note_event();
        }
    }

    /// Requests that are up.
    pub(super) fn follow(&mut self, lines: u64) {
        if self.is_on() && self.is_ended_by(lines) {
            self.abort();
        }
    }

    fn note_event(&mut self) {
        self.event |= self.control & (CHEN | EVENTS_WHILE_OFF) != 0;
    }

    fn abort(&mut self) {
        self.interrupts |= ABORTED;
        self.control &= !CHEN;
        self.restart();
    }

    fn restart(&mut self) {
        self.source.pointer = 0;
        self.destination.pointer = 0;
        self.cell_pointer = 0;
        self.moved = 0;
        self.cell = false;
        self.event = false;
    }

    /// No memory and no register is where it was to read or write.
    pub(super) fn fail(&mut self) {
        self.interrupts |= ADDRESS_ERROR;
        self.control &= !CHEN;
        self.restart();
    }

    /// Whether an interrupt is asked for.
    pub(super) fn line(&self) -> bool {
        self.interrupts & self.interrupts >> 16 & 0xFF != 0
    }

    fn block(&self) -> u32 {
        self.source.bytes().max(self.destination.bytes())
    }

    /// The next access begins: its width in bytes. `one_sided` when nothing is written.
    pub(super) fn begin_access(&mut self, one_sided: bool) -> u32 {
        if !self.cell {
            (self.cell, self.event) = (true, false);
        }
        // The pattern is looked for byte by byte.
        if self.events & PATTERN != 0 {
            return 1;
        }
        let left = (whole(self.cell_size) - self.cell_pointer).min(self.block() - self.moved);
        let fits = match one_sided {
            true => self.source.fitting(),
            false => self.source.fitting().min(self.destination.fitting()),
        };
        [4, 2, 1]
            .into_iter()
            .find(|&width| width <= left && width <= fits)
            .unwrap_or(1)
    }

    /// So many bytes were moved, and this was the last of them; `true` when the block is over.
    pub(super) fn end_access(&mut self, bytes: u32, last: u8, one_sided: bool) -> bool {
        let mut flags = self.source.advance(bytes, (SOURCE_HALF, SOURCE_DONE));
        if !one_sided {
            flags |= self
                .destination
                .advance(bytes, (DESTINATION_HALF, DESTINATION_DONE));
        }
        self.cell_pointer += bytes;
        self.moved += bytes;
        let matches = self.events & PATTERN != 0 && u32::from(last) == self.pattern;
        let ends = matches || self.moved >= self.block();
        if ends || self.cell_pointer >= whole(self.cell_size) {
            flags |= CELL_DONE;
            self.cell_pointer = 0;
            self.cell = false;
        }
        if ends {
            flags |= BLOCK_DONE;
            if self.control & AUTO_ENABLE == 0 {
                self.control &= !CHEN;
            }
            let event = self.event && self.is_on();
            self.restart();
            self.event = event;
        }
        self.interrupts |= flags;
        ends
    }

    /// A neighbour's block is over: the lower one's, or the higher one's.
    pub(super) fn neighbour_ended(&mut self, is_higher: bool) {
        let wanted = self.control & CHAINED_TO_HIGHER != 0;
        if self.control & CHAINED != 0 && wanted == is_higher {
            self.control |= CHEN;
        }
    }
}
