//! Pulse width modulation: output compare on timer 2 or 3 (section 11).
//!
//! ```
//! use pic32mx3_hal::gpio::{Level, Pins};
//! use pic32mx3_hal::pwm::{OutputCompare, PwmTimer};
//! use pic32mx3_hal::timer::{Prescaler, Timer};
//! use embedded_hal::pwm::SetDutyCycle;
//!
//! # fn example(pins: Pins, timer3: Timer<3>, compare1: OutputCompare<1>) {
//! // 80 MHz / 4000: 20 kHz.
//! let time_base = PwmTimer::timer3(timer3, Prescaler::By1, 4_000);
//! let mut motor = time_base.channel(compare1, pins.rd0.into_output(Level::Low));
//! motor.set_duty_cycle_percent(30).ok();
//! # }
//! ```

use crate::gpio::{Output, Pin};
use crate::interrupt::Source;
use crate::register::map::{
    compare_control, compare_primary, compare_secondary, timer_control, timer_period,
};
use crate::timer::{Prescaler, Timer};
use core::convert::Infallible;
use embedded_hal::pwm::{ErrorType, SetDutyCycle};

const ON: u32 = 1 << 15;
const MODE_PWM: u32 = 6;
const USE_TIMER_3: u32 = 1 << 3;

/// Output compare `NUMBER`, 1 to 5.
#[derive(Debug)]
pub struct OutputCompare<const NUMBER: u8>(());

impl<const NUMBER: u8> OutputCompare<NUMBER> {
    pub(crate) const fn new() -> Self {
        Self(())
    }
}

/// The pin that an output compare takes over.
pub trait ComparePin<const COMPARE: u8> {
    /// Makes the latch low: what the pin shows while the output compare is off.
    fn rest_low(&mut self);
}

macro_rules! compare_pins {
    ($($compare:literal $number:literal;)*) => {
        $(impl ComparePin<$compare> for Pin<'D', $number, Output> {
            fn rest_low(&mut self) {
                self.set_low();
            }
        })*
    };
}

compare_pins! {
    1 0;
    2 1;
    3 2;
    4 3;
    5 4;
}

/// Timer 2 or 3 as the time base of pulse widths. It runs as long as this lives.
#[derive(Debug)]
pub struct PwmTimer<const TIMER: u8>(());

impl PwmTimer<2> {
    /// Starts timer 2 with periods of 2 to 65535 counts.
    #[must_use]
    pub fn timer2(mut timer: Timer<2>, prescaler: Prescaler, period_counts: u32) -> Self {
        timer.start(prescaler, period_counts.clamp(2, 0xFFFF));
        Self(())
    }
}

impl PwmTimer<2> {
    /// Starts again with another prescaler and period. Channels keep their width in counts.
    pub fn restart(&mut self, prescaler: Prescaler, period_counts: u32) {
        Timer::<2>::new().start(prescaler, period_counts.clamp(2, 0xFFFF));
    }
}

impl PwmTimer<3> {
    /// Starts timer 3 with periods of 2 to 65535 counts.
    #[must_use]
    pub fn timer3(mut timer: Timer<3>, prescaler: Prescaler, period_counts: u32) -> Self {
        timer.start(prescaler, period_counts.clamp(2, 0xFFFF));
        Self(())
    }
}

impl<const TIMER: u8> PwmTimer<TIMER> {
    /// The timer's source of interrupts, at the beginning of each period.
    pub const SOURCE: Source = match TIMER {
        2 => Source::Timer2,
        3 => Source::Timer3,
        _ => panic!("pulse widths are timed by timer 2 or 3"),
    };

    /// Counts in a period.
    #[must_use]
    pub fn period(&self) -> u32 {
        period(TIMER)
    }

    /// Changes the period for all channels, from the next one on: 2 to 65535 counts. Channels keep their width in counts,
    /// so set it again afterwards.
    pub fn set_period(&mut self, period_counts: u32) {
        Timer::<TIMER>::new().set_period(period_counts.clamp(2, 0xFFFF));
    }

