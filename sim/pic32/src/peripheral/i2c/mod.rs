//! I2C 1 and 2 (here 0 and 1): registers, the master's steps and the slave's answers, as levels on two open-drain lines.
//!
//! Data changes 300 ns after the clock fell, as the bus asks of those who drive it. A master that loses the bus does not go on as
//! a slave within the same transfer.

mod master;
mod slave;

use super::rate::{CountSpan, NEVER, Now};
use crate::pins::{Pin, Port, known};
use master::MasterStep;
use slave::SlavePhase;

/// SDA and SCL of both.
pub(crate) const PINS: [(Pin, Pin); 2] = [
    (known(Port::G, 3), known(Port::G, 2)),
    (known(Port::A, 3), known(Port::A, 2)),
];

const ON: u32 = 1 << 15;
const RELEASE: u32 = 1 << 12;
const STRICT: u32 = 1 << 11;
const TEN_BITS: u32 = 1 << 10;
const GENERAL_CALL: u32 = 1 << 7;
const STRETCH: u32 = 1 << 6;
const NOT_ACKNOWLEDGE: u32 = 1 << 5;
const ACKNOWLEDGE_STEP: u32 = 1 << 4;
const RECEIVE_STEP: u32 = 1 << 3;
const STOP_STEP: u32 = 1 << 2;
const RESTART_STEP: u32 = 1 << 1;
const START_STEP: u32 = 1 << 0;
/// What keeps what is written: not the steps, which the hardware ends, and not SCLREL.
const CONTROL_KEPT: u32 = 0xAFE0;
const ADDRESS_WRITABLE: u32 = 0x3FF;
const DIVIDER_WRITABLE: u32 = 0xFFF;

const NOT_ACKNOWLEDGED: u32 = 1 << 15;
const TRANSMITS: u32 = 1 << 14;
const BUS_COLLISION: u32 = 1 << 10;
const GENERAL_CALL_SEEN: u32 = 1 << 9;
const TEN_BITS_MATCHED: u32 = 1 << 8;
const WRITE_COLLISION: u32 = 1 << 7;
const OVERRUN: u32 = 1 << 6;
const DATA: u32 = 1 << 5;
const STOPPED: u32 = 1 << 4;
const STARTED: u32 = 1 << 3;
const READS: u32 = 1 << 2;
const RECEIVE_FULL: u32 = 1 << 1;
const TRANSMIT_FULL: u32 = 1 << 0;

/// Data is held so long after the clock fell: 300 ns.
const HOLD_CYCLES: u64 = 24;
/// The pulse gobbler's delay of about 104 ns, which is part of half a period: general knowledge of the family.
const GOBBLER_CYCLES: u64 = 8;

/// Interrupts that it asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct I2cEvents {
    pub(crate) collision: bool,
    pub(crate) slave: bool,
    pub(crate) master: bool,
}

/// What a write to a register was wrong about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum I2cWrite {
    /// Nothing.
    Fine,
    /// A step that was asked for while another ran.
    StepIgnored,
    /// A divider that the part does not allow.
    Divider,
}

/// A time that is waited for.
#[derive(Clone, Copy, Debug)]
struct I2cTimer {
    span: CountSpan,
    clocks: u64,
    cycles: u64,
}

impl I2cTimer {
    fn due(&self) -> u64 {
        self.span.cycle_of(self.clocks).saturating_add(self.cycles)
    }
}

/// One I2C.
#[derive(Clone, Debug)]
pub(crate) struct I2c {
    control: u32,
    /// The flags of I2CxSTAT that are not worked out.
    flags: u32,
    address: u32,
    mask: u32,
    divider: u32,
    transmit: Option<u8>,
    received: Option<u8>,
    last_received: u8,
    clock_high: bool,
    data_high: bool,
    /// Whether the master pulls its lines.
    pulls_clock: bool,
    pulls_data: bool,
    /// Whether the bus is ours: from our start to our stop.
    owns_bus: bool,
    step: Option<MasterStep>,
    timer: Option<I2cTimer>,
    phase: SlavePhase,
    /// Whether the slave pulls its lines, and what it will do to data after the hold time.
    holds_clock: bool,
    slave_pulls_data: bool,
    slave_change: Option<(u64, bool)>,
    events: I2cEvents,
}

impl I2c {
    pub(crate) fn new() -> I2c {
        I2c {
            control: RELEASE,
            flags: 0,
            address: 0,
            mask: 0,
            divider: 0,
            transmit: None,
            received: None,
            last_received: 0,
            clock_high: false,
            data_high: false,
            pulls_clock: false,
            pulls_data: false,
            owns_bus: false,
            step: None,
            timer: None,
            phase: SlavePhase::Idle,
            holds_clock: false,
            slave_pulls_data: false,
            slave_change: None,
            events: I2cEvents::default(),
        }
    }

    /// As after a reset; the lines keep their levels.
    pub(crate) fn reset(&mut self) {
        *self = I2c {
            clock_high: self.clock_high,
            data_high: self.data_high,
            ..I2c::new()
        };
    }

    fn has(&self, bits: u32) -> bool {
        self.control & bits != 0
    }

    fn is_on(&self) -> bool {
        self.has(ON)
    }

    /// Whether it lets go of SDA and of SCL; nothing while it is off.
    pub(crate) fn releases(&self) -> Option<(bool, bool)> {
        self.is_on().then_some((
            !self.pulls_data && !self.slave_pulls_data,
            !self.pulls_clock && !self.holds_clock,
        ))
    }

    pub(crate) fn take_events(&mut self) -> I2cEvents {
        std::mem::take(&mut self.events)
    }

