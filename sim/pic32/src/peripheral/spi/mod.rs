//! SPI 1 and 2 (here 0 and 1): both buffers, the shift register, and clock, data and select as levels on pins.
//!
//! The chip's own tables do not tell what a slave sends that was not loaded in time; here it sends what its shift register
//! was left with, the word that came in last. Nor do they tell when exactly a frame pulse comes: here it is one clock long,
//! begins with the edge that puts data out, and a word's pulse never overlaps the word before it.

mod framed;
mod word;

use super::buses::BusEvents;
use super::rate::{CountSpan, NEVER, Now, Rate};
use crate::pins::{Level, Pin, Port, known};
use framed::Frame;
use word::SpiWord;

/// The pins of an SPI.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpiPins {
    pub(crate) clock: Pin,
    pub(crate) input: Pin,
    pub(crate) output: Pin,
    pub(crate) select: Pin,
}

/// SCK, SDI, SDO and SS of both.
pub(crate) const PINS: [SpiPins; 2] = [
    SpiPins {
        clock: known(Port::F, 6),
        input: known(Port::F, 7),
        output: known(Port::F, 8),
        select: known(Port::B, 2),
    },
    SpiPins {
        clock: known(Port::G, 6),
        input: known(Port::G, 7),
        output: known(Port::G, 8),
        select: known(Port::G, 9),
    },
];

const FRAMED: u32 = 1 << 31;
const FRAME_INPUT: u32 = 1 << 30;
const FRAME_HIGH: u32 = 1 << 29;
const FRAME_COINCIDES: u32 = 1 << 17;
const ON: u32 = 1 << 15;
const NO_OUTPUT: u32 = 1 << 12;
const LATE_SAMPLE: u32 = 1 << 9;
/// CKE: data changes when the clock goes back to idle.
const CHANGE_ON_TRAILING: u32 = 1 << 8;
const SELECTED_BY_PIN: u32 = 1 << 7;
const IDLE_HIGH: u32 = 1 << 6;
const MASTER: u32 = 1 << 5;
const CONTROL_WRITABLE: u32 = 0xE002_BFE0;
const DIVIDER_WRITABLE: u32 = 0x1FF;

const BUSY: u32 = 1 << 11;
const OVERRUN: u32 = 1 << 6;
const TRANSMIT_EMPTY: u32 = 1 << 3;
const RECEIVE_FULL: u32 = 1 << 0;

/// The shortest period of SCK is 40 ns: general knowledge of the family.
const FASTEST_HZ: u64 = 25_000_000;

/// The clock that a master makes.
#[derive(Clone, Copy, Debug)]
struct SpiClock {
    /// Counts clocks of the peripheral bus.
    span: CountSpan,
    half_clocks: u64,
    /// Half periods that are over; the first edge of the clock ends the first.
    halves: u64,
}

/// One SPI.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spi {
    control: u32,
    divider: u32,
    waiting: Option<u32>,
    received: Option<u32>,
    overrun: bool,
    word: Option<SpiWord>,
    /// What the shift register was left with.
    left: u32,
    /// The bit on SDO.
    output: bool,
    /// Whether SCK is away from its idle level.
    active: bool,
    /// The level of SS; high is not selected.
    select_high: bool,
    clock: Option<SpiClock>,
    frame: Frame,
    pub(super) events: BusEvents,
}

/// What an SPI does to its pins; it leaves alone what is not named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SpiOutputs {
    pub(crate) clock: Option<Level>,
    pub(crate) output: Option<Level>,
    pub(crate) select: Option<Level>,
}

/// Which of its interrupt lines are asserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SpiLines {
    pub(crate) fault: bool,
    pub(crate) transmit: bool,
    pub(crate) receive: bool,
}

/// What a write to a register was wrong about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpiWrite {
    /// Nothing.
    Fine,
    /// A word waited already; the new one replaced it.
    Replaced,
    /// Settings that the part does not combine.
    Combination,
    /// The clock is faster than the part.
    TooFast,
}

impl Spi {
    /// As after a reset; the select pin keeps its level.
    pub(crate) fn reset(&mut self) {
        *self = Spi {
            select_high: self.select_high,
            ..Spi::default()
        };
    }

    fn has(&self, bits: u32) -> bool {
        self.control & bits != 0
    }

    pub(super) fn is_on(&self) -> bool {
        self.has(ON)
    }

    fn bits(&self) -> u8 {
        match self.control >> 10 & 3 {
            0 => 8,
            1 => 16,
            _ => 32,
        }
    }

    fn half_clocks(&self) -> u64 {
        u64::from(self.divider) + 1
    }

