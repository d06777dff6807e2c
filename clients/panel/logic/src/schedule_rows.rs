//! Schedules as rows for people who read.

use rvac_api::{
    FloorView, FloorsView, InQuiet, JobPart, PlannedRun, ScheduleDecision, ScheduleEntry, ScheduleTime,
    ScheduleView, ScheduledJob, Schedules, Weekday,
};

use crate::codes::{explain, strategy_title};
use crate::home::RoomRow;
use crate::job_settings::JobSettings;
use crate::kept_places::PlaceRow;
use crate::words::Words;

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

/// What is known of the home: rooms and places of the floor on which the robot is, and all floors.
#[derive(Clone, Copy, Debug)]
pub struct HomeRows<'a> {
    /// Rooms of this floor.
    pub rooms: &'a [RoomRow],
    /// Kept places of this floor.
    pub places: &'a [PlaceRow],
    /// The floors.
    pub floors: &'a FloorsView,
}

/// The schedules, by their numbers.
#[must_use]
pub fn schedule_rows(words: &Words, schedules: &Schedules, home: HomeRows<'_>) -> Vec<ScheduleRow> {
    let row = |view| row(words, view, home);
    schedules.entries.iter().map(row).collect()
}

/// What a floor is called.
#[must_use]
pub fn floor_title(words: &Words, floor: &FloorView) -> String {
    let named = floor.name.clone();
    named.unwrap_or_else(|| words.home.floor.fill([&floor.number]))
}

/// The floor of an entry, if it is not the one on which the robot is.
#[must_use]
pub fn floor_elsewhere(words: &Words, floor: Option<u16>, floors: &FloorsView) -> Option<String> {
    let number = floor.filter(|number| floors.here != Some(*number))?;
    let known = floors.floors.iter().find(|floor| floor.number == number);
    Some(known.map_or_else(
        || words.home.floor.fill([&number]),
        |floor| floor_title(words, floor),
    ))
}

fn row(words: &Words, view: &ScheduleView, home: HomeRows<'_>) -> ScheduleRow {
    let (texts, entry) = (&words.schedule, &view.entry);
    let elsewhere = floor_elsewhere(words, entry.floor, home.floors);
    // The rooms and places that are known are those of the floor on which the robot is.
    let job = match &elsewhere {
        Some(title) => texts
            .on_floor
            .fill([&job_text(words, &entry.job, &[], &[]), title]),
        None => job_text(words, &entry.job, home.rooms, home.places),
    };
    let next = match view.next.first() {
        Some(run) => texts.next.fill([&planned_text(words, run)]),
        None if entry.enabled => texts.no_run.to_owned(),
        None => texts.off.to_owned(),
    };
    let refused = view.refused_now.as_deref().filter(|_| entry.enabled);
    let now = refused.map(|reason| texts.would_not.fill([&what_of(words, reason)]));
    ScheduleRow {
        number: view.number,
        name: entry.name.clone(),
        words: [time_text(words, &entry.when), job]
            .into_iter()
            .chain(missed_text(words, entry))
            .collect::<Vec<_>>()
            .join(", "),
        next,
        now: now.unwrap_or_default(),
        enabled: entry.enabled,
        skips: view.skip_next,
    }
}

/// What becomes of a run whose time finds the robot off or in its quiet hours, as far as it is not just left out.
fn missed_text(words: &Words, entry: &ScheduleEntry) -> Vec<String> {
    let texts = &words.schedule;
    let late = (entry.late_min > 0).then(|| texts.may_be_late.fill([&entry.late_min]));
    let waits = (entry.in_quiet == InQuiet::Wait).then(|| texts.may_wait.to_owned());
    late.into_iter().chain(waits).collect()
}

/// What a code means; a code without words is shown as it is.
fn what_of<'a>(words: &Words, code: &'a str) -> &'a str {
    explain(words, code).map_or(code, |found| found.cause)
}

/// The next runs of all, each with its name and what keeps it.
#[must_use]
pub fn next_rows(words: &Words, schedules: &Schedules) -> Vec<String> {
    let name = |run: &PlannedRun| {
        let found = schedules.entries.iter().find(|view| view.number == run.entry);
        found.map_or_else(|| run.entry.to_string(), |view| view.entry.name.clone())
    };
    let row = |run: &PlannedRun| format!("{}: {}", name(run), planned_text(words, run));
    schedules.next.iter().map(row).collect()
}

