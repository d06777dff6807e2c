//! The real-time clock and calendar with its alarm (section 4 of the peripherals): seconds from 2000 to 2099, also in Sleep.
//!
//! It runs from a crystal of 32.768 kHz on RC13 and RC14 ([`crate::oscillator::Oscillators::run_secondary`]) and from nothing else. A
//! reset leaves it alone; after power-on its digits are anything until they are set.
//!
//! `unverified`: how much a step of the calibration is (here one clock a minute), and that resets leave the calendar alone.

use crate::dma;
use crate::interrupt::Source;
use crate::register::map::{ALRMDATE, ALRMTIME, RTCALRM, RTCCON, RTCDATE, RTCTIME};
use crate::reset::with_system_unlocked;

const ON: u32 = 1 << 15;
const RUNS: u32 = 1 << 6;
const WRITE_ENABLE: u32 = 1 << 3;
const NEAR_ROLLOVER: u32 = 1 << 2;
const CALIBRATION_SHIFT: u32 = 16;
const CALIBRATION: u32 = 0x3FF << CALIBRATION_SHIFT;

const ALARM_ON: u32 = 1 << 15;
const CHIME: u32 = 1 << 14;
const ALARM_SYNC: u32 = 1 << 12;
const MASK_SHIFT: u32 = 8;

/// A moment, in digits that fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DateTime {
    /// 2000 to 2099.
    pub year: u16,
    /// 1 to 12.
    pub month: u8,
    /// 1 to 31.
    pub day: u8,
    /// 0 to 6; the chip counts it and does not know what it means.
    pub weekday: u8,
    /// 0 to 23.
    pub hour: u8,
    /// 0 to 59.
    pub minute: u8,
    /// 0 to 59.
    pub second: u8,
}

/// A part of a moment that is none: which one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DateTimeError {
    /// Not 2000 to 2099.
    Year(u16),
    /// Not 1 to 12.
    Month(u8),
    /// Not a day of that month.
    Day(u8),
    /// Not 0 to 6.
    Weekday(u8),
    /// Not 0 to 23.
    Hour(u8),
    /// Not 0 to 59.
    Minute(u8),
    /// Not 0 to 59.
    Second(u8),
}

/// Why the calendar was not set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetError {
    /// The moment is none.
    Moment(DateTimeError),
    /// The crystal does not swing.
    NoClock,
}

/// How often the alarm comes: each time that the named parts are those of its moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum AlarmEvery {
    /// Each half second.
    HalfSecond = 0,
    /// Each second.
    Second = 1,
    /// The last digit of the second.
    TenSeconds = 2,
    /// The second.
    Minute = 3,
    /// The second and the last digit of the minute.
    TenMinutes = 4,
    /// The second and the minute.
    Hour = 5,
    /// The time of day.
    Day = 6,
    /// The time and the weekday.
    Week = 7,
    /// The time and the day of the month.
    Month = 8,
    /// The time, the day and the month.
    Year = 9,
}

/// How many times the alarm comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlarmCount {
    /// Once, and so many times more.
    Repeated(u8),
    /// For ever.
    Endless,
}

const fn digits(value: u32) -> u32 {
    ((value / 10) << 4) | (value % 10)
}

const fn value(digits: u32) -> u8 {
    ((digits >> 4 & 15) * 10 + (digits & 15)) as u8
}

impl DateTime {
    const fn check(self) -> Result<(), DateTimeError> {
        let days = match self.month {
            2 if self.year.is_multiple_of(4) => 29,
            2 => 28,
            4 | 6 | 9 | 11 => 30,
            _ => 31,
        };
        match self {
            Self { year, .. } if year < 2_000 || year > 2_099 => Err(DateTimeError::Year(year)),
            Self { month, .. } if month < 1 || month > 12 => Err(DateTimeError::Month(month)),
            Self { day, .. } if day < 1 || day > days => Err(DateTimeError::Day(day)),
            Self { weekday, .. } if weekday > 6 => Err(DateTimeError::Weekday(weekday)),
            Self { hour, .. } if hour > 23 => Err(DateTimeError::Hour(hour)),
            Self { minute, .. } if minute > 59 => Err(DateTimeError::Minute(minute)),
            Self { second, .. } if second > 59 => Err(DateTimeError::Second(second)),
            _ => Ok(()),
        }
    }

