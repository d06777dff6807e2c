//! The rule of an entry: on which dates it comes due, and at what time of day.

use jiff::civil::{Date, Time, Weekday};

use super::Zone;

/// A set of days of the week.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Days(u8);

impl Days {
    /// The same with one more.
    #[must_use]
    pub fn with(self, day: Weekday) -> Self {
        Self(self.0 | 1 << day.to_monday_zero_offset())
    }

    /// Whether this day is in it.
    #[must_use]
    pub fn has(self, day: Weekday) -> bool {
        self.0 & 1 << day.to_monday_zero_offset() != 0
    }

    /// Whether no day is in it.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

/// When an entry comes due, in local time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Every week.
    Weekly {
        /// On these days.
        days: Days,
        /// Time of day.
        at: Time,
    },
    /// On one day.
    Once {
        /// Which.
        date: Date,
        /// Time of day.
        at: Time,
    },
}

impl When {
    /// Whether it comes due on that date.
    #[must_use]
    pub fn is_on(&self, date: Date) -> bool {
        match self {
            Self::Weekly { days, .. } => days.has(date.weekday()),
            Self::Once { date: only, .. } => *only == date,
        }
    }

    /// The instant that it means on a date on which it comes due; see [`Zone::first_instant`].
    #[must_use]
    pub fn due_s(&self, date: Date, zone: &Zone) -> Option<i64> {
        let (Self::Weekly { at, .. } | Self::Once { at, .. }) = self;
        self.is_on(date).then(|| zone.first_instant(date, *at)).flatten()
    }
}
