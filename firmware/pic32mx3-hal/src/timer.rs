//! Timers 1 to 5 (section 10): 16 bits, periodic; 2 with 3 and 4 with 5 also as one of 32 bits.
//!
//! A period of `n` counts is written as `n - 1` to the register; the functions here take `n`.

use crate::interrupt::Source;
use crate::register::map::{timer_control, timer_count, timer_period};

const ON: u32 = 1 << 15;
const T32: u32 = 1 << 3;
const PRESCALER_SHIFT: u32 = 4;

/// How many peripheral clocks make a count of timer 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the variant's name is its factor")]
pub enum SlowPrescaler {
    By1 = 0,
    By8 = 1,
    By64 = 2,
    By256 = 3,
}

/// How many peripheral clocks make a count of timers 2 to 5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the variant's name is its factor")]
pub enum Prescaler {
    By1 = 0,
    By2 = 1,
    By4 = 2,
    By8 = 3,
    By16 = 4,
    By32 = 5,
    By64 = 6,
    By256 = 7,
}

/// Timer `NUMBER`, 1 to 5.
#[derive(Debug)]
pub struct Timer<const NUMBER: u8>(());

impl<const NUMBER: u8> Timer<NUMBER> {
    /// Its source of interrupts, at the end of each period.
    pub const SOURCE: Source = match NUMBER {
        1 => Source::Timer1,
        2 => Source::Timer2,
        3 => Source::Timer3,
        4 => Source::Timer4,
        5 => Source::Timer5,
        _ => panic!("timers are 1 to 5"),
    };

    pub(crate) const fn new() -> Self {
        Self(())
    }

    fn begin(&mut self, prescaler_code: u32, period_counts: u32) {
        // The prescaler must not be written while it is on.
        timer_control(NUMBER).write(0);
        timer_count(NUMBER).write(0);
        timer_period(NUMBER).write(period_counts.clamp(1, 0x1_0000) - 1);
        Self::SOURCE.clear();
        timer_control(NUMBER).write(ON | (prescaler_code << PRESCALER_SHIFT));
    }

    /// Stops it. Its source may still be pending.
    #[inline(always)]
    pub fn stop(&mut self) {
        timer_control(NUMBER).clear(ON);
    }

    /// Whether it runs.
    #[must_use]
    pub fn is_running(&self) -> bool {
        timer_control(NUMBER).has(ON)
    }

    /// Changes the period that runs now and those after it: 1 to 65536 counts. When the counter is already past the new
    /// end, the period ends with the next count; without this it would go on to the end of its 16 bits.
    #[inline(always)]
    pub fn set_period(&mut self, period_counts: u32) {
        let last = period_counts.clamp(1, 0x1_0000) - 1;
        timer_period(NUMBER).write(last);
        if timer_count(NUMBER).read() > last {
            timer_count(NUMBER).write(last);
        }
    }

    /// The counter.
    #[inline(always)]
    #[must_use]
    pub fn count(&self) -> u16 {
        timer_count(NUMBER).read() as u16
    }

    /// Counts in a period.
    #[must_use]
    pub fn period(&self) -> u32 {
        (timer_period(NUMBER).read() & 0xFFFF) + 1
    }
}

impl Timer<1> {
    /// Restarts it with periods of 1 to 65536 counts.
    pub fn start(&mut self, prescaler: SlowPrescaler, period_counts: u32) {
        self.begin(prescaler as u32, period_counts);
    }
}

/// Timers with the finer prescaler that make pairs and drive output compare and capture.
macro_rules! start {
    ($($number:literal)*) => {
        $(impl Timer<$number> {
            /// Restarts it with periods of 1 to 65536 counts.
            pub fn start(&mut self, prescaler: Prescaler, period_counts: u32) {
                self.begin(prescaler as u32, period_counts);
            }
        })*
    };
}

start! { 2 3 4 5 }

/// Two timers as one of 32 bits: `LOW` is 2 or 4, and the timer above it gives the interrupt.
#[derive(Debug)]
pub struct LongTimer<const LOW: u8>(());

impl LongTimer<2> {
    /// Timers 2 and 3.
    #[must_use]
    pub fn new(_low: Timer<2>, _high: Timer<3>) -> Self {
        Self(())
    }

    /// Gives the two back, stopped.
    #[must_use]
    pub fn split(self) -> (Timer<2>, Timer<3>) {
        timer_control(2).write(0);
        (Timer::new(), Timer::new())
    }
}

impl LongTimer<4> {
    /// Timers 4 and 5.
    #[must_use]
    pub fn new(_low: Timer<4>, _high: Timer<5>) -> Self {
        Self(())
    }

    /// Gives the two back, stopped.
    #[must_use]
    pub fn split(self) -> (Timer<4>, Timer<5>) {
        timer_control(4).write(0);
        (Timer::new(), Timer::new())
    }
}

impl<const LOW: u8> LongTimer<LOW> {
    /// Its source of interrupts, at the end of each period.
    pub const SOURCE: Source = match LOW {
        2 => Source::Timer3,
        4 => Source::Timer5,
        _ => panic!("pairs begin with timer 2 or 4"),
    };

    /// Restarts it. `last_count` is one less than the counts in a period.
    pub fn start(&mut self, prescaler: Prescaler, last_count: u32) {
        timer_control(LOW).write(0);
        timer_control(LOW + 1).write(0);
        timer_control(LOW).write(T32);
        timer_count(LOW).write(0);
        timer_period(LOW).write(last_count);
        Self::SOURCE.clear();
        timer_control(LOW).write(ON | T32 | ((prescaler as u32) << PRESCALER_SHIFT));
    }

    /// Stops it.
    pub fn stop(&mut self) {
        timer_control(LOW).clear(ON);
    }

    /// The counter.
    #[must_use]
    pub fn count(&self) -> u32 {
        timer_count(LOW).read()
    }
}
