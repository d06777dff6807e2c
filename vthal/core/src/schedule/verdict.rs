//! What is decided of a run whose time has come.

use brain::LinkFault;
use jiff::civil::Date;
use rvac_api::InQuiet;

use super::marks::Mark;
use super::{Book, Entry, WallClock, Zone};

/// So many seconds after its time a run is still on time: the daemon reads its clock every second, and systems stall.
pub const GRACE_S: i64 = 120;
/// A robot that is not there is waited for, for as long as the entry may be late; so long before the end of that time it is
/// refused, so that the reason has its name.
const GIVES_UP_S: i64 = 30;
/// There is no robot at the serial line.
pub const NO_ROBOT: &str = "no-robot";
/// Whether a run waits: a robot that cannot be reached at this moment may answer at the next.
fn is_waited_for(reason: &str) -> bool {
    [NO_ROBOT, "link-lost"].contains(&reason) || LinkFault::from_name(reason).is_some()
}

/// What becomes of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is noted, and the robot starts as soon as the note is on the disk.
    Starting,
    /// The robot was commanded.
    Fired,
    /// The daemon ended after the note and before it commanded the robot, or that is unknown.
    Interrupted,
    /// A person skipped it.
    Skipped,
    /// Nobody was there in time to start it.
    Missed,
    /// It fell into the quiet hours.
    QuietHours,
    /// The robot could not, for this reason.
    Refused(String),
}

impl Outcome {
    /// The name for clients, logs and files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Starting => "starting",
            Self::Fired => "fired",
            Self::Interrupted => "interrupted",
            Self::Skipped => "skipped",
            Self::Missed => "missed",
            Self::QuietHours => "quiet-hours",
            Self::Refused(_) => "refused",
        }
    }

    pub(super) const fn mark(&self) -> Mark {
        match self {
            Self::Missed => Mark::Missed,
            _ => Mark::Closed,
        }
    }
}

/// What was decided of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Number of the entry.
    pub entry: u32,
    /// Local date of the run.
    pub date: Date,
    /// What becomes of it.
    pub outcome: Outcome,
}

/// A run whose time has come, or that waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DueRun {
    pub(super) date: Date,
    /// What its rule says.
    pub(super) due_s: i64,
    /// When it starts, at the earliest: later when quiet hours put it off.
    pub(super) start_s: i64,
}

/// The verdict about the run that was due first, if any is due. `ready` says why the robot could not start an entry's job at
/// this moment.
pub fn verdict(
    book: &Book,
    clock: WallClock<'_>,
    ready: impl Fn(&Entry) -> Result<(), &'static str>,
) -> Option<Verdict> {
    let WallClock { zone, now_s } = clock;
    let quiet = book.quiet();
    let present = Present {
        now_s,
        is_quiet: quiet.is_some_and(|quiet| quiet.covers(now_s, zone)),
    };
    let verdicts = book.entries().filter_map(|entry| {
        let runs = open_runs(book, entry, clock).into_iter();
        let mut decided = runs.filter_map(|run| {
            let outcome = judge(entry, run, present, &ready)?;
            let verdict = Verdict {
                entry: entry.number,
                date: run.date,
                outcome,
            };
            Some((run.start_s, verdict))
        });
        decided.next()
    });
    verdicts
        .min_by_key(|(start_s, _)| *start_s)
        .map(|(_, verdict)| verdict)
}

/// The runs of an entry that were due and are not decided, the oldest first. Quiet hours and being late last less than a day
/// each, so runs of the day before yesterday are the oldest that matter.
pub(super) fn open_runs(book: &Book, entry: &Entry, WallClock { zone, now_s }: WallClock<'_>) -> Vec<DueRun> {
    let Some(today) = zone
        .local(now_s)
        .map(|local| local.date())
        .filter(|_| entry.plan.enabled)
    else {
        return Vec::new();
    };
    let yesterday = today.yesterday().ok();
    let before = yesterday.and_then(|date| date.yesterday().ok());
    let dates = [before, yesterday, Some(today)].into_iter().flatten();
    let run = |date: Date| {
        let due_s = entry.plan.when.due_s(date, zone)?;
        let open = due_s <= now_s && due_s >= entry.since_s && entry.marks.get(date) != Some(Mark::Closed);
        open.then(|| DueRun {
            date,
            due_s,
            start_s: put_off_s(book, entry, due_s, zone),
        })
    };
    dates.filter_map(run).collect()
}

/// When a run that is due then starts: after the quiet hours if it waits for their end.
pub(super) fn put_off_s(book: &Book, entry: &Entry, due_s: i64, zone: &Zone) -> i64 {
    let quiet = book.quiet().filter(|_| entry.plan.in_quiet == InQuiet::Wait);
    quiet.map_or(due_s, |quiet| quiet.over_s(due_s, zone))
}

/// How late, in seconds, an entry may start.
pub(super) fn late_max_s(entry: &Entry) -> i64 {
    GRACE_S + 60 * i64::from(entry.plan.late_min)
}

/// What decides about all runs that are due.
#[derive(Clone, Copy, Debug)]
struct Present {
    now_s: i64,
    is_quiet: bool,
}

fn judge(
    entry: &Entry,
    run: DueRun,
    present: Present,
    ready: impl Fn(&Entry) -> Result<(), &'static str>,
) -> Option<Outcome> {
    // What is left out is left out at its time.
    let late_s = present.now_s - if entry.skip_next { run.due_s } else { run.start_s };
    let was_missed = entry.marks.get(run.date) == Some(Mark::Missed);
    if late_s < 0 || (was_missed && late_s > GRACE_S) {
        return None;
    }
    if late_s > late_max_s(entry) {
        return Some(Outcome::Missed);
    }
    if entry.skip_next {
        return Some(Outcome::Skipped);
    }
    if present.is_quiet {
        return (entry.plan.in_quiet == InQuiet::Refuse).then_some(Outcome::QuietHours);
    }
    match ready(entry) {
        Ok(()) => Some(Outcome::Starting),
        Err(reason) if is_waited_for(reason) && late_s < late_max_s(entry) - GIVES_UP_S => None,
        Err(reason) => Some(Outcome::Refused(reason.to_owned())),
    }
}