/// What came of the last runs, the newest first.
#[must_use]
pub fn past_rows(words: &Words, schedules: &Schedules) -> Vec<String> {
    let row = |past: &ScheduleDecision| {
        let what = match past.outcome.as_str() {
            "fired" => words.schedule.fired,
            outcome => what_of(words, past.reason.as_deref().unwrap_or(outcome)),
        };
        format!("{}, {}: {what}", instant_text(words, &past.at), past.name)
    };
    schedules.decisions.iter().map(row).collect()
}

/// In which zone times are shown, and what its clocks show.
#[must_use]
pub fn zone_text(words: &Words, schedules: &Schedules) -> String {
    let texts = &words.schedule;
    schedules.clock.as_ref().map_or_else(
        || texts.no_clock.to_owned(),
        |clock| texts.zone.fill([&schedules.zone, &instant_text(words, clock)]),
    )
}

fn planned_text(words: &Words, run: &PlannedRun) -> String {
    let (texts, at) = (&words.schedule, instant_text(words, &run.at));
    match (run.kept_by.as_deref(), run.held_by.as_deref()) {
        (Some("skipped"), _) => texts.skipped.fill([&at]),
        (Some("quiet-hours"), _) => texts.blocked_by_quiet.fill([&at]),
        (Some(reason), _) => texts.kept.fill([&at, &what_of(words, reason)]),
        (None, Some("quiet-hours")) => texts.after_quiet.fill([&at]),
        (None, Some(_)) => texts.when_answers.fill([&at]),
        (None, None) => at,
    }
}

fn time_text(words: &Words, when: &ScheduleTime) -> String {
    let texts = &words.schedule;
    match when {
        ScheduleTime::Weekly { days, at } if days.len() == Weekday::ALL.len() => texts.daily.fill([at]),
        ScheduleTime::Weekly { days, at } => {
            let names: Vec<&str> = days.iter().map(|day| day_text(words, *day)).collect();
            texts.weekly.fill([&names.join(", "), at])
        }
        ScheduleTime::Once { date, at } => texts
            .once_at
            .fill([&instant_text(words, &format!("{date}T{at}"))]),
    }
}

fn job_text(words: &Words, job: &ScheduledJob, rooms: &[RoomRow], places: &[PlaceRow]) -> String {
    let texts = &words.schedule;
    let order = match job {
        ScheduledJob::Start { strategy: None } => return texts.whole_home.to_owned(),
        ScheduledJob::Start {
            strategy: Some(strategy),
        } => return texts.whole_home_by.fill([&strategy_title(words, strategy)]),
        ScheduledJob::Clean(order) => order,
    };
    let part = |part: &JobPart| match part {
        JobPart::Room(id) => {
            let known = rooms.iter().find(|row| row.id == *id);
            known.map_or_else(|| texts.room.fill([id]), |row| row.name.clone())
        }
        JobPart::Place(number) => {
            let known = places.iter().find(|row| row.number == *number);
            known.map_or_else(|| texts.place.fill([number]), |row| row.name.clone())
        }
        JobPart::Zone(_) => texts.a_zone.to_owned(),
        JobPart::Spot(_) => texts.a_spot.to_owned(),
    };
    let mut parts: Vec<String> = order.parts.iter().map(part).collect();
    if parts.is_empty() {
        parts.push(texts.whole_home.to_owned());
    }
    if order.passes > 1 {
        parts.push(texts.times.fill([&order.passes]));
    }
    parts.extend(JobSettings::of(order).texts(words));
    parts.join(", ")
}

/// Short name of a day.
#[must_use]
pub fn day_text(words: &Words, day: Weekday) -> &'static str {
    let place = Weekday::ALL.into_iter().position(|other| other == day);
    let mut names = words.unit.weekdays.split_whitespace();
    place.and_then(|place| names.nth(place)).unwrap_or_default()
}

/// `Mon 23 Nov, 07:30` for `2026-11-23T07:30:00+02:00`; anything else as it is.
fn instant_text(words: &Words, instant: &str) -> String {
    told(words, instant).unwrap_or_else(|| instant.to_owned())
}

