//! What clients say of schedules becomes an edit, or a sentence that says what is wrong.

use jiff::civil::{self, Date, Time};
use rvac_api::{QuietHours, ScheduleEntry, ScheduleTime, Weekday};

use super::{Days, EditError, Plan, Quiet, ScheduleEdit, When, Zone};

/// Longest name of an entry, characters.
const NAME_MAX: usize = 40;
/// Longest that an entry may start late, minutes.
const LATE_MIN_MAX: u16 = 720;

/// Why what a client says is no schedule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScheduleError {
    /// No name.
    #[error("The name has {0} characters: it must be one line of 1 to {NAME_MAX}.")]
    Name(usize),
    /// No time of day.
    #[error("`{0}` is no time of day: give hours and minutes, for example 07:30.")]
    Time(String),
    /// No date.
    #[error("`{0}` is no date: give year, month and day, for example 2026-11-23.")]
    Date(String),
    /// No day.
    #[error("No day of the week is chosen: choose at least one.")]
    NoDays,
    /// Too late.
    #[error("{0} minutes late is too late: give 0 to {LATE_MIN_MAX}.")]
    Late(u16),
    /// No quiet hours.
    #[error("The quiet hours begin and end at {0}: give two times, or none for no quiet hours.")]
    NoSpan(String),
    /// No zone.
    #[error(
        "There is no time zone `{0}`: give a name of the IANA database, for example {1}, or none for the system's."
    )]
    Zone(String, String),
    /// The book refuses.
    #[error(transparent)]
    Edit(#[from] EditError),
}

impl ScheduleError {
    /// The reason's name for clients.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Edit(error) => error.name(),
            Self::Zone(..) => "no-such-zone",
            _ => "schedule-wrong",
        }
    }
}

impl Plan {
    /// A plan as a client sends it. Its job is checked when it starts, because homes change.
    ///
    /// # Errors
    /// See [`ScheduleError`].
    pub fn from_api(entry: ScheduleEntry) -> Result<Self, ScheduleError> {
        let name = entry.name.trim();
        let length = name.chars().count();
        if !(1..=NAME_MAX).contains(&length) || name.chars().any(char::is_control) {
            return Err(ScheduleError::Name(length));
        }
        if entry.late_min > LATE_MIN_MAX {
            return Err(ScheduleError::Late(entry.late_min));
        }
        Ok(Self {
            name: name.to_owned(),
            enabled: entry.enabled,
            when: when(&entry.when)?,
            job: entry.job,
            late_min: entry.late_min,
            in_quiet: entry.in_quiet,
            floor: entry.floor,
        })
    }
}

impl ScheduleEdit {
    /// Quiet hours as a client says them.
    ///
    /// # Errors
    /// See [`ScheduleError`].
    pub fn quiet_from_api(quiet: Option<&QuietHours>) -> Result<Self, ScheduleError> {
        quiet_hours(quiet).map(Self::Quiet)
    }

    /// The zone that a client names.
    ///
    /// # Errors
    /// [`ScheduleError::Zone`].
    pub fn zone_from_api(zone: Option<&str>) -> Result<Self, ScheduleError> {
        zone_named(zone).map(Self::Zone)
    }
}

pub(super) fn quiet_hours(quiet: Option<&QuietHours>) -> Result<Option<Quiet>, ScheduleError> {
    let Some(QuietHours { from, to }) = quiet else {
        return Ok(None);
    };
    let found = Quiet::new(time(from)?, time(to)?);
    found.map(Some).ok_or_else(|| ScheduleError::NoSpan(from.clone()))
}

pub(super) fn zone_named(name: Option<&str>) -> Result<Option<Zone>, ScheduleError> {
    let unknown = |name: &str| {
        let example = Zone::name_like(name).unwrap_or_else(|| "Europe/Tallinn".to_owned());
        ScheduleError::Zone(name.to_owned(), example)
    };
    let find = |name: &str| Zone::named(name.trim()).ok_or_else(|| unknown(name));
    name.map(find).transpose()
}

