//! The parallel port: accesses of a master in their phases, and the buffers of a slave.
//!
//! An access has a setup, a strobe and a hold time, counted in clocks of the peripheral bus. The chip's tables do not tell which level
//! the direction line of master mode 1 has when nothing moves (here: that of a write), whether single bytes of a slave's
//! buffers can be taken (here: a reading of PMDIN takes all of them, a writing of PMDOUT fills all), nor what
//! happens to a byte that finds its buffer full (here: it is lost).

pub(super) mod pins;
mod slave;

use super::rate::{CountSpan, NEVER, Now};
use super::schedule::Slot;
use super::{Chip, Irq, Misuse, Unmodelled};
use crate::pins::{Level, Pin};
use slave::{BufferChoice, SlaveAccess, SlaveBuffers, SlaveLines};

/// PMDIN among the registers.
pub(super) const DATA_IN: u8 = 4;

const ON: u32 = 1 << 15;
const MULTIPLEXED: u32 = 3 << 11;
const WRITE_ENABLED: u32 = 1 << 9;
const READ_ENABLED: u32 = 1 << 8;
const SELECT_2_HIGH: u32 = 1 << 4;
const SELECT_1_HIGH: u32 = 1 << 3;
const WRITE_HIGH: u32 = 1 << 1;
const READ_HIGH: u32 = 1 << 0;
const CONTROL_WRITABLE: u32 = 0xBFFB;

const BUSY: u32 = 1 << 15;
const SIXTEEN_BITS: u32 = 1 << 10;
const MODE_WRITABLE: u32 = 0x7FFF;

/// What the port is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Off,
    Slave(BufferChoice),
    /// Separate strobes for reading and writing.
    MasterOfTwo,
    /// One strobe and a direction.
    MasterOfOne,
}

/// What a master is doing.
#[derive(Clone, Copy, Debug)]
struct PortAccess {
    /// Counts clocks of the peripheral bus.
    span: CountSpan,
    /// The clocks at which the strobe begins, at which it ends, and at which the access is over.
    phases: [u64; 3],
    /// How many of them are over.
    phase: usize,
    /// What is written; nothing when it is a reading.
    data: Option<u16>,
}

/// The registers and what is going on.
#[derive(Clone, Debug, Default)]
pub(super) struct ParallelPort {
    control: u32,
    mode: u32,
    address: u32,
    data_out: u32,
    data_in: u32,
    enables: u32,
    buffers: SlaveBuffers,
    access: Option<PortAccess>,
    /// The pins that it drives.
    driven: Vec<(Pin, Level)>,
}

impl ParallelPort {
    fn has(&self, bits: u32) -> bool {
        self.control & bits != 0
    }

    fn role(&self) -> Role {
        match (self.has(ON), self.mode >> 8 & 3) {
            (false, _) => Role::Off,
            (true, 0) if self.mode >> 11 & 3 == 3 => Role::Slave(BufferChoice::InTurn),
            (true, 0) => Role::Slave(BufferChoice::First),
            (true, 1) => Role::Slave(BufferChoice::Addressed),
            (true, 2) => Role::MasterOfTwo,
            (true, _) => Role::MasterOfOne,
        }
    }

    fn is_master(&self) -> bool {
        matches!(self.role(), Role::MasterOfTwo | Role::MasterOfOne)
    }

