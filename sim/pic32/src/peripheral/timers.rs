//! Timers 1 to 5 (here 0 to 4), their pairs, prescalers, gates and external clocks.

use super::counter::Counter;
use super::rate::{NEVER, Now, Rate};
use crate::pins::Level;

const ON: u32 = 1 << 15;
const GATED: u32 = 1 << 7;
const PAIRED: u32 = 1 << 3;
const EXTERNAL: u32 = 1 << 1;
const PRESCALER: u32 = 0x70;

/// TMRx, the second register of a timer's block.
const COUNT: u8 = 1;
/// PRx, the third.
const PERIOD: u8 = 2;

#[derive(Clone, Debug)]
struct Timer {
    control: u32,
    counter: Counter,
    /// The level of TxCK.
    clock_pin: bool,
    /// Edges of TxCK that the prescaler still holds.
    held_edges: u32,
    /// Up to which cycle matches have set the flag.
    flagged_to: u64,
    /// The first match after that.
    next_match: u64,
}

/// What an edge of TxCK led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ticked {
    /// Nothing for others.
    Nothing,
    /// The interrupt flag: a period ended, or the gate closed.
    Flag,
}

/// What a write asks the chip to report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TimerWrite {
    /// All is well.
    Fine,
    /// The prescaler was changed while the timer was on.
    PrescalerWhileOn,
}

impl Timer {
    fn look_ahead(&mut self) {
        self.next_match = self.counter.next_match(self.flagged_to);
    }
}

/// All five.
#[derive(Clone, Debug)]
pub(crate) struct Timers {
    timers: [Timer; 5],
}

impl Timers {
    pub(crate) fn new() -> Timers {
        let timer = Timer {
            control: 0,
            counter: Counter::STOPPED,
            clock_pin: false,
            held_edges: 0,
            flagged_to: 0,
            next_match: NEVER,
        };
        Timers {
            timers: std::array::from_fn(|_| timer.clone()),
        }
    }

    /// All off; the pins stay as they are.
    pub(crate) fn reset(&mut self) {
        let pins = self.timers.each_ref().map(|timer| timer.clock_pin);
        *self = Timers::new();
        for (timer, clock_pin) in self.timers.iter_mut().zip(pins) {
            timer.clock_pin = clock_pin;
        }
    }

    /// The number of the timer that counts for this one: a pair counts in its lower timer.
    fn lower(&self, number: usize) -> usize {
        if matches!(number, 2 | 4) && self.is_paired(number - 1) {
            number - 1
        } else {
            number
        }
    }

    fn is_paired(&self, number: usize) -> bool {
        self.timers[number].control & PAIRED != 0
    }

    /// What counts for the 16-bit timer `number`, or for the pair that it is the lower half of.
    pub(crate) fn counter(&self, number: u8) -> &Counter {
        &self.timers[usize::from(number)].counter
    }

    /// Which timer's interrupt a match of `number` gives: the upper one's for a pair.
    pub(crate) fn interrupt_of(&self, number: u8) -> u8 {
        number + u8::from(self.is_paired(usize::from(number)))
    }

    /// The first match since the last call up to `cycle`, if there was one.
    pub(crate) fn take_match(&mut self, number: u8, cycle: u64) -> Option<u64> {
        let timer = &mut self.timers[usize::from(number)];
        let first = timer.next_match;
        timer.flagged_to = timer.flagged_to.max(cycle);
        (first <= cycle).then(|| {
            timer.look_ahead();
            first
        })
    }

    /// The first match that [`Timers::take_match`] has not told yet.
    pub(crate) fn next_match(&self, number: u8) -> u64 {
        self.timers[usize::from(number)].next_match
    }

    pub(crate) fn read(&self, number: u8, word: u8, cycle: u64) -> Option<u32> {
        let number = usize::from(number);
        let lower = self.lower(number);
        let counter = &self.timers[lower].counter;
        let half = if lower == number { 0 } else { 16 };
        Some(match word {
            0 => self.timers[number].control,
            COUNT => counter.count_at(cycle) >> half,
            PERIOD => counter.period >> half,
            _ => return None,
        })
    }

    /// Writes a register. Matches must have been taken and outputs brought up to `cycle` before.
    pub(crate) fn write(&mut self, (number, word): (u8, u8), value: u32, now: Now) -> TimerWrite {
        let number = usize::from(number);
        if word == 0 {
            return self.write_control(number, value, now);
        }
        let lower = self.lower(number);
        let paired = self.is_paired(lower);
        let timer = &mut self.timers[lower];
        timer.counter.settle(now.cycle);
        let old = if word == COUNT {
            timer.counter.count_at(now.cycle)
        } else {
            timer.counter.period
        };
        let new = match (paired, lower == number) {
            (true, true) => value,
            (true, false) => old & 0xFFFF | value << 16,
            (false, _) => value & 0xFFFF,
        };
        if word == COUNT {
            let rate = timer.counter.rate();
            timer.counter.restart(new, rate, now.cycle);
            timer.held_edges = 0;
        } else {
            timer.counter.period = new;
        }
        timer.look_ahead();
        TimerWrite::Fine
    }