    pub(crate) fn next_event(&self) -> u64 {
        let master = self.timer.map_or(NEVER, |timer| timer.due());
        let slave = self.slave_change.map_or(NEVER, |change| change.0);
        master.min(slave)
    }

    /// What was waited for has come.
    pub(crate) fn tick(&mut self, now: Now) {
        if let Some((_, pulls)) = self.slave_change.take_if(|change| change.0 <= now.cycle) {
            self.slave_pulls_data = pulls;
        }
        if self.timer.take_if(|timer| timer.due() <= now.cycle).is_some() {
            self.advance_step(now);
        }
    }

    /// The peripheral clock is another one from now on.
    pub(crate) fn change_clock(&mut self, now: Now) {
        if let Some(timer) = &mut self.timer {
            timer.span.change_rate(now.cycle, now.peripheral);
        }
    }

    /// Waits until half a period is over that began so many cycles ago.
    fn wait_half(&mut self, now: Now, already: u64) {
        self.timer = Some(I2cTimer {
            span: CountSpan::new(now.cycle.saturating_sub(already), now.peripheral),
            clocks: u64::from(self.divider) + 2,
            cycles: GOBBLER_CYCLES,
        });
    }

    fn wait_hold(&mut self, now: Now) {
        self.timer = Some(I2cTimer {
            span: CountSpan::new(now.cycle, now.peripheral),
            clocks: 0,
            cycles: HOLD_CYCLES,
        });
    }

    fn raise_flag(&mut self, flag: u32, set: bool) {
        if set {
            self.flags |= flag;
        } else {
            self.flags &= !flag;
        }
    }

    /// SDA has this level now.
    pub(crate) fn hear_data(&mut self, high: bool) {
        if high == self.data_high {
            return;
        }
        self.data_high = high;
        if !self.is_on() || !self.clock_high {
            return;
        }
        self.raise_flag(STARTED, !high);
        self.raise_flag(STOPPED, high);
        if high {
            self.flags &= !(GENERAL_CALL_SEEN | TEN_BITS_MATCHED);
        }
        self.hear_condition(!high);
    }

    /// SCL has this level now.
    pub(crate) fn hear_clock(&mut self, high: bool, now: Now) {
        if high == self.clock_high {
            return;
        }
        self.clock_high = high;
        if !self.is_on() {
            return;
        }
        if high {
            self.master_hears_clock_rise(now);
            self.slave_hears_clock_rise();
        } else {
            self.slave_hears_clock_fall(now);
        }
    }

    /// A byte came in for the program; `false` when there was no room for it.
    fn deliver(&mut self, byte: u8) -> bool {
        if self.received.is_some() {
            self.flags |= OVERRUN;
            return false;
        }
        self.received = Some(byte);
        self.last_received = byte;
        true
    }

    /// Reads a register without taking the byte.
    pub(crate) fn peek(&self, word: u8) -> Option<u32> {
        match word {
            0 => Some(self.control | self.step.map_or(0, MasterStep::bit)),
            1 => Some(self.status()),
            2 => Some(self.address),
            3 => Some(self.mask),
            4 => Some(self.divider),
            5 => Some(self.transmit.map_or(0, u32::from)),
            6 => Some(u32::from(self.last_received)),
            _ => None,
        }
    }

    fn status(&self) -> u32 {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        self.flags
            | flag(self.transmit.is_some(), TRANSMIT_FULL)
            | flag(self.received.is_some(), RECEIVE_FULL)
            | flag(self.step.is_some_and(MasterStep::is_sending), TRANSMITS)
    }

    /// The program has read I2CxRCV.
    pub(crate) fn take(&mut self) {
        self.received = None;
    }

    /// Writes a register.
    pub(crate) fn write(&mut self, word: u8, value: u32, now: Now) -> I2cWrite {
        match word {
            0 => return self.write_control(value, now),
            1 => {
                let cleared = (BUS_COLLISION | WRITE_COLLISION | OVERRUN) & !value;
                self.flags &= !cleared;
            }
            2 => self.address = value & ADDRESS_WRITABLE,
            3 => self.mask = value & ADDRESS_WRITABLE,
            4 => self.divider = value & DIVIDER_WRITABLE,
            5 if self.is_on() => self.write_transmit(value.to_le_bytes()[0], now),
            _ => {}
        }
        I2cWrite::Fine
    }

    fn write_control(&mut self, value: u32, now: Now) -> I2cWrite {
        let was_on = self.is_on();
        if value & ON == 0 {
            let (address, mask, divider) = (self.address, self.mask, self.divider);
            self.reset();
            (self.address, self.mask, self.divider) = (address, mask, divider);
            self.control = value & (CONTROL_KEPT | RELEASE);
            return I2cWrite::Fine;
        }
        self.control = value & CONTROL_KEPT | value & RELEASE;
        if self.has(RELEASE) {
            self.release_clock();
        }
        if !was_on && self.divider < 2 {
            return I2cWrite::Divider;
        }
        let running = self.step.map_or(0, MasterStep::bit);
        match MasterStep::of(value & !running) {
            None => I2cWrite::Fine,
            Some(_) if self.step.is_some() => I2cWrite::StepIgnored,
            Some(step) => {
                self.begin_step(step, now);
                I2cWrite::Fine
            }
        }
    }

    fn write_transmit(&mut self, byte: u8, now: Now) {
        let is_free = self.transmit.is_none() && self.step.is_none();
        if is_free && self.owns_bus {
            self.transmit = Some(byte);
            self.begin_step(
                MasterStep::Send {
                    byte,
                    bit: 0,
                    phase: 0,
                },
                now,
            );
        } else if is_free && self.phase.is_reading() {
            self.transmit = Some(byte);
        } else {
            self.flags |= WRITE_COLLISION;
        }
    }
}