fn when(when: &ScheduleTime) -> Result<When, ScheduleError> {
    match when {
        ScheduleTime::Weekly { days, at } => {
            let days = days
                .iter()
                .fold(Days::default(), |all, day| all.with(weekday(*day)));
            if days.is_empty() {
                return Err(ScheduleError::NoDays);
            }
            Ok(When::Weekly { days, at: time(at)? })
        }
        ScheduleTime::Once { date: day, at } => Ok(When::Once {
            date: date(day)?,
            at: time(at)?,
        }),
    }
}

/// Days of the calendar in the words of clients.
pub(super) const fn weekday(day: Weekday) -> civil::Weekday {
    match day {
        Weekday::Mo => civil::Weekday::Monday,
        Weekday::Tu => civil::Weekday::Tuesday,
        Weekday::We => civil::Weekday::Wednesday,
        Weekday::Th => civil::Weekday::Thursday,
        Weekday::Fr => civil::Weekday::Friday,
        Weekday::Sa => civil::Weekday::Saturday,
        Weekday::Su => civil::Weekday::Sunday,
    }
}

fn time(text: &str) -> Result<Time, ScheduleError> {
    let parts = digits(text, ':', &[2, 2]).and_then(|numbers| match numbers[..] {
        [hour, minute] => Time::new(i8::try_from(hour).ok()?, i8::try_from(minute).ok()?, 0, 0).ok(),
        _ => None,
    });
    parts.ok_or_else(|| ScheduleError::Time(text.to_owned()))
}

pub(super) fn date(text: &str) -> Result<Date, ScheduleError> {
    let parts = digits(text, '-', &[4, 2, 2]).and_then(|numbers| match numbers[..] {
        [year, month, day] => Date::new(year, i8::try_from(month).ok()?, i8::try_from(day).ok()?).ok(),
        _ => None,
    });
    parts.ok_or_else(|| ScheduleError::Date(text.to_owned()))
}

/// Numbers of exactly so many digits with a separator between them.
fn digits(text: &str, separator: char, lengths: &[usize]) -> Option<Vec<i16>> {
    let parts: Vec<&str> = text.split(separator).collect();
    let fits = parts.len() == lengths.len()
        && parts
            .iter()
            .zip(lengths)
            .all(|(part, length)| part.len() == *length && part.bytes().all(|byte| byte.is_ascii_digit()));
    fits.then(|| parts.iter().map(|part| part.parse().ok()).collect())
        .flatten()
}

#[cfg(test)]
mod tests {
    use rvac_api::{InQuiet, QuietHours, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday};

    use super::super::{Plan, ScheduleEdit};

    fn entry(when: ScheduleTime) -> ScheduleEntry {
        ScheduleEntry {
            name: " Köök ".to_owned(),
            enabled: true,
            job: ScheduledJob::Start { strategy: None },
            when,
            late_min: 0,
            in_quiet: InQuiet::Refuse,
            floor: None,
        }
    }

    fn weekly(days: &[Weekday], at: &str) -> ScheduleEntry {
        entry(ScheduleTime::Weekly {
            days: days.to_vec(),
            at: at.to_owned(),
        })
    }

    #[test]
    fn what_is_wrong_is_named() {
        assert_eq!(
            Plan::from_api(weekly(&[Weekday::Mo], "07:30"))
                .expect("a plan")
                .name,
            "Köök"
        );
        let wrong = [
            weekly(&[], "07:30"),
            weekly(&[Weekday::Mo], "7:30"),
            weekly(&[Weekday::Mo], "24:00"),
            weekly(&[Weekday::Mo], "07:30:00"),
            entry(ScheduleTime::Once {
                date: "2026-02-29".to_owned(),
                at: "07:30".to_owned(),
            }),
            ScheduleEntry {
                late_min: 721,
                ..weekly(&[Weekday::Mo], "07:30")
            },
            ScheduleEntry {
                name: "two\nlines".to_owned(),
                ..weekly(&[Weekday::Mo], "07:30")
            },
        ];
        for wrong in wrong {
            let error = Plan::from_api(wrong.clone()).expect_err("is wrong");
            assert_eq!(error.name(), "schedule-wrong", "{wrong:?}");
        }
        let no_span = QuietHours {
            from: "22:00".to_owned(),
            to: "22:00".to_owned(),
        };
        assert!(ScheduleEdit::quiet_from_api(Some(&no_span)).is_err());
        assert!(ScheduleEdit::zone_from_api(Some("Mars/Base")).is_err());
    }
}