    /// Whether the slave takes part in what happens on the clock.
    fn is_selected(&self) -> bool {
        !self.has(SELECTED_BY_PIN) || !self.select_high
    }

    /// Whether the frame pulse is on its pin.
    fn is_pulsed(&self) -> bool {
        self.select_high == self.has(FRAME_HIGH)
    }

    pub(crate) fn outputs(&self) -> SpiOutputs {
        if !self.is_on() {
            return SpiOutputs::default();
        }
        let drives_output = self.has(MASTER | FRAMED) || self.is_selected();
        let makes_pulse = self.has(FRAMED) && !self.has(FRAME_INPUT);
        SpiOutputs {
            clock: self
                .has(MASTER)
                .then(|| Level::of(self.active != self.has(IDLE_HIGH))),
            output: (drives_output && !self.has(NO_OUTPUT)).then(|| Level::of(self.output)),
            select: makes_pulse.then(|| Level::of(self.frame.is_pulsing() == self.has(FRAME_HIGH))),
        }
    }

    pub(crate) fn lines(&self) -> SpiLines {
        SpiLines {
            fault: self.overrun,
            transmit: self.is_on() && self.waiting.is_none(),
            receive: self.received.is_some(),
        }
    }

    pub(crate) fn next_event(&self) -> u64 {
        self.clock.map_or(NEVER, |clock| {
            clock.span.cycle_of((clock.halves + 1) * clock.half_clocks)
        })
    }

    /// The peripheral clock is another one from now on.
    pub(crate) fn change_clock(&mut self, now: Now) {
        if let Some(clock) = &mut self.clock {
            clock.span.change_rate(now.cycle, now.peripheral);
        }
    }

    /// A half period of the master's clock ends; SDI has this level just before.
    pub(crate) fn tick(&mut self, now: Now, input: bool) {
        let Some(clock) = &mut self.clock else { return };
        clock.halves += 1;
        let halves = clock.halves;
        if self.has(FRAMED) {
            self.active = !self.active;
            return match self.active {
                true => self.framed_shift(),
                false => self.framed_sample(input),
            };
        }
        let last = 2 * u64::from(self.bits());
        let leading = halves % 2 == 1;
        let changes_on_trailing = self.has(CHANGE_ON_TRAILING);
        let late = self.has(LATE_SAMPLE);
        // In the middle of a bit, or at its end, which is where the next one begins.
        let middle = leading == changes_on_trailing;
        let samples = if late { !middle && halves > 1 } else { middle };
        if samples && let Some(taken) = self.word.as_mut().and_then(|word| word.sample(input)) {
            self.deliver(taken);
        }
        if halves <= last {
            self.active = leading;
            let changes = leading != changes_on_trailing;
            let next = self.word.as_mut().filter(|_| changes).and_then(SpiWord::shift);
            self.output = next.unwrap_or(self.output);
        }
        let ends = last + u64::from(late && !changes_on_trailing);
        if halves == ends {
            self.clock = None;
            self.word = None;
            self.begin_word(now);
        }
    }

    /// SCK changed, and it is not this side that clocks.
    pub(crate) fn hear_clock(&mut self, level: Level, input: bool) {
        if !self.is_on() || self.has(MASTER) {
            return;
        }
        let leading = level.is_high() != self.has(IDLE_HIGH);
        if leading == self.active {
            return;
        }
        self.active = leading;
        if self.has(FRAMED) {
            return match leading {
                true => self.framed_shift(),
                false => self.framed_sample(input),
            };
        }
        if !self.is_selected() {
            return;
        }
        if leading == self.has(CHANGE_ON_TRAILING) {
            let mut word = self.word.take().unwrap_or_else(|| self.first_bit_of_next_word());
            match word.sample(input) {
                Some(taken) => self.deliver(taken),
                None => self.word = Some(word),
            }
        } else if self.word.is_some() || self.waiting.is_some() || !self.has(CHANGE_ON_TRAILING) {
            let mut word = self.word.take().unwrap_or_else(|| self.next_word());
            self.output = word.shift().unwrap_or(self.output);
            self.word = Some(word);
        } else {
            self.output = self.left >> (self.bits() - 1) & 1 != 0;
        }
    }

    /// SS changed.
    pub(crate) fn hear_select(&mut self, high: bool) {
        self.select_high = high;
        if !self.is_on() || self.has(MASTER) && !self.has(FRAMED) {
            return;
        }
        if self.has(FRAMED) {
            self.frame_pulse_changed();
        } else if self.has(SELECTED_BY_PIN) && high {
            // A word that was cut short is dropped.
            if self.word.is_some_and(|word| word.has_begun()) {
                self.word = None;
            }
            self.active = false;
            self.load_slave();
        }
    }

