//! Schedules as rows for people who read.

use rvac_api::{
    JobPart, PlannedRun, ScheduleDecision, ScheduleTime, ScheduleView, ScheduledJob, Schedules, Weekday,
};

use crate::catalogue::explain;
use crate::home::RoomRow;

/// A schedule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScheduleRow {
    /// Its number.
    pub number: u32,
    /// Its name.
    pub name: String,
    /// What it does and when.
    pub words: String,
    /// Its next run.
    pub next: String,
    /// What would keep it now; empty if nothing would.
    pub now: String,
    /// Whether it starts anything.
    pub enabled: bool,
    /// Whether its next run is left out.
    pub skips: bool,
}

/// The schedules, by their numbers.
#[must_use]
pub fn schedule_rows(schedules: &Schedules, rooms: &[RoomRow]) -> Vec<ScheduleRow> {
    schedules.entries.iter().map(|view| row(view, rooms)).collect()
}

fn row(view: &ScheduleView, rooms: &[RoomRow]) -> ScheduleRow {
    let entry = &view.entry;
    let next = match view.next.first() {
        Some(run) => format!("Next: {}", planned_text(run)),
        None if entry.enabled => "No run to come.".to_owned(),
        None => "Switched off.".to_owned(),
    };
    let now = view
        .refused_now
        .as_deref()
        .filter(|_| entry.enabled)
        .map(|reason| {
            let reason = explain(reason).map_or_else(|| reason.to_owned(), |found| found.what.to_owned());
            format!("It would not start at this moment: {reason}")
        });
    ScheduleRow {
        number: view.number,
        name: entry.name.clone(),
        words: format!("{}, {}", time_text(&entry.when), job_text(&entry.job, rooms)),
        next,
        now: now.unwrap_or_default(),
        enabled: entry.enabled,
        skips: view.skip_next,
    }
}

/// The next runs of all, each with its name and what keeps it.
#[must_use]
pub fn next_rows(schedules: &Schedules) -> Vec<String> {
    let name = |run: &PlannedRun| {
        let found = schedules.entries.iter().find(|view| view.number == run.entry);
        found.map_or_else(|| run.entry.to_string(), |view| view.entry.name.clone())
    };
    let row = |run: &PlannedRun| format!("{}: {}", name(run), planned_text(run));
    schedules.next.iter().map(row).collect()
}

/// What came of the last runs, the newest first.
#[must_use]
pub fn past_rows(schedules: &Schedules) -> Vec<String> {
    let row = |past: &ScheduleDecision| {
        let code = past.reason.as_deref().unwrap_or(&past.outcome);
        let what = match past.outcome.as_str() {
            "fired" => "Started.".to_owned(),
            _ => explain(code).map_or_else(|| code.to_owned(), |found| found.what.to_owned()),
        };
        format!("{}, {}: {what}", instant_text(&past.at), past.name)
    };
    schedules.decisions.iter().map(row).collect()
}

/// In which zone times are told, and what its clocks show.
#[must_use]
pub fn zone_text(schedules: &Schedules) -> String {
    match &schedules.clock {
        Some(clock) => format!(
            "All times are those of {}, where it is {}.",
            schedules.zone,
            instant_text(clock)
        ),
        None => "The robot's clock is not set, so nothing starts by itself until it is.".to_owned(),
    }
}

fn planned_text(run: &PlannedRun) -> String {
    let at = instant_text(&run.at);
    match (run.kept_by.as_deref(), run.held_by.as_deref()) {
        (Some("skipped"), _) => format!("{at}, left out"),
        (Some("quiet-hours"), _) => format!("{at}, kept by the quiet hours"),
        (Some(reason), _) => format!("{at}, kept: {reason}"),
        (None, Some("quiet-hours")) => format!("{at}, after the quiet hours"),
        (None, Some(_)) => format!("{at}, when the robot answers"),
        (None, None) => at,
    }
}

fn time_text(when: &ScheduleTime) -> String {
    match when {
        ScheduleTime::Weekly { days, at } if days.len() == Weekday::ALL.len() => format!("Daily at {at}"),
        ScheduleTime::Weekly { days, at } => {
            let names: Vec<&str> = days.iter().map(|day| day_text(*day)).collect();
            format!("{} at {at}", names.join(", "))
        }
        ScheduleTime::Once { date, at } => format!("Once, {}", instant_text(&format!("{date}T{at}"))),
    }
}

fn job_text(job: &ScheduledJob, rooms: &[RoomRow]) -> String {
    let order = match job {
        ScheduledJob::Start { strategy: None } => return "the whole home".to_owned(),
        ScheduledJob::Start {
            strategy: Some(strategy),
        } => return format!("the whole home, {strategy}"),
        ScheduledJob::Clean(order) => order,
    };
    let part = |part: &JobPart| match part {
        JobPart::Room(id) => {
            let known = rooms.iter().find(|row| row.id == *id);
            known.map_or_else(|| format!("room {id}"), |row| row.name.clone())
        }
        JobPart::Zone(_) => "a zone".to_owned(),
    };
    let mut parts: Vec<String> = order.parts.iter().map(part).collect();
    if parts.is_empty() {
        parts.push("the whole home".to_owned());
    }
    if order.passes > 1 {
        parts.push(format!("{} times", order.passes));
    }
    parts.join(", ")
}