fn told(words: &Words, instant: &str) -> Option<String> {
    let (date, time) = instant.split_once('T')?;
    let at = time.get(..5)?;
    let mut parts = date.splitn(3, '-');
    let mut number = || parts.next()?.parse::<u32>().ok();
    let (year, month, day) = (number()?, number()?, number()?);
    let mut months = words.unit.months.split_whitespace();
    let name = months.nth(usize::try_from(month).ok()?.checked_sub(1)?)?;
    let weekday = Weekday::ALL.get(weekday_from_monday(year, month, day)?)?;
    let weekday = day_text(words, *weekday);
    Some(words.unit.moment.fill([&weekday, &day, &name, &at]))
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
        FloorView, FloorsView, InQuiet, JobOrder, JobPart, PlannedRun, ScheduleDecision, ScheduleEntry,
        ScheduleTime, ScheduleView, ScheduledJob, Schedules, Weekday,
    };

    use super::{HomeRows, instant_text, next_rows, past_rows, schedule_rows, zone_text};
    use crate::home::RoomRow;
    use crate::words::{Language, Words};

    const ENGLISH: &Words = Language::English.words();

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
                        ..JobOrder::default()
                    }),
                    when: ScheduleTime::Weekly {
                        days: vec![Weekday::Mo, Weekday::Fr],
                        at: "07:30".to_owned(),
                    },
                    late_min: 45,
                    in_quiet: InQuiet::Wait,
                    floor: None,
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
    fn schedules_are_shown_with_rooms_days_and_reasons() {
        let kitchen = RoomRow {
            id: 4,
            name: "Kitchen".to_owned(),
            words: String::new(),
        };
        let here = FloorsView {
            here: Some(1),
            ..FloorsView::default()
        };
        let home = HomeRows {
            rooms: &[kitchen],
            places: &[],
            floors: &here,
        };
        let rows = schedule_rows(ENGLISH, &told(), home);
        assert_eq!(
            rows[0].words,
            "Mon, Fri at 07:30, Kitchen, room\u{a0}9, 2 times, up to 45 minutes late, waits for the end of the quiet hours"
        );
        assert_eq!(rows[0].next, "Next: Mon 23 Nov, 07:30, skipped");
        assert_eq!(rows[0].now, "It would not start now: A wheel hangs in the air.");
        assert_eq!(next_rows(ENGLISH, &told()), ["Food: Mon 23 Nov, 07:30, skipped"]);
        assert_eq!(
            past_rows(ENGLISH, &told()),
            ["Fri 20 Nov, 07:30, Food: A job runs or waits."]
        );
        assert!(zone_text(ENGLISH, &told()).contains("Europe/Tallinn, where it is Sun 22 Nov, 16:30."));
        assert!(zone_text(ENGLISH, &Schedules::default()).contains("clock is not set"));
    }

    #[test]
    fn rooms_of_another_floor_have_no_names_of_this_one() {
        let kitchen = RoomRow {
            id: 4,
            name: "Kitchen".to_owned(),
            words: String::new(),
        };
        let mut upstairs = told();
        upstairs.entries[0].entry.floor = Some(2);
        let attic = FloorView {
            number: 2,
            name: Some("Attic".to_owned()),
            ..FloorView::default()
        };
        let floors = |here| FloorsView {
            floors: vec![attic.clone()],
            here: Some(here),
            ..FloorsView::default()
        };
        let words = |here| {
            let home = HomeRows {
                rooms: std::slice::from_ref(&kitchen),
                places: &[],
                floors: &floors(here),
            };
            schedule_rows(ENGLISH, &upstairs, home)[0].words.clone()
        };
        assert_eq!(
            words(1),
            "Mon, Fri at 07:30, room\u{a0}4, room\u{a0}9, 2 times, on Attic, up to 45 minutes late, waits for the end of the quiet hours"
        );
        assert_eq!(
            words(2),
            "Mon, Fri at 07:30, Kitchen, room\u{a0}9, 2 times, up to 45 minutes late, waits for the end of the quiet hours"
        );
    }

    #[test]
    fn instants_are_shown_with_their_day_and_nonsense_as_it_is() {
        assert_eq!(instant_text(ENGLISH, "2024-02-29T23:59:00Z"), "Thu 29 Feb, 23:59");
        assert_eq!(instant_text(ENGLISH, "2000-01-01T00:00"), "Sat 1 Jan, 00:00");
        let estonian = Language::Estonian.words();
        assert_eq!(
            instant_text(estonian, "2024-02-29T23:59"),
            "N 29. veebr kell 23:59"
        );
        for odd in [
            "",
            "T",
            "2026-13-01T07:30",
            "0000-01-01T07:30",
            "2026-11-23T7",
            "2026-11-23Täää",
        ] {
            assert_eq!(instant_text(ENGLISH, odd), odd);
        }
    }
}
