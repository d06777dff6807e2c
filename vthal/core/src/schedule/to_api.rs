//! Schedules in the words of clients.

use jiff::civil::Time;
use rvac_api::{
    PlannedRun, QuietHours, ScheduleDecision, ScheduleEntry, ScheduleTime, ScheduleView, Schedules, Weekday,
};

use super::book::Decision;
use super::from_api::weekday;
use super::{
    Blocker, Book, CLOCK_IS_SET_FROM_S, Entry, Held, Outcome, Plan, Planned, Quiet, When, Zone, planned,
};

/// Runs foretold of all entries together.
const RUNS_MAX: usize = 10;

impl Plan {
    /// The plan as clients say it.
    #[must_use]
    pub fn to_api(&self) -> ScheduleEntry {
        ScheduleEntry {
            name: self.name.clone(),
            enabled: self.enabled,
            job: self.job.clone(),
            when: when(&self.when),
            late_min: self.late_min,
            in_quiet: self.in_quiet,
            floor: self.floor,
        }
    }
}

/// What keeps an entry at this moment.
pub(crate) trait Keeping {
    /// Why the robot could not start its job.
    fn ready(&self, entry: &Entry) -> Result<(), &'static str>;
    /// Why the robot is not on its floor, as far as known.
    fn on_floor(&self, entry: &Entry) -> Result<(), &'static str>;
}

/// Everything that clients receive. `now_s` is `None` while the clock is not set.
pub(crate) fn view(book: &Book, zone: &Zone, now_s: Option<i64>, keeping: &impl Keeping) -> Schedules {
    let now_s = now_s.filter(|now_s| *now_s >= CLOCK_IS_SET_FROM_S);
    let foretell = |entry: &Entry| {
        let elsewhere = keeping.on_floor(entry).err();
        let runs = now_s.map_or_else(Vec::new, |now_s| planned(book, entry, zone.at(now_s)));
        let kept = |run: Planned| Planned {
            kept: run.kept.or(elsewhere.map(Blocker::Elsewhere)),
            ..run
        };
        runs.into_iter().map(kept).collect()
    };
    let plans: Vec<(&Entry, Vec<Planned>)> = book.entries().map(|entry| (entry, foretell(entry))).collect();
    let mut all: Vec<&Planned> = plans.iter().flat_map(|(_, runs)| runs).collect();
    all.sort_by_key(|run| (run.start_s, run.entry));
    let entry = |(entry, runs): &(&Entry, Vec<Planned>)| ScheduleView {
        number: entry.number(),
        entry: entry.plan().to_api(),
        skip_next: entry.skips_next(),
        next: runs.iter().map(|run| planned_run(run, zone)).collect(),
        refused_now: keeping.ready(entry).err().map(str::to_owned),
    };
    let clock = now_s.and_then(|now_s| zone.local(now_s));
    Schedules {
        zone: zone.name().to_owned(),
        zone_is_set: book.zone().is_some(),
        clock: clock.map(|local| format!("{}T{}", local.date(), time(local.time()))),
        quiet: book.quiet().map(quiet_hours),
        entries: plans.iter().map(entry).collect(),
        next: all
            .into_iter()
            .take(RUNS_MAX)
            .map(|run| planned_run(run, zone))
            .collect(),
        decisions: book.decisions().map(decision).collect(),
    }
}

fn planned_run(run: &Planned, zone: &Zone) -> PlannedRun {
    let kept = run.kept.map(|kept| match kept {
        Blocker::Skipped => "skipped",
        Blocker::QuietHours => "quiet-hours",
        Blocker::Elsewhere(reason) => reason,
    });
    let held = run.held.map(|held| match held {
        Held::QuietHours => "quiet-hours",
        Held::NoRobot => super::NO_ROBOT,
    });
    PlannedRun {
        entry: run.entry,
        at: zone.format_local(run.start_s),
        kept_by: kept.map(str::to_owned),
        held_by: held.map(str::to_owned),
    }
}

/// A decision in the words of clients; it is kept in the same words.
pub(super) fn decision(decision: &Decision) -> ScheduleDecision {
    let reason = match &decision.verdict.outcome {
        Outcome::Refused(reason) => Some(reason.clone()),
        _ => None,
    };
    ScheduleDecision {
        entry: decision.verdict.entry,
        name: decision.name.clone(),
        date: decision.verdict.date.to_string(),
        at: decision.at.clone(),
        outcome: decision.verdict.outcome.name().to_owned(),
        reason,
    }
}

pub(super) fn quiet_hours(quiet: Quiet) -> QuietHours {
    QuietHours {
        from: time(quiet.from()),
        to: time(quiet.to()),
    }
}

fn when(when: &When) -> ScheduleTime {
    match when {
        When::Weekly { days, at } => ScheduleTime::Weekly {
            days: Weekday::ALL
                .into_iter()
                .filter(|day| days.has(weekday(*day)))
                .collect(),
            at: time(*at),
        },
        When::Once { date, at } => ScheduleTime::Once {
            date: date.to_string(),
            at: time(*at),
        },
    }
}

fn time(time: Time) -> String {
    format!("{:02}:{:02}", time.hour(), time.minute())
}