/// Short name of a day.
#[must_use]
pub const fn day_text(day: Weekday) -> &'static str {
    match day {
        Weekday::Mo => "Mon",
        Weekday::Tu => "Tue",
        Weekday::We => "Wed",
        Weekday::Th => "Thu",
        Weekday::Fr => "Fri",
        Weekday::Sa => "Sat",
        Weekday::Su => "Sun",
    }
}

/// `Mon 23 Nov, 07:30` for `2026-11-23T07:30:00+02:00`; anything else as it is.
fn instant_text(instant: &str) -> String {
    told(instant).unwrap_or_else(|| instant.to_owned())
}

fn told(instant: &str) -> Option<String> {
    const MONTHS: [&str; 12] = [
        "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec",
    ];
    let (date, time) = instant.split_once('T')?;
    let at = time.get(..5)?;
    let mut parts = date.splitn(3, '-');
    let mut number = || parts.next()?.parse::<u32>().ok();
    let (year, month, day) = (number()?, number()?, number()?);
    let name = MONTHS.get(usize::try_from(month).ok()?.checked_sub(1)?)?;
    let weekday = Weekday::ALL.get(weekday_from_monday(year, month, day)?)?;
    Some(format!("{} {day} {name}, {at}", day_text(*weekday)))
}

/// Days after Monday, by Sakamoto's rule.
fn weekday_from_monday(year: u32, month: u32, day: u32) -> Option<usize> {
    const SHIFTS: [u32; 12] = [0, 3, 2, 5, 0, 3, 5, 1, 4, 6, 2, 4];
    let shift = SHIFTS.get(usize::try_from(month).ok()?.checked_sub(1)?)?;
    let year = if month < 3 { year.checked_sub(1)? } else { year };
    let from_sunday = (year + year / 4 - year / 100 + year / 400 + shift + day) % 7;
    usize::try_from((from_sunday + 6) % 7).ok()
}

#[cfg(test)]
mod tests {
    use rvac_api::{
        InQuiet, JobOrder, JobPart, PlannedRun, ScheduleDecision, ScheduleEntry, ScheduleTime, ScheduleView,
        ScheduledJob, Schedules, Weekday,
    };

    use super::{instant_text, next_rows, past_rows, schedule_rows, zone_text};
    use crate::home::RoomRow;

    fn told() -> Schedules {
        let run = PlannedRun {
            entry: 3,
            at: "2026-11-23T07:30:00+02:00".to_owned(),
            kept_by: Some("skipped".to_owned()),
            held_by: None,
        };
        Schedules {
            zone: "Europe/Tallinn".to_owned(),
            clock: Some("2026-11-22T16:30".to_owned()),
            entries: vec![ScheduleView {
                number: 3,
                entry: ScheduleEntry {
                    name: "Food".to_owned(),
                    enabled: true,
                    job: ScheduledJob::Clean(JobOrder {
                        parts: vec![JobPart::Room(4), JobPart::Room(9)],
                        passes: 2,
                        avoid: vec![],
                    }),
                    when: ScheduleTime::Weekly {
                        days: vec![Weekday::Mo, Weekday::Fr],
                        at: "07:30".to_owned(),
                    },
                    late_min: 0,
                    in_quiet: InQuiet::Refuse,
                },
                skip_next: true,
                next: vec![run.clone()],
                refused_now: Some("wheel-drop".to_owned()),
            }],
            next: vec![run],
            decisions: vec![ScheduleDecision {
                entry: 3,
                name: "Food".to_owned(),
                date: "2026-11-20".to_owned(),
                at: "2026-11-20T07:30:00+02:00".to_owned(),
                outcome: "refused".to_owned(),
                reason: Some("job-runs".to_owned()),
            }],
            ..Schedules::default()
        }
    }

    #[test]
    fn schedules_are_told_with_rooms_days_and_reasons() {
        let kitchen = RoomRow {
            id: 4,
            name: "Kitchen".to_owned(),
            words: String::new(),
        };
        let rows = schedule_rows(&told(), &[kitchen]);
        assert_eq!(rows[0].words, "Mon, Fri at 07:30, Kitchen, room 9, 2 times");
        assert_eq!(rows[0].next, "Next: Mon 23 Nov, 07:30, left out");
        assert_eq!(
            rows[0].now,
            "It would not start at this moment: A wheel hangs in the air."
        );
        assert_eq!(next_rows(&told()), ["Food: Mon 23 Nov, 07:30, left out"]);
        assert_eq!(
            past_rows(&told()),
            ["Fri 20 Nov, 07:30, Food: A job runs or waits."]
        );
        assert!(zone_text(&told()).contains("Europe/Tallinn, where it is Sun 22 Nov, 16:30."));
        assert!(zone_text(&Schedules::default()).contains("clock is not set"));
    }

    #[test]
    fn instants_are_told_with_their_day_and_nonsense_as_it_is() {
        assert_eq!(instant_text("2024-02-29T23:59:00Z"), "Thu 29 Feb, 23:59");
        assert_eq!(instant_text("2000-01-01T00:00"), "Sat 1 Jan, 00:00");
        for odd in [
            "",
            "T",
            "2026-13-01T07:30",
            "0000-01-01T07:30",
            "2026-11-23T7",
            "2026-11-23Täää",
        ] {
            assert_eq!(instant_text(odd), odd);
        }
    }
}
