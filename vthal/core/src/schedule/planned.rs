//! Which runs are to come, and what would keep them.

use jiff::civil::Date;
use rvac_api::InQuiet;

use super::marks::Mark;
use super::verdict::{DueRun, late_max_s, open_runs, put_off_s};
use super::{Book, Entry, WallClock};

/// Runs foretold of each entry.
const RUNS_MAX: usize = 10;
/// Days planned ahead, besides the dates that were decided before their time: ten weeks for what runs once a week, and more.
const DAYS_MAX: usize = 100;

/// A run that is to come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Number of the entry.
    pub entry: u32,
    /// What its rule says.
    pub due_s: i64,
    /// When it starts.
    pub start_s: i64,
    /// What keeps it from starting.
    pub kept: Option<Blocker>,
    /// What lets it start later than its entry says.
    pub held: Option<Held>,
}

/// What keeps a run from starting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocker {
    /// A person skipped it.
    Skipped,
    /// It falls into the quiet hours.
    QuietHours,
    /// The robot is not on its floor now, for this reason.
    Elsewhere(&'static str),
}

/// What lets a run start later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// It waits for the end of the quiet hours.
    QuietHours,
    /// It waits for the robot, or for the next reading of the clock.
    NoRobot,
}

/// The next runs of an entry, the first one first; none of one that is not enabled.
pub fn planned(book: &Book, entry: &Entry, clock: WallClock<'_>) -> Vec<Planned> {
    if !entry.plan.enabled {
        return Vec::new();
    }
    let mut runs = waiting(book, entry, clock);
    runs.extend(to_come(book, entry, clock).take(RUNS_MAX - runs.len().min(RUNS_MAX)));
    if entry.skip_next
        && let Some(first) = runs.first_mut()
    {
        first.kept = Some(Blocker::Skipped);
        first.held = None;
        first.start_s = first.due_s;
    }
    runs
}

/// Runs that were due and may still start.
fn waiting(book: &Book, entry: &Entry, clock: WallClock<'_>) -> Vec<Planned> {
    let now_s = clock.now_s;
    let open = open_runs(book, entry, clock).into_iter();
    let in_time = open.filter(|run| {
        now_s - run.start_s <= late_max_s(entry) && entry.marks.get(run.date) != Some(Mark::Missed)
    });
    let planned = |run: DueRun| {
        let held = if run.start_s > now_s {
            Held::QuietHours
        } else {
            Held::NoRobot
        };
        Planned {
            entry: entry.number,
            due_s: run.due_s,
            start_s: run.start_s.max(now_s),
            kept: None,
            held: Some(held),
        }
    };
    in_time.map(planned).collect()
}

fn to_come<'a>(
    book: &'a Book,
    entry: &'a Entry,
    WallClock { zone, now_s }: WallClock<'a>,
) -> impl Iterator<Item = Planned> + 'a {
    let today = zone.local(now_s).map(|local| local.date());
    let mut next = first_date(entry, today);
    let dates = core::iter::from_fn(move || {
        let date = next?;
        next = date.tomorrow().ok();
        Some(date)
    });
    dates.take(DAYS_MAX).filter_map(move |date| {
        let due_s = entry.plan.when.due_s(date, zone).filter(|due_s| *due_s > now_s)?;
        if entry.marks.get(date) == Some(Mark::Closed) {
            return None;
        }
        let start_s = put_off_s(book, entry, due_s, zone);
        let quiet = book.quiet().is_some_and(|quiet| quiet.covers(due_s, zone));
        Some(Planned {
            entry: entry.number,
            due_s,
            start_s,
            kept: (quiet && entry.plan.in_quiet == InQuiet::Refuse).then_some(Blocker::QuietHours),
            held: (start_s != due_s).then_some(Held::QuietHours),
        })
    })
}

/// A single run may be far away.
fn first_date(entry: &Entry, today: Option<Date>) -> Option<Date> {
    match entry.plan.when {
        super::When::Once { date, .. } => today.map(|today| today.max(date)),
        super::When::Weekly { .. } => today,
    }
}
