//! Schedules: changes by people, runs that are due, and the robot's answers.

use rvac_api::{LogLevel, ScheduleEntry, ScheduledJob, Schedules, Topic, Update};

use super::audience::{Asking, Teller};
use super::home::with_any_places;
use super::journal::LogSource;
use super::readiness::Readiness;
use super::reply::Reply;
use super::scheduler::{Scheduler, Task};
use super::words::to_order;
use crate::refusal::Refusal;
use crate::schedule::{Book, EditError, Entry, Outcome, Plan, ScheduleEdit, ScheduleError, Verdict, Zone};

/// Readiness changes without an event; followers receive it within this time.
const SEND_PERIOD_US: u64 = 5_000_000;

/// Changes of the schedules by clients.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ScheduleRequest {
    /// A new one.
    Add(ScheduleEntry),
    /// Another one in its place, if it still is what it was when the change began.
    Change {
        number: u32,
        entry: ScheduleEntry,
        was: Option<Box<ScheduleEntry>>,
    },
    /// What needs no look at the home.
    Edit(ScheduleEdit),
}

impl From<ScheduleError> for Refusal {
    fn from(error: ScheduleError) -> Self {
        Self {
            reason: error.name(),
            text: error.to_string(),
        }
    }
}

/// What came of a decision about a run.
pub(crate) struct Decided<'a> {
    pub(crate) verdict: &'a Verdict,
    pub(crate) entry: &'a Entry,
    pub(crate) outcome: Outcome,
}

/// The schedules, and what followers have received of them.
#[derive(Debug)]
pub(crate) struct ScheduleDesk {
    scheduler: Scheduler,
    sent: Option<Schedules>,
    sent_us: u64,
    /// The daemon ends: nothing starts any more.
    ended: bool,
}

impl ScheduleDesk {
    /// With schedules as they were kept; of marks that are distrusted the newest may be lost.
    pub(crate) fn new(book: Book, distrusts_marks: bool) -> Self {
        Self {
            scheduler: Scheduler::new(book, distrusts_marks),
            sent: None,
            sent_us: 0,
            ended: false,
        }
    }

    /// All schedules, and what is to be expected of them.
    pub(crate) fn view(&self, readiness: &Readiness<'_>) -> Schedules {
        self.scheduler.view(readiness)
    }

    /// What the clock on the wall shows, if it was ever set.
    pub(crate) fn clock_s(&self) -> Option<i64> {
        self.scheduler.set_clock_s()
    }

    /// Schedules that have no zone of their own follow this one; if that is a `change`, what was due before it is not made up for.
    /// Gives the name of the zone before.
    pub(crate) fn set_system_zone(&mut self, zone: Zone, change: bool) -> String {
        self.scheduler.set_system_zone(zone, change)
    }

    /// Name of the zone that a person has set with the schedules.
    pub(crate) fn own_zone(&self) -> Option<&str> {
        self.scheduler.book().zone().map(Zone::name)
    }

    /// Name of the zone that schedules are in.
    pub(crate) fn zone_name(&self) -> &str {
        self.scheduler.zone().name()
    }

    /// The daemon ends.
    pub(crate) fn end(&mut self) {
        self.ended = true;
    }

    /// The clock on the wall shows this.
    pub(crate) fn set_clock(&mut self, utc_s: i64, readiness: &Readiness<'_>, teller: &mut Teller<'_>) {
        self.scheduler.set_clock(utc_s);
        self.run(readiness, teller);
        if teller.has_followers(Topic::Schedules) && teller.now_us >= self.sent_us + SEND_PERIOD_US {
            self.tell(readiness, teller);
        }
    }

