//! Time zones by their names in the IANA database, as built into the program.

use jiff::civil::{Date, DateTime, Time};
use jiff::tz::{AmbiguousOffset, Offset, TimeZone, TimeZoneDatabase};
use jiff::{SignedDuration, Timestamp};

/// Names that share as much as this are meant to be the same: `Talinn` and `Tallinn`, but not `Tallinn` and `Dublin`.
const LIKE: f64 = 0.6;

/// How many of their pairs of letters two names share, 0..1 (Sørensen 1948, Dice 1945), in any case.
fn likeness(one: &str, other: &str) -> f64 {
    let pairs = |text: &str| -> Vec<(char, char)> {
        let letters: Vec<char> = text.to_lowercase().chars().collect();
        letters
            .iter()
            .copied()
            .zip(letters.iter().copied().skip(1))
            .collect()
    };
    let (ones, mut others) = (pairs(one), pairs(other));
    let all = ones.len() + others.len();
    let is_shared = |pair: &(char, char)| match others.iter().position(|other| other == pair) {
        Some(place) => {
            others.swap_remove(place);
            true
        }
        None => false,
    };
    let shared = ones.iter().copied().filter(is_shared).count();
    2.0 * shared as f64 / all.max(1) as f64
}

/// A time zone.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    name: String,
    rules: TimeZone,
}

/// What a wall clock shows: a moment, and the zone in which people read it.
#[derive(Clone, Copy, Debug)]
pub struct WallClock<'a> {
    /// Its zone.
    pub zone: &'a Zone,
    /// Seconds since 1970.
    pub now_s: i64,
}

impl Zone {
    /// A clock of this zone.
    #[must_use]
    pub const fn at(&self, now_s: i64) -> WallClock<'_> {
        WallClock { zone: self, now_s }
    }

    /// The zone with this name, for example `Europe/Tallinn`, in any case.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let rules = TimeZoneDatabase::bundled().get(name).ok()?;
        let name = rules.iana_name()?.to_owned();
        Some(Self { name, rules })
    }

    /// The name that is most like one which no zone has; `None` when no name is like it.
    #[must_use]
    pub fn name_like(name: &str) -> Option<String> {
        let zones = TimeZoneDatabase::bundled();
        let alike = zones.available().map(|known| {
            let known = known.as_str().to_owned();
            (likeness(&known, name), known)
        });
        let (best, known) = alike.max_by(|(one, _), (other, _)| one.total_cmp(other))?;
        (best >= LIKE).then_some(known)
    }

    /// The zone of those who have none.
    #[must_use]
    pub fn utc() -> Self {
        Self {
            name: "UTC".to_owned(),
            rules: TimeZone::UTC,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What clocks show at an instant; `None` beyond the years of the calendar.
    #[must_use]
    pub fn local(&self, utc_s: i64) -> Option<DateTime> {
        let instant = Timestamp::from_second(utc_s).ok()?;
        Some(self.rules.to_datetime(instant))
    }

    /// An instant as people read it: `2026-11-23T07:30:00+02:00`.
    #[must_use]
    pub fn format_local(&self, utc_s: i64) -> String {
        let Ok(instant) = Timestamp::from_second(utc_s) else {
            return String::new();
        };
        let offset = self.rules.to_offset(instant);
        instant.display_with_offset(offset).to_string()
    }

    /// The first instant of `date` at which clocks show `at` or later; `None` if the zone left that date out.
    ///
    /// Clocks that are set forward over `at` give the instant of the change, clocks that show it twice the first one.
    #[must_use]
    pub fn first_instant(&self, date: Date, at: Time) -> Option<i64> {
        let local = date.to_datetime(at);
        let instant = |offset: Offset| offset.to_timestamp(local).ok();
        let found = match self.rules.to_ambiguous_timestamp(local).offset() {
            AmbiguousOffset::Unambiguous { offset } => instant(offset)?,
            AmbiguousOffset::Fold { before, .. } => instant(before)?,
            AmbiguousOffset::Gap { before, .. } => self.end_of_gap(date, instant(before)?)?,
        };
        Some(found.as_second())
    }

    /// The change of clocks that left `inside` out, unless it left all of `date` out. `inside` is read with the offset before
    /// the change, so it lies at or after it.
    fn end_of_gap(&self, date: Date, inside: Timestamp) -> Option<Timestamp> {
        let second = SignedDuration::from_secs(1);
        let end = self
            .rules
            .preceding(inside.checked_add(second).ok()?)
            .next()?
            .timestamp();
        let before = self.rules.to_datetime(end.checked_sub(second).ok()?);
        let exists = before.date() == date || self.rules.to_datetime(end).date() == date;
        exists.then_some(end)
    }
}

#[cfg(test)]
mod tests {
    use jiff::civil::{date, time};

    use super::Zone;

    #[track_caller]
    fn first(zone: &str, (year, month, day): (i16, i8, i8), (hour, minute): (i8, i8)) -> Option<String> {
        let zone = Zone::named(zone).expect("a zone");
        let instant = zone.first_instant(date(year, month, day), time(hour, minute, 0, 0))?;
        Some(zone.format_local(instant))
    }

    #[test]
    fn a_name_that_is_nearly_one_is_found() {
        let like = |name: &str| Zone::name_like(name);
        assert_eq!(like("Europe/Talinn").as_deref(), Some("Europe/Tallinn"));
        assert_eq!(like("europe/tallin").as_deref(), Some("Europe/Tallinn"));
        assert_eq!(like("America/New York").as_deref(), Some("America/New_York"));
        for name in ["Moon", "", "/"] {
            assert_eq!(like(name), None, "{name}");
        }
    }

    #[test]
    fn a_time_that_is_left_out_means_the_instant_of_the_change() {
        let tallinn = |time| first("Europe/Tallinn", (2027, 3, 28), time).expect("exists");
        assert_eq!(tallinn((2, 59)), "2027-03-28T02:59:00+02:00");
        for left_out in [(3, 0), (3, 30), (3, 59), (4, 0)] {
            assert_eq!(tallinn(left_out), "2027-03-28T04:00:00+03:00");
        }
        // The clocks of Pyongyang went from 23:30 to the next day.
        let end = first("Asia/Pyongyang", (2018, 5, 4), (23, 45));
        assert_eq!(end.as_deref(), Some("2018-05-05T00:00:00+09:00"));
    }

    #[test]
    fn a_time_that_comes_twice_means_the_first() {
        let found = first("Europe/Tallinn", (2026, 10, 25), (3, 30));
        assert_eq!(found.as_deref(), Some("2026-10-25T03:30:00+03:00"));
    }

    #[test]
    fn a_date_that_is_left_out_has_no_instant() {
        assert_eq!(first("Pacific/Apia", (2011, 12, 30), (8, 0)), None);
        assert!(first("Pacific/Apia", (2011, 12, 31), (8, 0)).is_some());
    }

    #[test]
    fn names_are_those_of_the_database() {
        assert_eq!(
            Zone::named("europe/tallinn").expect("known").name(),
            "Europe/Tallinn"
        );
        for wrong in ["", "Tallinn", "Europe/Nowhere", "../etc/passwd"] {
            assert_eq!(Zone::named(wrong), None, "{wrong}");
        }
    }
}
