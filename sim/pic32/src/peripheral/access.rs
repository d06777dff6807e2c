//! Reading and writing special function registers: bytes, halves, CLR, SET and INV, and what a write sets in motion.

use super::calendar::CalendarWrite;
use super::nvm::Started;
use super::ports::Field;
use super::register::{Block, Register, Via};
use super::system::SystemWrite;
use super::timers::TimerWrite;
use super::{AccessDirection, Chip, Misuse, Order, ResetSource, Slot, Unmodelled, parallel};
use crate::cpu::{Access, Width};
use crate::pins::Port;

/// PORTx among the registers of a port.
const PORT: u8 = 1;
/// LATx.
const LAT: u8 = 2;
/// IFS0 to IEC1 among the registers of the interrupt controller.
const FLAGS_AND_ENABLES: std::ops::RangeInclusive<u8> = 3..=7;
/// IEC0 and IEC1.
const ENABLES: std::ops::RangeInclusive<u8> = 6..=7;

impl Chip {
    /// The program reads. Registers that the reference does not name read as 0.
    pub(crate) fn load(&mut self, access: Access) -> u32 {
        self.set_place(access.pc, access.cycle);
        // What CLR, SET and INV read as is undefined.
        let found = Register::at(access.address).filter(|_| Via::of(access.address) == Via::Plain);
        let Some(register) = found else {
            self.record.unknown(access.address, AccessDirection::Read);
            return 0;
        };
        let value = self.peek(register, access.cycle);
        self.note_read(register, access.cycle);
        value >> (8 * (access.address & 3))
    }

    /// The program writes.
    pub(crate) fn store(&mut self, access: Access, value: u32) {
        self.set_place(access.pc, access.cycle);
        let via = Via::of(access.address);
        let found = Register::at(access.address);
        let Some(register) = found.filter(|register| via == Via::Plain || register.has_bit_operations())
        else {
            self.record.unknown(access.address, AccessDirection::Write);
            return;
        };
        let value = if via == Via::Plain && access.width == Width::Word {
            value
        } else {
            let shift = 8 * (access.address & 3);
            let lanes = lanes_of(access.width) << shift;
            let old = self.held(register, access.cycle);
            let new = via.apply(old, value << shift & lanes);
            // Bytes that were not addressed keep their value; with CLR, SET and INV they do so anyway.
            old & !lanes | new & lanes
        };
        self.write(register, value, access.cycle);
        self.settle_request();
    }

    /// The value of the register at a physical address for a debugger.
    pub(crate) fn peek_address(&mut self, address: u32, cycle: u64) -> Option<u32> {
        Register::at(address).map(|register| self.peek(register, cycle))
    }

    /// What a partial write is merged with: LAT where PORT is written.
    fn held(&mut self, register: Register, cycle: u64) -> u32 {
        let word = match (register.block, register.word) {
            (Block::Port(_), PORT) => LAT,
            (_, word) => word,
        };
        self.peek(Register { word, ..register }, cycle)
    }

    /// The value of a register, without what reading sets in motion.
    fn peek(&mut self, register: Register, cycle: u64) -> u32 {
        let Register { block, word, .. } = register;
        let found = match block {
            Block::Watchdog => Some(self.watchdog.read()),
            Block::Timer(number) => self.timers.read(number, word, cycle),
            Block::Capture(number) => self.captures[usize::from(number)].peek(word),
            Block::Compare(number) => {
                self.advance_output(number, cycle);
                self.compares[usize::from(number)].read(word)
            }
            Block::Serial(number) => self.serials[usize::from(number)].peek(word),
            Block::Spi(number) => self.spis[usize::from(number)].peek(word),
            Block::I2c(number) => self.i2cs[usize::from(number)].peek(word),
            Block::Analog => self.analog.read(word),
            Block::Comparators => self.comparators.read(word),
            Block::Calendar => self.calendar.read(word, cycle),
            Block::VoltageReference => Some(self.comparators.read_reference()),
            Block::Oscillator => self.clock.read(word),
            Block::Device => self.system.read_device(word),
            Block::Flash => self.nvm.read(word),
            Block::Reset => self.system.read_reset(word),
            Block::Interrupts => {
                if FLAGS_AND_ENABLES.contains(&word) {
                    self.advance_flags(cycle);
                }
                self.interrupts.read(word)
            }
            Block::BusMatrix => self.matrix.read(word),
            Block::Cache => self.matrix.read_cache(word),
            Block::Port(port) => Some(self.peek_port(port, word, cycle)),
            Block::ChangeNotice => self.notice.read(word),
            Block::ParallelPort => self.parallel.peek(word),
            Block::Dma => self.dma.read(word),
        };
        found.unwrap_or(0)
    }

