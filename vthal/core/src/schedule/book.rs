//! All entries, and what people change about them.

use std::collections::VecDeque;

use jiff::civil::Date;

use super::marks::{Mark, Marks};
use super::{CLOCK_IS_SET_FROM_S, Entry, Outcome, Plan, Quiet, Verdict, WallClock, When, Zone};

/// Most entries: some for each room and each person.
const ENTRIES_MAX: usize = 32;
/// Decisions that are remembered for people.
const DECISIONS_MAX: usize = 50;

/// The schedules of a robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Book {
    pub(super) entries: Vec<Entry>,
    pub(super) quiet: Option<Quiet>,
    /// The zone that a person has set.
    pub(super) zone: Option<Zone>,
    /// Numbers up to this one were given to entries.
    pub(super) last_number: u32,
    /// The newest last.
    pub(super) decisions: VecDeque<Decision>,
}

/// What was decided, for people.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// What.
    pub verdict: Verdict,
    /// Name of the entry then.
    pub name: String,
    /// When, as people read it.
    pub at: String,
}

/// A change by a person.
#[derive(Clone, Debug, PartialEq)]
pub enum ScheduleEdit {
    /// One more entry.
    Add(Plan),
    /// Another plan for an entry.
    Change(u32, Plan),
    /// No such entry any more.
    Remove(u32),
    /// An entry starts by itself, or no longer.
    Enable(u32, bool),
    /// The next run is left out, or no longer.
    SkipNext(u32, bool),
    /// Quiet hours, or none.
    Quiet(Option<Quiet>),
    /// The time zone; `None` = the system's.
    Zone(Option<Zone>),
}

/// Why a change is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// There is none with this number.
    #[error("There is no schedule {number}: {}.", known(numbers))]
    Absent {
        /// What was asked for.
        number: u32,
        /// Those that there are.
        numbers: Vec<u32>,
    },
    /// There are as many as may be.
    #[error("There are {ENTRIES_MAX} schedules, and no more may be: remove one first.")]
    Full,
    /// A single run lies in the past.
    #[error("{0} is over in the robot's time zone: give a time that is to come.")]
    Past(String),
    /// The zone leaves that date out.
    #[error("There is no {0} in the robot's time zone: its clocks leave that date out.")]
    NoSuchDate(Date),
    /// The entry's run of this date was decided already.
    #[error(
        "Schedule {number} has had its run of {date}, and has one a day: add another schedule for that day."
    )]
    Decided {
        /// Number of the entry.
        number: u32,
        /// The date.
        date: Date,
    },
    /// Somebody else has changed the entry since the client has seen it.
    #[error("Schedule {number} was changed by somebody else meanwhile: look at it, then save again.")]
    ChangedMeanwhile {
        /// Number of the entry.
        number: u32,
    },
}

impl EditError {
    /// The reason's name for clients.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Absent { .. } => "no-such-schedule",
            Self::Full => "too-many-schedules",
            Self::Past(_) => "schedule-past",
            Self::NoSuchDate(_) => "schedule-wrong",
            Self::Decided { .. } => "schedule-decided",
            Self::ChangedMeanwhile { .. } => "changed-meanwhile",
        }
    }
}

fn known(numbers: &[u32]) -> String {
    if numbers.is_empty() {
        return "there are none yet".to_owned();
    }
    let numbers: Vec<String> = numbers.iter().map(u32::to_string).collect();
    format!("there are {}", numbers.join(", "))
}