    const fn time_digits(self) -> u32 {
        (digits(self.hour as u32) << 24)
            | (digits(self.minute as u32) << 16)
            | (digits(self.second as u32) << 8)
    }

    const fn date_digits(self) -> u32 {
        (digits(self.year as u32 % 100) << 24) | self.alarm_date_digits()
    }

    const fn alarm_date_digits(self) -> u32 {
        (digits(self.month as u32) << 16) | (digits(self.day as u32) << 8) | self.weekday as u32
    }

    const fn of_digits(time: u32, date: u32) -> Self {
        Self {
            year: 2_000 + value(date >> 24) as u16,
            month: value(date >> 16),
            day: value(date >> 8),
            weekday: (date & 7) as u8,
            hour: value(time >> 24),
            minute: value(time >> 16),
            second: value(time >> 8),
        }
    }
}

/// The calendar.
#[derive(Debug)]
pub struct Calendar(());

impl Calendar {
    /// Its source of interrupts: the alarm.
    pub const SOURCE: Source = Source::Calendar;

    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Sets it and starts it. Gives up when the chip's clock does not stop and start within 100,000 readings of its state.
    ///
    /// # Errors
    /// [`SetError`]; it does not run then.
    pub fn set(&mut self, moment: DateTime) -> Result<(), SetError> {
        moment.check().map_err(SetError::Moment)?;
        allow_writing();
        RTCCON.clear(ON);
        let set = becomes(false).and_then(|()| {
            RTCTIME.write(moment.time_digits());
            RTCDATE.write(moment.date_digits());
            RTCCON.set(ON);
            becomes(true)
        });
        if set.is_err() {
            RTCCON.clear(ON);
        }
        RTCCON.clear(WRITE_ENABLE);
        set
    }

    /// Whether it runs.
    #[must_use]
    pub fn is_running(&self) -> bool {
        RTCCON.has(ON | RUNS)
    }

    /// The present moment. It waits out the millisecond before a new second, so that time and date belong together.
    #[must_use]
    pub fn now(&self) -> DateTime {
        loop {
            let (time, date) = (RTCTIME.read(), RTCDATE.read());
            let is_steady = !RTCCON.has(NEAR_ROLLOVER) && time == RTCTIME.read() && date == RTCDATE.read();
            if is_steady {
                return DateTime::of_digits(time, date);
            }
        }
    }

    /// Makes it faster (above 0) or slower: clocks of the crystal that each minute has more, -512 to 511. Others are brought into that
    /// range.
    pub fn calibrate(&mut self, clocks_a_minute: i16) {
        let field = clocks_a_minute.clamp(-512, 511) as u32 & 0x3FF;
        allow_writing();
        RTCCON.clear(CALIBRATION);
        RTCCON.set(field << CALIBRATION_SHIFT);
        RTCCON.clear(WRITE_ENABLE);
    }

    /// Sets the alarm. Its year is not looked at.
    ///
    /// # Errors
    /// [`DateTimeError`]; an alarm from before is off then.
    pub fn set_alarm(
        &mut self,
        moment: DateTime,
        every: AlarmEvery,
        count: AlarmCount,
    ) -> Result<(), DateTimeError> {
        self.stop_alarm();
        moment.check()?;
        while RTCALRM.has(ALARM_SYNC) {}
        ALRMTIME.write(moment.time_digits());
        ALRMDATE.write(moment.alarm_date_digits());
        let count = match count {
            AlarmCount::Repeated(more) => u32::from(more),
            AlarmCount::Endless => CHIME,
        };
        RTCALRM.write((every as u32) << MASK_SHIFT | count);
        Self::SOURCE.clear();
        RTCALRM.set(ALARM_ON);
        Ok(())
    }

    /// Takes the alarm back.
    pub fn stop_alarm(&mut self) {
        RTCALRM.write(0);
        Self::SOURCE.clear();
    }