    fn write_control(&mut self, number: usize, value: u32, now: Now) -> TimerWrite {
        let before = self.timers[number].control;
        let control = value & writable(number);
        self.timers[number].control = control;
        if (before ^ control) & PAIRED != 0 {
            self.change_pairing(number, now.cycle);
            self.settle(number + 1, now);
        }
        self.settle(number, now);
        let prescaler = (before ^ control) & PRESCALER != 0;
        if prescaler && before & control & ON != 0 {
            TimerWrite::PrescalerWhileOn
        } else {
            TimerWrite::Fine
        }
    }

    /// Joins the counters of `number` and the next, or parts them. Both stand still until they are settled.
    fn change_pairing(&mut self, number: usize, cycle: u64) {
        let now = |counter: &Counter| (counter.count_at(cycle), counter.period);
        let (lower, upper) = (
            now(&self.timers[number].counter),
            now(&self.timers[number + 1].counter),
        );
        let low = |value: u32| value & 0xFFFF;
        let (joined, freed) = if self.is_paired(number) {
            let join = |lower, upper| low(lower) | upper << 16;
            let (count, period) = (join(lower.0, upper.0), join(lower.1, upper.1));
            (Counter::STOPPED_PAIR.with(count, period, cycle), Counter::STOPPED)
        } else {
            let half = Counter::STOPPED.with(low(lower.0), low(lower.1), cycle);
            (half, Counter::STOPPED.with(lower.0 >> 16, lower.1 >> 16, cycle))
        };
        self.timers[number].counter = joined;
        self.timers[number + 1].counter = freed;
    }

    /// Lets the counter go on at the rate that registers, pairing and gate say.
    fn settle(&mut self, number: usize, now: Now) {
        let rate = self.rate(number, now.peripheral);
        let timer = &mut self.timers[number];
        timer.flagged_to = timer.flagged_to.max(now.cycle);
        if timer.counter.rate() != rate {
            let count = timer.counter.count_at(now.cycle);
            timer.counter.restart(count, rate, now.cycle);
        }
        timer.look_ahead();
    }

    fn rate(&self, number: usize, peripheral: Rate) -> Rate {
        let timer = &self.timers[number];
        let shut = timer.control & GATED != 0 && !timer.clock_pin;
        if timer.control & ON == 0 || timer.control & EXTERNAL != 0 || shut || self.lower(number) != number {
            return Rate::STOPPED;
        }
        peripheral.divided(u64::from(prescaler(number, timer.control)))
    }

    /// The peripheral clock is another one from now on.
    pub(crate) fn change_clock(&mut self, now: Now) {
        for number in 0..self.timers.len() {
            self.settle(number, now);
        }
    }

    /// TxCK has changed.
    pub(crate) fn clock_pin(&mut self, number: u8, level: Level, now: Now) -> Ticked {
        let number = usize::from(number);
        let rising = level.is_high() && !self.timers[number].clock_pin;
        let falling = !level.is_high() && self.timers[number].clock_pin;
        self.timers[number].clock_pin = level.is_high();
        let control = self.timers[number].control;
        if control & ON == 0 || self.lower(number) != number {
            return Ticked::Nothing;
        }
        match (control & EXTERNAL != 0, control & GATED != 0) {
            (true, _) if rising => self.count_edge(number, now.cycle),
            (false, true) => {
                self.settle(number, now);
                if falling { Ticked::Flag } else { Ticked::Nothing }
            }
            _ => Ticked::Nothing,
        }
    }

    fn count_edge(&mut self, number: usize, cycle: u64) -> Ticked {
        let timer = &mut self.timers[number];
        timer.held_edges += 1;
        if timer.held_edges < prescaler(number, timer.control) {
            return Ticked::Nothing;
        }
        timer.held_edges = 0;
        let count = timer.counter.count_at(cycle);
        let matched = count == timer.counter.period;
        let next = if matched {
            0
        } else {
            count.wrapping_add(1) & timer.counter.last()
        };
        timer.counter.restart(next, Rate::STOPPED, cycle);
        if matched { Ticked::Flag } else { Ticked::Nothing }
    }
}

/// Timer 1 has four prescalers, the others eight.
fn prescaler(number: usize, control: u32) -> u32 {
    if number == 0 {
        [1, 8, 64, 256][(control >> 4 & 3) as usize]
    } else {
        [1, 2, 4, 8, 16, 32, 64, 256][(control >> 4 & 7) as usize]
    }
}

fn writable(number: usize) -> u32 {
    match number {
        0 => 0xF0B6,
        1 | 3 => 0xE0FA,
        _ => 0xE0F2,
    }
}