impl Book {
    /// The entries, by their numbers.
    pub fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter()
    }

    /// The entry with this number.
    ///
    /// # Errors
    /// [`EditError::Absent`].
    pub fn entry(&self, number: u32) -> Result<&Entry, EditError> {
        let found = self.entries.iter().find(|entry| entry.number == number);
        found.ok_or_else(|| self.absent(number))
    }

    /// The quiet hours.
    #[must_use]
    pub fn quiet(&self) -> Option<Quiet> {
        self.quiet
    }

    /// The zone that a person has set.
    #[must_use]
    pub fn zone(&self) -> Option<&Zone> {
        self.zone.as_ref()
    }

    /// What was decided, the newest first.
    pub fn decisions(&self) -> impl Iterator<Item = &Decision> {
        self.decisions.iter().rev()
    }

    /// Applies a person's change at `now_s`, with a zone for books that name none.
    ///
    /// # Errors
    /// See [`EditError`]; then nothing is changed.
    pub fn edit(&mut self, edit: ScheduleEdit, clock: WallClock<'_>) -> Result<(), EditError> {
        let now_s = clock.now_s;
        match edit {
            ScheduleEdit::Add(plan) => self.add(plan, clock),
            ScheduleEdit::Change(number, plan) => self.change(number, plan, clock),
            ScheduleEdit::Remove(number) => {
                self.entry(number)?;
                self.entries.retain(|entry| entry.number != number);
                Ok(())
            }
            ScheduleEdit::Enable(number, enabled) => {
                let entry = self.entry_mut(number)?;
                if enabled && !entry.plan.enabled {
                    entry.since_s = now_s;
                }
                entry.plan.enabled = enabled;
                Ok(())
            }
            ScheduleEdit::SkipNext(number, skip) => {
                self.entry_mut(number)?.skip_next = skip;
                Ok(())
            }
            ScheduleEdit::Quiet(quiet) => {
                self.quiet = quiet;
                Ok(())
            }
            ScheduleEdit::Zone(zone) => {
                self.zone = zone;
                self.forget_before(now_s);
                Ok(())
            }
        }
    }

    fn add(&mut self, plan: Plan, clock: WallClock<'_>) -> Result<(), EditError> {
        if self.entries.len() >= ENTRIES_MAX {
            return Err(EditError::Full);
        }
        check_date(&plan, clock)?;
        self.last_number += 1;
        self.entries.push(Entry {
            number: self.last_number,
            plan,
            skip_next: false,
            since_s: clock.now_s,
            marks: Marks::default(),
        });
        Ok(())
    }

    fn change(&mut self, number: u32, plan: Plan, clock: WallClock<'_>) -> Result<(), EditError> {
        let entry = self.entry(number)?;
        if entry.plan.when == plan.when {
            let was_enabled = entry.plan.enabled;
            let entry = self.entry_mut(number)?;
            if plan.enabled && !was_enabled {
                entry.since_s = clock.now_s;
            }
            entry.plan = plan;
            return Ok(());
        }
        check_date(&plan, clock)?;
        if let When::Once { date, .. } = plan.when
            && entry.marks.get(date) == Some(Mark::Closed)
        {
            return Err(EditError::Decided { number, date });
        }
        let entry = self.entry_mut(number)?;
        entry.plan = plan;
        entry.since_s = clock.now_s;
        entry.skip_next = false;
        Ok(())
    }

    /// Runs that were due before `now_s` do not count.
    pub fn forget_before(&mut self, now_s: i64) {
        for entry in &mut self.entries {
            entry.since_s = now_s;
        }
    }

    /// The clock shows `now_s`. What was made at a later time was made by a clock that was wrong.
    pub fn meet(&mut self, now_s: i64) {
        for entry in &mut self.entries {
            entry.since_s = entry.since_s.min(now_s);
        }
    }

    /// Notes what was decided of a run, or what became of it later.
    pub fn note(&mut self, verdict: Verdict, clock: WallClock<'_>) {
        let Ok(entry) = self.entry_mut(verdict.entry) else {
            return;
        };
        entry.marks.set(verdict.date, verdict.outcome.mark());
        if verdict.outcome == Outcome::Skipped {
            entry.skip_next = false;
        }
        let name = entry.plan.name.clone();
        let is_same_run =
            |old: &Decision| old.verdict.entry == verdict.entry && old.verdict.date == verdict.date;
        self.decisions
            .retain(|old| !(is_same_run(old) && old.verdict.outcome == Outcome::Starting));
        self.decisions.push_back(Decision {
            verdict,
            name,
            at: clock.zone.format_local(clock.now_s),
        });
        while self.decisions.len() > DECISIONS_MAX {
            self.decisions.pop_front();
        }
    }

    /// After a start of the daemon: it is unknown whether the robot received the command for a run that was noted and not followed up.
    pub fn interrupt_starting(&mut self) {
        for decision in &mut self.decisions {
            if decision.verdict.outcome == Outcome::Starting {
                decision.verdict.outcome = Outcome::Interrupted;
            }
        }
    }

    fn entry_mut(&mut self, number: u32) -> Result<&mut Entry, EditError> {
        match self.entries.iter().position(|entry| entry.number == number) {
            Some(place) => Ok(&mut self.entries[place]),
            None => Err(self.absent(number)),
        }
    }

    fn absent(&self, number: u32) -> EditError {
        EditError::Absent {
            number,
            numbers: self.entries.iter().map(|entry| entry.number).collect(),
        }
    }
}

/// A single run must lie in the future, if the clock is set.
fn check_date(plan: &Plan, WallClock { zone, now_s }: WallClock<'_>) -> Result<(), EditError> {
    let When::Once { date, at } = plan.when else {
        return Ok(());
    };
    let due_s = zone.first_instant(date, at).ok_or(EditError::NoSuchDate(date))?;
    if now_s >= CLOCK_IS_SET_FROM_S && due_s < now_s {
        return Err(EditError::Past(zone.format_local(due_s)));
    }
    Ok(())
}