    /// Takes a client's change of schedules. The client is answered when the disk has the change.
    ///
    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: Asking<ScheduleRequest>,
        readiness: &Readiness<'_>,
        teller: &mut Teller<'_>,
    ) -> Result<Reply, Refusal> {
        let edit = match request {
            ScheduleRequest::Add(entry) => ScheduleEdit::Add(plan(Plan::from_api(entry)?, readiness)?),
            ScheduleRequest::Change { number, entry, was } => {
                self.is_unchanged(number, was.as_deref())?;
                ScheduleEdit::Change(number, plan(Plan::from_api(entry)?, readiness)?)
            }
            ScheduleRequest::Edit(edit) => edit,
        };
        if !self.scheduler.take(asker, edit) {
            return Err("disk-busy".into());
        }
        self.run(readiness, teller);
        Ok(Reply::WhenKept)
    }

    /// The entry still is what a client has seen of it.
    fn is_unchanged(&self, number: u32, was: Option<&ScheduleEntry>) -> Result<(), Refusal> {
        let Some(was) = was else { return Ok(()) };
        if self.entry(number)?.plan().to_api() == *was {
            return Ok(());
        }
        Err(ScheduleError::from(EditError::ChangedMeanwhile { number }).into())
    }

    /// The entry of this number.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn entry(&self, number: u32) -> Result<&Entry, Refusal> {
        Ok(self.scheduler.book().entry(number).map_err(ScheduleError::from)?)
    }

    /// The disk has the schedules that it was given under this number, or says why it has not. Gives a decision about a run, of
    /// which the robot may receive now.
    pub(crate) fn kept(
        &mut self,
        number: u64,
        result: Result<(), String>,
        teller: &mut Teller<'_>,
    ) -> Option<Verdict> {
        match self.scheduler.kept(number, result)? {
            Task::Decided(verdict) => Some(verdict),
            task => {
                do_task(task, teller);
                None
            }
        }
    }

    /// A run that was decided upon has this outcome.
    pub(crate) fn note(&mut self, decided: Decided<'_>, teller: &mut Teller<'_>) {
        let Decided {
            verdict,
            entry,
            outcome,
        } = decided;
        if verdict.outcome == Outcome::Starting {
            do_task(self.scheduler.follow_up(verdict, outcome.clone()), teller);
        }
        let why = match &outcome {
            Outcome::Refused(reason) => format!(" ({reason})"),
            _ => String::new(),
        };
        let name = &entry.plan().name;
        let text = format!(
            "schedule {} ({name}) of {}: {}{why}",
            verdict.entry,
            verdict.date,
            outcome.name()
        );
        teller.log(LogLevel::Info, LogSource::Vthal, text);
    }

    /// The disk is free again.
    pub(crate) fn go_on(&mut self, readiness: &Readiness<'_>, teller: &mut Teller<'_>) {
        self.tell(readiness, teller);
        self.run(readiness, teller);
    }

    fn run(&mut self, readiness: &Readiness<'_>, teller: &mut Teller<'_>) {
        if self.ended {
            return;
        }
        loop {
            let task = match self.scheduler.next_change() {
                Some(task) => task,
                None => match self
                    .scheduler
                    .due(|entry| readiness.scheduled_command(entry).map(drop))
                {
                    Some(verdict) => self.scheduler.decide(verdict),
                    None => return,
                },
            };
            do_task(task, teller);
        }
    }

    /// Sends followers what has changed.
    pub(super) fn tell(&mut self, readiness: &Readiness<'_>, teller: &mut Teller<'_>) {
        self.sent_us = teller.now_us;
        if !teller.has_followers(Topic::Schedules) {
            return;
        }
        let schedules = self.view(readiness);
        if self.sent.as_ref() != Some(&schedules) {
            self.sent = Some(schedules.clone());
            teller.tell(Topic::Schedules, Update::Schedules(schedules));
        }
    }
}

/// Hands a task to the disk, or sends the result to the client that waits for it.
fn do_task(task: Task, teller: &mut Teller<'_>) {
    let (asker, answer) = match task {
        Task::Keep(order) => {
            teller.outputs.schedules = Some(order);
            return;
        }
        Task::Undecided(text) => {
            let line = format!("{text} Nothing starts by itself until it can.");
            return teller.log(LogLevel::Error, LogSource::Vthal, line);
        }
        // Only the disk's word brings one.
        Task::Decided(_) => return,
        Task::Done(asker) => (asker, Ok(Reply::Done)),
        Task::Refused(asker, error) => (asker, Err((error.name(), error.to_string()))),
        Task::Unkept(asker, text) => (asker, Err(("schedules-unwritable", text))),
    };
    teller.answer(asker, answer.map_err(|(reason, text)| Refusal { reason, text }));
}

/// What a job says must make sense at once; whether its rooms are there is asked when it starts.
fn plan(plan: Plan, readiness: &Readiness<'_>) -> Result<Plan, Refusal> {
    match &plan.job {
        ScheduledJob::Start { strategy } => {
            readiness.strategy_named(strategy.as_deref())?;
        }
        ScheduledJob::Clean(order) => {
            to_order(&with_any_places(order))?;
        }
    }
    let floor = floor_of(&plan, readiness)?;
    Ok(Plan { floor, ..plan })
}

/// The floor for which a plan is: as it says, or, if it names places, the one on which the robot is. Of one floor alone nobody
/// need say it.
fn floor_of(plan: &Plan, readiness: &Readiness<'_>) -> Result<Option<u16>, Refusal> {
    if let Some(number) = plan.floor {
        return Ok(Some(readiness.floors.named(number)?.number));
    }
    if !plan.job.names_places() {
        return Ok(None);
    }
    let floors = readiness.floors.floors();
    let only = Some(floors.first()).filter(|_| floors.present().nth(1).is_none());
    match readiness.floor().or(only) {
        Some(number) => Ok(Some(number)),
        None => Err("floor-unknown".into()),
    }
}