    /// The word to send next: the one that waits, or what is left from before.
    fn next_word(&mut self) -> SpiWord {
        self.events.left |= self.waiting.is_some();
        let out = self.waiting.take().unwrap_or(self.left);
        SpiWord::new(out, self.bits())
    }

    /// The next word with its first bit on the line already.
    fn first_bit_of_next_word(&mut self) -> SpiWord {
        let mut word = self.next_word();
        if self.has(CHANGE_ON_TRAILING) {
            self.output = word.shift().unwrap_or(self.output);
        }
        word
    }

    /// A slave's word goes into its shift register as soon as that is empty.
    fn load_slave(&mut self) {
        let is_slave = self.is_on() && !self.has(MASTER | FRAMED);
        if is_slave && self.word.is_none() && !self.active && self.waiting.is_some() {
            self.word = Some(self.first_bit_of_next_word());
        }
    }

    /// A master sends what waits.
    fn begin_word(&mut self, now: Now) {
        let sends = self.is_on() && self.has(MASTER) && !self.has(FRAMED) && self.clock.is_none();
        if sends && self.waiting.is_some() {
            self.word = Some(self.first_bit_of_next_word());
            self.clock = Some(self.clock_from(now));
        }
    }

    fn clock_from(&self, now: Now) -> SpiClock {
        SpiClock {
            span: CountSpan::new(now.cycle, now.peripheral),
            half_clocks: self.half_clocks(),
            halves: 0,
        }
    }

    /// A word is complete.
    fn deliver(&mut self, taken: u32) {
        self.left = taken;
        self.events.came = true;
        if self.received.is_some() {
            self.overrun = true;
        } else if !self.overrun {
            self.received = Some(taken);
        }
    }

    /// Reads a register without taking the word.
    pub(crate) fn peek(&self, word: u8) -> Option<u32> {
        match word {
            0 => Some(self.control),
            1 => Some(self.status()),
            2 => Some(self.received.unwrap_or(0)),
            3 => Some(self.divider),
            _ => None,
        }
    }

    fn status(&self) -> u32 {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        let shifts = if self.has(MASTER) && !self.has(FRAMED) {
            self.clock.is_some()
        } else {
            self.word.is_some_and(|word| word.has_begun()) || self.frame.is_under_way()
        };
        flag(self.received.is_some(), RECEIVE_FULL)
            | flag(self.waiting.is_none(), TRANSMIT_EMPTY)
            | flag(self.overrun, OVERRUN)
            | flag(shifts, BUSY)
    }

    /// The program has read SPIxBUF.
    pub(crate) fn take(&mut self) {
        self.received = None;
    }

    /// Writes a register.
    pub(crate) fn write(&mut self, register: u8, value: u32, now: Now) -> SpiWrite {
        let mut written = SpiWrite::Fine;
        match register {
            0 => written = self.write_control(value & CONTROL_WRITABLE, now),
            1 if value & OVERRUN == 0 => self.overrun = false,
            2 if self.is_on() => {
                let word = value & (u32::MAX >> (32 - self.bits()));
                let before = self.waiting.replace(word);
                written = before.map_or(SpiWrite::Fine, |_| SpiWrite::Replaced);
            }
            3 => self.divider = value & DIVIDER_WRITABLE,
            _ => {}
        }
        self.begin_word(now);
        self.load_slave();
        written
    }

    fn write_control(&mut self, value: u32, now: Now) -> SpiWrite {
        let was_on = self.is_on();
        self.control = value;
        if !self.is_on() {
            *self = Spi {
                control: value,
                divider: self.divider,
                select_high: self.select_high,
                ..Spi::default()
            };
            return SpiWrite::Fine;
        }
        if !was_on && self.has(FRAMED) && self.has(MASTER) {
            self.clock = Some(self.clock_from(now));
        }
        let is_slave = !self.has(MASTER);
        let wrong = self.has(FRAMED) && self.has(CHANGE_ON_TRAILING)
            || is_slave && self.has(LATE_SAMPLE)
            || is_slave && !self.has(FRAMED | SELECTED_BY_PIN) && self.has(CHANGE_ON_TRAILING);
        match wrong {
            true => SpiWrite::Combination,
            false if self.is_too_fast(now.peripheral) => SpiWrite::TooFast,
            false => SpiWrite::Fine,
        }
    }

    fn is_too_fast(&self, peripheral: Rate) -> bool {
        self.has(MASTER) && peripheral.hz() / (2 * self.half_clocks()) > FASTEST_HZ
    }
}