    fn data_pins(&self) -> &'static [Pin] {
        match self.mode & SIXTEEN_BITS {
            0 => &pins::DATA[..8],
            _ => &pins::DATA,
        }
    }

    pub(super) fn peek(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => self.mode | if self.access.is_some() { BUSY } else { 0 },
            2 => self.address,
            3 => self.data_out,
            DATA_IN => self.data_in,
            5 => self.enables,
            6 => {
                let choice = match self.role() {
                    Role::Slave(choice) => choice,
                    _ => BufferChoice::InTurn,
                };
                self.buffers.status(choice)
            }
            _ => return None,
        })
    }

    /// Writes a register; `false` when an access was under way that it disturbs.
    fn write(&mut self, word: u8, value: u32, now: Now) -> bool {
        let is_free = self.access.is_none();
        match word {
            0 => self.write_control(value),
            1 => self.mode = value & MODE_WRITABLE,
            2 => {
                self.address = value & 0xFFFF;
                return is_free;
            }
            3 => {
                self.data_out = value;
                self.buffers.give_output();
            }
            DATA_IN if self.is_master() => return self.begin(Some(low_half(value)), now),
            DATA_IN => self.data_in = value,
            5 => self.enables = value & 0xFFFF,
            _ => self.buffers.clear_status(value),
        }
        true
    }

    fn write_control(&mut self, value: u32) {
        self.control = value & CONTROL_WRITABLE;
        if !self.has(ON) {
            self.access = None;
            self.buffers = SlaveBuffers::default();
        }
    }

    /// The program has read PMDIN; `false` when an access was under way.
    fn data_was_read(&mut self, now: Now) -> bool {
        match self.role() {
            Role::Off => true,
            Role::Slave(_) => {
                self.buffers.take_input();
                true
            }
            Role::MasterOfTwo | Role::MasterOfOne => self.begin(None, now),
        }
    }

    /// A master's access begins, unless one is under way.
    fn begin(&mut self, data: Option<u16>, now: Now) -> bool {
        if self.access.is_some() {
            return false;
        }
        let field = |shift: u32, mask: u32| u64::from(self.mode >> shift & mask);
        let strobe = field(2, 0xF);
        let (setup, hold) = match strobe {
            0 => (0, 0),
            _ => (field(6, 3), field(0, 3)),
        };
        let begins = setup + 1;
        let ends = begins + strobe + 1;
        let over = ends + hold + u64::from(data.is_some());
        self.access = Some(PortAccess {
            span: CountSpan::new(now.cycle, now.peripheral),
            phases: [begins, ends, over],
            phase: 0,
            data,
        });
        true
    }

    fn change_clock(&mut self, now: Now) {
        if let Some(access) = &mut self.access {
            access.span.change_rate(now.cycle, now.peripheral);
        }
    }

    fn next_event(&self) -> u64 {
        self.access.map_or(NEVER, |access| {
            access
                .phases
                .get(access.phase)
                .map_or(NEVER, |&clocks| access.span.cycle_of(clocks))
        })
    }

    /// A phase ends with these levels on the data lines; `true` when that is an event.
    fn tick(&mut self, lines: u16) -> bool {
        let Some(access) = &mut self.access else {
            return false;
        };
        access.phase += 1;
        let (phase, is_reading) = (access.phase, access.data.is_none());
        if phase == 2 && is_reading {
            self.data_in = u32::from(lines);
        }
        if phase < 2 || phase == 2 && !self.ends_with_strobe() {
            return false;
        }
        self.access = None;
        let step = match self.mode >> 11 & 3 {
            1 => 1,
            2 => 0xFFFF,
            _ => 0,
        };
        // Selects stay; addresses have 14 bits, or as many as there are selects left.
        let address_bits = match self.control >> 6 & 3 {
            0 => 0xFFFF,
            1 => 0x7FFF,
            _ => 0x3FFF,
        };
        let next = self.address.wrapping_add(step) & address_bits;
        self.address = self.address & !address_bits & 0xFFFF | next;
        self.mode >> 13 & 3 == 1
    }

    /// Whether there is no hold time.
    fn ends_with_strobe(&self) -> bool {
        self.access
            .is_some_and(|access| access.phases[1] == access.phases[2])
    }

    /// What the strobes of another machine lead to; `true` when that is an event.
    fn follow(&mut self, lines: SlaveLines, data: u16) -> bool {
        let Role::Slave(choice) = self.role() else {
            return false;
        };
        let Some(access) = self.buffers.follow(lines, choice) else {
            return false;
        };
        if let SlaveAccess::Written { buffer, takes: true } = access {
            let shift = 8 * u32::from(buffer);
            self.data_in = self.data_in & !(0xFF << shift) | u32::from(data & 0xFF) << shift;
        }
        match self.mode >> 13 & 3 {
            1 => true,
            2 => access.buffer() == 3,
            _ => false,
        }
    }

    /// Pins and levels.
    fn outputs(&self) -> Vec<(Pin, Level)> {
        match self.role() {
            Role::Off => Vec::new(),
            Role::Slave(_) => {
                let byte = |buffer: u8| low_half(self.data_out >> (8 * u32::from(buffer)));
                self.buffers
                    .reading()
                    .map_or_else(Vec::new, |buffer| on_lines(&pins::DATA[..8], byte(buffer)))
            }
            role => self.master_outputs(role),
        }
    }

    fn master_outputs(&self, role: Role) -> Vec<(Pin, Level)> {
        let mut outputs = Vec::new();
        let strobes = self.access.is_some_and(|access| access.phase == 1);
        let reads = self.access.is_some_and(|access| access.data.is_none());
        let (read_line, write_line) = match role {
            Role::MasterOfTwo => (strobes && reads, strobes && !reads),
            _ => (reads, strobes),
        };
        if self.has(READ_ENABLED) {
            outputs.push((pins::READ, Level::of(read_line == self.has(READ_HIGH))));
        }
        if self.has(WRITE_ENABLED) {
            outputs.push((pins::WRITE, Level::of(write_line == self.has(WRITE_HIGH))));
        }
        for (line, &pin) in pins::ADDRESS
            .iter()
            .enumerate()
            .filter(|(line, _)| self.enables >> line & 1 != 0)
        {
            outputs.push((pin, self.address_level(line)));
        }
        if let Some(data) = self.access.and_then(|access| access.data) {
            outputs.extend(on_lines(self.data_pins(), data));
        }
        outputs
    }

    fn address_level(&self, line: usize) -> Level {
        let is_set = self.address >> line & 1 != 0;
        let selects = self.access.is_some() && is_set;
        match (line, self.control >> 6 & 3) {
            (15, 1 | 2) => Level::of(selects == self.has(SELECT_2_HIGH)),
            (14, 2) => Level::of(selects == self.has(SELECT_1_HIGH)),
            _ => Level::of(is_set),
        }
    }
}