    /// Whether the alarm will come.
    #[must_use]
    pub fn has_alarm(&self) -> bool {
        RTCALRM.has(ALARM_ON)
    }
}

fn allow_writing() {
    // Another access between the two keys would spoil them.
    dma::suspended(|| with_system_unlocked(|| RTCCON.set(WRITE_ENABLE)));
}

/// Waits until its clock runs or stands.
fn becomes(running: bool) -> Result<(), SetError> {
    const LOOKS_MAX: u32 = 100_000;
    let has_become = (0..LOOKS_MAX).any(|_| RTCCON.has(RUNS) == running);
    has_become.then_some(()).ok_or(SetError::NoClock)
}

#[cfg(test)]
mod tests {
    use super::{AlarmCount, AlarmEvery, Calendar, DateTime, DateTimeError, SetError};
    use crate::register::map::{ALRMDATE, ALRMTIME, RTCALRM, RTCCON, RTCDATE, RTCTIME};

    const MOMENT: DateTime = DateTime {
        year: 2_028,
        month: 2,
        day: 29,
        weekday: 2,
        hour: 23,
        minute: 59,
        second: 58,
    };

    /// The bits of all six registers, on a calendar of memory, whose clock bit stands where it was put.
    #[test]
    fn the_calendar_sets_its_bits() {
        // DMA's tests use the same registers.
        let _alone = crate::dma::tests::alone();
        let mut calendar = Calendar::new();
        RTCCON.write(0);
        assert_eq!(calendar.set(MOMENT), Err(SetError::NoClock), "RTCCLKON stays 0");
        assert_eq!(RTCCON.read(), 0, "off, and not writable any more");
        assert_eq!((RTCTIME.read(), RTCDATE.read()), (0x2359_5800, 0x2802_2902));
        assert_eq!(calendar.now(), MOMENT);
        calendar.calibrate(-1);
        assert_eq!(RTCCON.read(), 0x3FF << 16);
        calendar.calibrate(3);
        assert_eq!(RTCCON.read(), 3 << 16);
        assert!(!calendar.is_running());
        RTCCON.write(1 << 15 | 1 << 6);
        assert!(calendar.is_running());

        let set = calendar.set_alarm(MOMENT, AlarmEvery::Week, AlarmCount::Repeated(4));
        assert_eq!(set, Ok(()));
        assert_eq!((ALRMTIME.read(), ALRMDATE.read()), (0x2359_5800, 0x0002_2902));
        assert_eq!(RTCALRM.read(), 1 << 15 | 7 << 8 | 4);
        assert!(calendar.has_alarm());
        let set = calendar.set_alarm(MOMENT, AlarmEvery::HalfSecond, AlarmCount::Endless);
        assert_eq!((set, RTCALRM.read()), (Ok(()), 1 << 15 | 1 << 14));
        calendar.stop_alarm();
        assert_eq!(RTCALRM.read(), 0);
    }

    #[test]
    fn moments_that_are_none_are_named() {
        for (moment, error) in [
            (
                DateTime {
                    year: 1_999,
                    ..MOMENT
                },
                DateTimeError::Year(1_999),
            ),
            (DateTime { month: 13, ..MOMENT }, DateTimeError::Month(13)),
            (
                DateTime {
                    year: 2_027,
                    ..MOMENT
                },
                DateTimeError::Day(29),
            ),
            (
                DateTime {
                    month: 4,
                    day: 31,
                    ..MOMENT
                },
                DateTimeError::Day(31),
            ),
            (DateTime { weekday: 7, ..MOMENT }, DateTimeError::Weekday(7)),
            (DateTime { hour: 24, ..MOMENT }, DateTimeError::Hour(24)),
            (DateTime { minute: 60, ..MOMENT }, DateTimeError::Minute(60)),
            (DateTime { second: 60, ..MOMENT }, DateTimeError::Second(60)),
        ] {
            assert_eq!(moment.check(), Err(error));
        }
        assert_eq!(MOMENT.check(), Ok(()));
    }
}