    fn peek_port(&self, port: Port, word: u8, cycle: u64) -> u32 {
        u32::from(match word {
            0 => self.ports.field(port, Field::Tris),
            PORT => self.port_inputs(port, cycle),
            LAT => self.ports.field(port, Field::Lat),
            _ => self.ports.field(port, Field::OpenDrain),
        })
    }

    /// What reading a register sets in motion.
    fn note_read(&mut self, register: Register, cycle: u64) {
        match (register.block, register.word) {
            (Block::Port(port), PORT) => {
                self.notice.note_read(port);
                self.settle_notice();
            }
            (Block::Capture(number), 1) => self.captures[usize::from(number)].take(),
            (Block::Serial(number), 3) => {
                self.serials[usize::from(number)].take();
                self.settle_serial(number);
            }
            (Block::Spi(number), 2) => {
                self.spis[usize::from(number)].take();
                self.settle_spi(number);
            }
            (Block::I2c(number), 6) => self.i2cs[usize::from(number)].take(),
            (Block::ParallelPort, parallel::DATA_IN) => self.read_parallel(cycle),
            (Block::Reset, 1) if self.system.is_reset_armed() => {
                self.order(Order::Reset(ResetSource::Software));
            }
            _ => return,
        }
        self.settle_request();
    }

    fn write(&mut self, register: Register, value: u32, cycle: u64) {
        let Register { block, word, .. } = register;
        match block {
            Block::Port(port) => self.write_port((port, word), value, cycle),
            Block::Interrupts => self.write_interrupts(word, value, cycle),
            Block::Watchdog => {
                self.watchdog.write(value, cycle);
                self.schedule.set(Slot::Watchdog, self.watchdog.barks_at());
            }
            Block::Timer(number) => self.write_timer((number, word), value, cycle),
            Block::Capture(number) if word == 0 => self.captures[usize::from(number)].write_control(value),
            Block::Capture(_) => {}
            Block::Compare(number) => self.write_compare((number, word), value, cycle),
            Block::Serial(number) => self.write_serial((number, word), value, cycle),
            Block::Spi(number) => self.write_spi((number, word), value, cycle),
            Block::I2c(number) => self.write_i2c((number, word), value, cycle),
            Block::Analog => self.write_analog(word, value, cycle),
            Block::Comparators => self.write_comparators(word, value, cycle),
            Block::Calendar => self.write_calendar(word, value, cycle),
            Block::VoltageReference => self.write_reference(value),
            Block::Oscillator => self.write_oscillator(word, value, cycle),
            Block::Device => {
                let written = self.system.write_device(word, value);
                self.system_written(written, cycle);
            }
            Block::Reset => {
                let written = self.system.write_reset(word, value);
                self.system_written(written, cycle);
            }
            Block::Flash => self.write_flash(word, value, cycle),
            Block::BusMatrix => {
                self.matrix.write(word, value);
                self.order(Order::Matrix);
            }
            Block::Cache => {
                self.matrix.write_cache(word, value);
                self.check_clock();
                self.order(Order::Matrix);
            }
            Block::ChangeNotice => self.write_notice(word, value, cycle),
            Block::ParallelPort => self.write_parallel(word, value, cycle),
            Block::Dma => self.write_dma(word, value),
        }
    }