fn on_lines(pins: &[Pin], data: u16) -> Vec<(Pin, Level)> {
    let level = |line: usize| Level::of(data >> line & 1 != 0);
    pins.iter()
        .enumerate()
        .map(|(line, &pin)| (pin, level(line)))
        .collect()
}

#[expect(clippy::cast_possible_truncation, reason = "there are 16 lines at most")]
const fn low_half(value: u32) -> u16 {
    value as u16
}

impl Chip {
    pub(super) fn write_parallel(&mut self, word: u8, value: u32, cycle: u64) {
        if !self.parallel.write(word, value, self.now(cycle)) {
            self.record.misuse(Misuse::ParallelPortBusy);
        }
        if self.parallel.has(ON) && self.parallel.has(MULTIPLEXED) {
            self.record
                .misuse(Misuse::NotModelled(Unmodelled::MultiplexedAddress));
        }
        self.settle_parallel(cycle);
    }

    /// The program has read PMDIN.
    pub(super) fn read_parallel(&mut self, cycle: u64) {
        if !self.parallel.data_was_read(self.now(cycle)) {
            self.record.misuse(Misuse::ParallelPortBusy);
        }
        self.settle_parallel(cycle);
    }

    pub(super) fn serve_parallel(&mut self, cycle: u64) {
        let lines = self.lines_high(self.parallel.data_pins());
        if self.parallel.tick(lines) {
            self.interrupts.raise(Irq::PARALLEL_PORT, cycle);
        }
        self.settle_parallel(cycle);
    }

    /// One of the lines of another machine changed.
    pub(super) fn hear_parallel(&mut self, cycle: u64) {
        if !matches!(self.parallel.role(), Role::Slave(_)) {
            return;
        }
        let active = |pin: Pin, high: u32| self.reads_high(pin) == self.parallel.has(high);
        let selected = active(pins::SELECT, SELECT_1_HIGH);
        let lines = SlaveLines {
            reads: selected && self.parallel.has(READ_ENABLED) && active(pins::READ, READ_HIGH),
            writes: selected && self.parallel.has(WRITE_ENABLED) && active(pins::WRITE, WRITE_HIGH),
            address: u8::try_from(self.lines_high(&pins::ADDRESS[..2])).unwrap_or(0),
        };
        let data = self.lines_high(&pins::DATA[..8]);
        if self.parallel.follow(lines, data) {
            self.interrupts.raise(Irq::PARALLEL_PORT, cycle);
        }
        self.settle_parallel(cycle);
    }

    fn lines_high(&self, pins: &[Pin]) -> u16 {
        let high = |line: usize, pin: Pin| u16::from(self.reads_high(pin)) << line;
        pins.iter()
            .enumerate()
            .fold(0, |lines, (line, &pin)| lines | high(line, pin))
    }

    pub(super) fn change_parallel_clock(&mut self, cycle: u64) {
        let now = self.now(cycle);
        self.parallel.change_clock(now);
        self.schedule.set(Slot::Parallel, self.parallel.next_event());
    }

    /// What the port does to its pins, and when it goes on.
    fn settle_parallel(&mut self, cycle: u64) {
        let wanted = self.parallel.outputs();
        let before = std::mem::replace(&mut self.parallel.driven, wanted.clone());
        let is_wanted = |pin: Pin| wanted.iter().any(|(other, _)| *other == pin);
        // Only pins that the port drove: the others may belong to somebody else.
        for (pin, _) in before.iter().filter(|(pin, _)| !is_wanted(*pin)) {
            self.own(*pin, None, cycle);
        }
        for (pin, level) in wanted.iter().filter(|drive| !before.contains(drive)) {
            self.own(*pin, Some(*level), cycle);
        }
        self.schedule.set(Slot::Parallel, self.parallel.next_event());
    }
}