    /// Joins an output compare and its pin to this time base, with a width of 0.
    pub fn channel<const COMPARE: u8, P: ComparePin<COMPARE>>(
        &self,
        compare: OutputCompare<COMPARE>,
        mut pin: P,
    ) -> PwmChannel<COMPARE, TIMER, P> {
        pin.rest_low();
        let mut channel = PwmChannel { compare, pin };
        channel.enable();
        channel
    }
}

/// A pin with pulses: high from the beginning of each period for some counts.
#[derive(Debug)]
pub struct PwmChannel<const COMPARE: u8, const TIMER: u8, P> {
    compare: OutputCompare<COMPARE>,
    pin: P,
}

impl<const COMPARE: u8, const TIMER: u8, P> PwmChannel<COMPARE, TIMER, P> {
    /// Counts that the pin is high in each period, from the next one on. All of a period or more: always.
    #[inline(always)]
    pub fn set_width(&mut self, counts: u16) {
        compare_secondary(COMPARE).write(u32::from(counts));
    }

    /// The width set last.
    #[must_use]
    pub fn width(&self) -> u16 {
        compare_secondary(COMPARE).read() as u16
    }

    /// Takes the pulses off at once: the pin is low from now on, not only from the next period.
    #[inline(always)]
    pub fn disable(&mut self) {
        compare_control(COMPARE).write(0);
    }

    /// Puts pulses on the pin, of width 0 until [`Self::set_width`].
    pub fn enable(&mut self) {
        compare_control(COMPARE).write(0);
        compare_primary(COMPARE).write(0);
        compare_secondary(COMPARE).write(0);
        compare_control(COMPARE).write(pulses_by(TIMER));
    }

    /// Whether the pin has pulses.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        compare_control(COMPARE).has(ON)
    }

    /// Takes the pulses off and gives the parts back; the pin is low.
    #[must_use]
    pub fn release(mut self) -> (OutputCompare<COMPARE>, P) {
        self.disable();
        (self.compare, self.pin)
    }
}

impl<const COMPARE: u8, const TIMER: u8, P> ErrorType for PwmChannel<COMPARE, TIMER, P> {
    type Error = Infallible;
}

impl<const COMPARE: u8, const TIMER: u8, P> SetDutyCycle for PwmChannel<COMPARE, TIMER, P> {
    fn max_duty_cycle(&self) -> u16 {
        period(TIMER) as u16
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.set_width(duty);
        Ok(())
    }
}

/// Takes the pulses off an output, 1 to 5, at once and without owning it: its pin shows its latch, which is low. For
/// exception hooks and for the handler of a failing clock. [`PwmChannel::enable`] undoes it.
#[inline(always)]
pub fn stop(compare: u8) {
    compare_control(compare.clamp(1, 5)).write(0);
}

/// What [`PwmTimer`] was set up to be. Between motors a register may change by itself, and without its timer an output
/// compare leaves its pin as it is at any requested width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeBase<const TIMER: u8> {
    control: u32,
    period: u32,
}

impl<const TIMER: u8> TimeBase<TIMER> {
    /// As the registers of `timer` are now.
    #[must_use]
    pub fn of(_timer: &PwmTimer<TIMER>) -> Self {
        Self {
            control: timer_control(TIMER).read(),
            period: timer_period(TIMER).read(),
        }
    }

    /// Whether the timer still runs as it did then.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self) -> bool {
        timer_control(TIMER).read() == self.control && timer_period(TIMER).read() == self.period
    }

    /// Whether an output, 1 to 5, makes pulses by this timer or is off.
    #[inline(always)]
    #[must_use]
    pub fn governs(&self, compare: u8) -> bool {
        let control = compare_control(compare.clamp(1, 5)).read();
        control == 0 || control == pulses_by(TIMER)
    }
}

const fn pulses_by(timer: u8) -> u32 {
    let by_timer_3 = if timer == 3 { USE_TIMER_3 } else { 0 };
    ON | MODE_PWM | by_timer_3
}

fn period(timer: u8) -> u32 {
    (timer_period(timer).read() & 0xFFFF) + 1
}
