//! Quiet hours: from a time of day to another, in which nothing starts by itself.

use jiff::civil::Time;

use super::Zone;

/// Hours of the day in which nothing starts by itself; over midnight when they end before they begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quiet {
    from: Time,
    to: Time,
}

impl Quiet {
    /// From a time to another one; `None` if they are the same.
    #[must_use]
    pub fn new(from: Time, to: Time) -> Option<Self> {
        (from != to).then_some(Self { from, to })
    }

    /// When they begin.
    #[must_use]
    pub fn from(&self) -> Time {
        self.from
    }

    /// When they end.
    #[must_use]
    pub fn to(&self) -> Time {
        self.to
    }

    /// Whether an instant falls into them.
    #[must_use]
    pub fn covers(&self, utc_s: i64, zone: &Zone) -> bool {
        let Some(local) = zone.local(utc_s) else {
            return false;
        };
        let at = local.time();
        if self.from < self.to {
            self.from <= at && at < self.to
        } else {
            self.from <= at || at < self.to
        }
    }

    /// The first instant from `utc_s` on at which they are over; that instant itself outside of them.
    #[must_use]
    pub fn over_s(&self, utc_s: i64, zone: &Zone) -> i64 {
        if !self.covers(utc_s, zone) {
            return utc_s;
        }
        let today = zone.local(utc_s).map(|local| local.date());
        let days = today
            .into_iter()
            .flat_map(|day| [Some(day), day.tomorrow().ok()])
            .flatten();
        let ends = days.filter_map(|date| zone.first_instant(date, self.to));
        ends.filter(|end| *end > utc_s).min().unwrap_or(utc_s)
    }
}

#[cfg(test)]
mod tests {
    use jiff::civil::{date, time};

    use super::{Quiet, Zone};

    #[test]
    fn they_may_span_midnight_and_end_at_their_end() {
        let zone = Zone::named("Europe/Tallinn").expect("known");
        let night = Quiet::new(time(22, 0, 0, 0), time(7, 0, 0, 0)).expect("a span");
        let at = |day, hour, minute| {
            zone.first_instant(date(2026, 11, day), time(hour, minute, 0, 0))
                .expect("exists")
        };
        for (instant, over) in [
            (at(22, 21, 59), at(22, 21, 59)),
            (at(22, 22, 0), at(23, 7, 0)),
            (at(23, 6, 59), at(23, 7, 0)),
            (at(23, 7, 0), at(23, 7, 0)),
        ] {
            assert_eq!(night.covers(instant, &zone), instant != over);
            assert_eq!(night.over_s(instant, &zone), over);
        }
        let noon = Quiet::new(time(12, 0, 0, 0), time(14, 0, 0, 0)).expect("a span");
        assert_eq!(noon.over_s(at(22, 13, 0), &zone), at(22, 14, 0));
        assert!(!noon.covers(at(22, 14, 0), &zone));
        assert_eq!(Quiet::new(time(7, 0, 0, 0), time(7, 0, 0, 0)), None);
    }
}
