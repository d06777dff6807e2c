//! Which runs of an entry were decided.

use std::collections::BTreeMap;

use jiff::civil::Date;

/// Dates that are remembered one by one: a year of days.
const DATES_MAX: usize = 400;

/// What a mark says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    /// This run is over, for ever.
    Closed,
    /// It was found too late. If the clock was wrong then and its time comes once more, it starts.
    Missed,
}

/// The decided runs of an entry, by their dates. What is forgotten counts as closed, with all that lies before it, so that
/// no run can come back.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Marks {
    closed_until: Option<Date>,
    dates: BTreeMap<Date, Mark>,
}

impl Marks {
    /// The mark of a date, if it was decided.
    #[must_use]
    pub(super) fn get(&self, date: Date) -> Option<Mark> {
        if self.closed_until.is_some_and(|until| date <= until) {
            return Some(Mark::Closed);
        }
        self.dates.get(&date).copied()
    }

    /// Notes a decision.
    pub(super) fn set(&mut self, date: Date, mark: Mark) {
        self.dates.insert(date, mark);
        while self.dates.len() > DATES_MAX {
            let forgotten = self.dates.pop_first().map(|(date, _)| date);
            self.closed_until = self.closed_until.max(forgotten);
        }
    }

    /// All dates up to this one are closed.
    #[must_use]
    pub(super) fn closed_until(&self) -> Option<Date> {
        self.closed_until
    }

    /// The dates that carry this mark.
    pub(super) fn dates(&self, mark: Mark) -> impl Iterator<Item = Date> + '_ {
        self.dates
            .iter()
            .filter(move |(_, found)| **found == mark)
            .map(|(date, _)| *date)
    }

    /// Marks as they were kept.
    pub(super) fn restored(closed_until: Option<Date>, dates: impl Iterator<Item = (Date, Mark)>) -> Self {
        let mut marks = Self {
            closed_until,
            ..Self::default()
        };
        for (date, mark) in dates {
            marks.set(date, mark);
        }
        marks
    }
}

#[cfg(test)]
mod tests {
    use jiff::civil::date;

    use super::{DATES_MAX, Mark, Marks};

    #[test]
    fn what_was_closed_stays_closed_when_it_is_forgotten() {
        let mut marks = Marks::default();
        let first = date(2026, 1, 1);
        // A clock that was wrong once does not close the years in between.
        marks.set(date(2037, 1, 1), Mark::Closed);
        let mut day = first;
        for _ in 0..2 * DATES_MAX {
            marks.set(day, Mark::Closed);
            day = day.tomorrow().expect("a date");
            assert_eq!(marks.get(first), Some(Mark::Closed));
            assert_eq!(marks.get(day), None);
        }
        assert_eq!(marks.dates(Mark::Closed).count(), DATES_MAX);
    }
}