    fn write_port(&mut self, (port, word): (Port, u8), value: u32, cycle: u64) {
        let field = match word {
            0 => Field::Tris,
            PORT | LAT => Field::Lat,
            _ => Field::OpenDrain,
        };
        let changes = self.ports.set_field((port, field), low_half(value), cycle);
        self.port_changed(port, changes, cycle);
    }

    fn write_interrupts(&mut self, word: u8, value: u32, cycle: u64) {
        if FLAGS_AND_ENABLES.contains(&word) {
            self.advance_flags(cycle);
        }
        self.interrupts.write(word, value, cycle);
        if ENABLES.contains(&word) {
            self.schedule_timers();
        }
        if word == 2 && value != 0 {
            self.record
                .misuse(Misuse::NotModelled(Unmodelled::ProximityTimer));
        }
    }

    fn write_timer(&mut self, (number, word): (u8, u8), value: u32, cycle: u64) {
        self.advance_timers(cycle);
        let before = self.running_counters();
        let now = self.now(cycle);
        if self.timers.write((number, word), value, now) == TimerWrite::PrescalerWhileOn {
            self.record.misuse(Misuse::PrescalerWhileOn(number + 1));
        }
        self.begin_pulses(before, cycle);
        self.settle_timers(cycle);
    }

    fn write_analog(&mut self, word: u8, value: u32, cycle: u64) {
        self.analog.write(word, value, self.now(cycle));
        if word == 6 {
            self.settle_analog_pins(cycle);
        }
        if self.analog.has_other_reference() {
            self.record
                .misuse(Misuse::NotModelled(Unmodelled::AnalogReference));
        }
        if self.analog.is_too_fast(self.clock.peripheral) {
            self.record.misuse(Misuse::AnalogTooFast);
        }
        self.schedule.set(Slot::Analog, self.analog.next_event());
        self.schedule_timers();
    }

    fn write_calendar(&mut self, word: u8, value: u32, cycle: u64) {
        let lock = (self.system.is_open(), cycle);
        if self.calendar.write(word, value, lock) == CalendarWrite::Locked {
            self.record.misuse(Misuse::Locked);
        }
        self.schedule.set(Slot::Calendar, self.calendar.next_event());
    }

    fn write_comparators(&mut self, word: u8, value: u32, cycle: u64) {
        self.comparators.write(word, value, cycle);
        self.settle_comparators(cycle);
    }

    fn write_reference(&mut self, value: u32) {
        self.comparators.write_reference(value);
        if self.comparators.has_other_reference() {
            self.record
                .misuse(Misuse::NotModelled(Unmodelled::VoltageReference));
        }
    }

    fn write_oscillator(&mut self, word: u8, value: u32, cycle: u64) {
        if !self.system.is_open() {
            return self.record.misuse(Misuse::Locked);
        }
        self.advance_timers(cycle);
        let change = self.clock.write(word, value);
        self.settle_calendar(cycle);
        self.clock_changed(change, cycle);
    }

    fn system_written(&mut self, written: SystemWrite, cycle: u64) {
        match written {
            SystemWrite::Fine => {}
            SystemWrite::Pins => self.settle_held_pins(cycle),
            SystemWrite::Locked => self.record.misuse(Misuse::Locked),
        }
    }

    fn write_flash(&mut self, word: u8, value: u32, cycle: u64) {
        let operation = match self.nvm.write(word, value, (cycle, self.clock.configuration())) {
            Started::Nothing => return,
            Started::WithoutKeys => return self.record.misuse(Misuse::FlashWithoutKeys),
            Started::TooSoon(operation) => {
                self.record.misuse(Misuse::FlashTooSoon);
                operation
            }
            Started::Operation(operation) => operation,
        };
        self.schedule.set(Slot::Flash, cycle + operation.cycles());
        self.order(Order::Flash(operation));
    }
}

const fn lanes_of(width: Width) -> u32 {
    match width {
        Width::Byte => 0xFF,
        Width::Half => 0xFFFF,
        Width::Word => u32::MAX,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "ports have 16 bits; the upper half of their registers is not there"
)]
const fn low_half(value: u32) -> u16 {
    value as u16
}
