//! Schedules: what people want of them, what the clock wants, and what the robot says to that.

use brain::Command;
use rvac_api::{LogLevel, RequestBody, RunAsker, ScheduledJob, Schedules, Topic, Update};

use super::awaited::answer;
use super::checkpoints::works;
use super::places::with_any_places;
use super::refusal::Refusal;
use super::requests::denied;
use super::{Core, orders};
use crate::arbiter::Source;
use crate::journal::Part;
use crate::outputs::{Delivery, Recipients};
use crate::schedule::{Edit, Entry, Keeping, Outcome, Plan, ScheduleError, Verdict};
use crate::scheduler::{Asker, Task};
use crate::{ClientId, Outputs};

/// What the robot could start changes without a word; followers hear of it within this time.
const TOLD_US: u64 = 5_000_000;
/// The robot is on another floor than the one for which an entry is.
const OTHER_FLOOR: &str = "other-floor";

impl Keeping for Core {
    fn ready(&self, entry: &Entry) -> Result<(), &'static str> {
        self.could_start(entry)
    }

    fn on_floor(&self, entry: &Entry) -> Result<(), &'static str> {
        self.on_floor_of(entry).map_err(|refusal| refusal.reason)
    }
}

impl From<ScheduleError> for Refusal {
    fn from(error: ScheduleError) -> Self {
        Self {
            reason: error.name(),
            text: error.to_string(),
        }
    }
}

impl Core {
    /// All schedules, and what is to be expected of them.
    #[must_use]
    pub fn schedules(&self) -> Schedules {
        self.scheduler.view(self)
    }

    /// The clock on the wall shows this.
    pub(super) fn set_clock(&mut self, now_us: u64, utc_s: i64, outputs: &mut Outputs) {
        self.scheduler.set_clock(utc_s);
        self.runs.set_clock(now_us, utc_s);
        self.run_schedules(now_us, outputs);
        if self.clients.any(Topic::Schedules) && now_us >= self.schedules_told_us + TOLD_US {
            self.tell_schedules(now_us, outputs);
        }
    }

    /// A client wants schedules changed. It is answered when the disk has the change.
    pub(super) fn change_schedules(
        &mut self,
        now_us: u64,
        (asker, body): (Asker, RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let edit = match body {
            RequestBody::AddSchedule(entry) => Edit::Add(self.plan(Plan::from_api(entry)?)?),
            RequestBody::ChangeSchedule { number, entry } => {
                Edit::Change(number, self.plan(Plan::from_api(entry)?)?)
            }
            RequestBody::RemoveSchedule { number } => Edit::Remove(number),
            RequestBody::EnableSchedule { number, enabled } => Edit::Enable(number, enabled),
            RequestBody::SkipNext { number, skip } => Edit::SkipNext(number, skip),
            RequestBody::SetQuiet { quiet } => Edit::quiet_from_api(quiet.as_ref())?,
            RequestBody::SetZone { zone } => Edit::zone_from_api(zone.as_deref())?,
            _ => return Ok(()),
        };
        if !self.scheduler.take(asker, edit) {
            return Err("disk-busy".into());
        }
        self.run_schedules(now_us, outputs);
        Ok(())
    }

    /// What a job says must make sense at once; whether its rooms are there is asked when it starts.
    fn plan(&self, plan: Plan) -> Result<Plan, Refusal> {
        match &plan.job {
            ScheduledJob::Start { strategy } => {
                self.strategy_named(strategy.as_deref())?;
            }
            ScheduledJob::Clean(order) => {
                orders::to_order(&with_any_places(order))?;
            }
        }
        let floor = self.floor_of(&plan)?;
        Ok(Plan { floor, ..plan })
    }

    /// The floor for which a plan is: as it says, or, if it names places, the one on which the robot is. Of one floor alone
    /// nobody need say it.
    fn floor_of(&self, plan: &Plan) -> Result<Option<u16>, Refusal> {
        if let Some(number) = plan.floor {
            return Ok(Some(self.floor_named(number)?.number));
        }
        if !plan.job.names_places() {
            return Ok(None);
        }
        let only = Some(self.floors.first()).filter(|_| self.floors.present().nth(1).is_none());
        match self.floor().or(only) {
            Some(number) => Ok(Some(number)),
            None => Err("floor-unknown".into()),
        }
    }

    /// Whether the robot is on the floor of an entry.
    fn on_floor_of(&self, entry: &Entry) -> Result<(), Refusal> {
        match (entry.plan().floor, self.floor()) {
            (None, _) => Ok(()),
            (Some(_), None) => Err("map-not-taken-up".into()),
            (Some(floor), Some(here)) if floor == here => Ok(()),
            (Some(floor), Some(here)) => Err(self.on_other_floor((floor, here))),
        }
    }

    fn on_other_floor(&self, (floor, here): (u16, u16)) -> Refusal {
        let title = |number| match self.floors.get(number) {
            Some(floor) => floor.title(),
            None => format!("floor {number}, which is not there any more"),
        };
        Refusal {
            reason: OTHER_FLOOR,
            text: format!(
                "The schedule is for {}, and the robot is on {}: carry it there, or choose rooms of this floor.",
                title(floor),
                title(here)
            ),
        }
    }

    /// Starts what a schedule starts, because a person wants it now.
    pub(super) fn run_schedule(
        &mut self,
        now_us: u64,
        (client, number): (ClientId, u32),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let entry = self.scheduler.book().entry(number).map_err(ScheduleError::from)?;
        self.require_robot()?;
        self.on_floor_of(entry)?;
        let command = self.command_of(&entry.plan().job)?;
        Ok(self.job(now_us, (client, command), outputs)?)
    }

    /// The disk has the schedules that it was given under this number, or says why it has not.
    pub(super) fn schedules_kept(
        &mut self,
        now_us: u64,
        (number, result): (u64, Result<(), String>),
        outputs: &mut Outputs,
    ) {
        if let Some(task) = self.scheduler.kept(number, result) {
            self.do_task(now_us, task, outputs);
        }
        self.tell_schedules(now_us, outputs);
        self.run_schedules(now_us, outputs);
    }

    fn run_schedules(&mut self, now_us: u64, outputs: &mut Outputs) {
        if self.ended {
            return;
        }
        loop {
            let task = match self.scheduler.next_change() {
                Some(task) => task,
                None => match self.scheduler.due(|entry| self.could_start(entry)) {
                    Some(verdict) => self.scheduler.decide(verdict),
                    None => return,
                },
            };
            self.do_task(now_us, task, outputs);
        }
    }

    fn do_task(&mut self, now_us: u64, task: Task, outputs: &mut Outputs) {
        let (asker, failure) = match task {
            Task::Keep(order) => {
                outputs.schedules = Some(order);
                return;
            }
            Task::Decided(verdict) => return self.decided(now_us, &verdict, outputs),
            Task::Undecided(text) => {
                let line = format!("{text} Nothing starts by itself until it can.");
                return self.log(now_us, (LogLevel::Error, Part::Vthal, line), outputs);
            }
            Task::Done(asker) => (asker, None),
            Task::Refused(asker, error) => (asker, Some((error.name(), error.to_string()))),
            Task::Unkept(asker, text) => (asker, Some(("schedules-unwritable", text))),
        };
        answer(asker, failure, outputs);
    }

    /// A decision about a run is on the disk: now the robot may hear of it.
    fn decided(&mut self, now_us: u64, verdict: &Verdict, outputs: &mut Outputs) {
        let Ok(entry) = self.scheduler.book().entry(verdict.entry).cloned() else {
            return;
        };
        let mut outcome = verdict.outcome.clone();
        if outcome == Outcome::Starting {
            outcome = match self.start_scheduled(now_us, &entry, outputs) {
                Ok(()) => Outcome::Fired,
                Err(reason) => Outcome::Refused(reason.to_owned()),
            };
            let task = self.scheduler.follow_up(verdict, outcome.clone());
            self.do_task(now_us, task, outputs);
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
        self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
    }

    fn start_scheduled(
        &mut self,
        now_us: u64,
        entry: &Entry,
        outputs: &mut Outputs,
    ) -> Result<(), &'static str> {
        let command = self.scheduled_command(entry)?;
        let (number, name) = (entry.number(), entry.plan().name.clone());
        self.order_run(RunAsker::Schedule { number, name }, &command);
        self.command_brain(now_us, command, outputs);
        Ok(())
    }

    /// Whether a schedule may start its job now.
    fn could_start(&self, entry: &Entry) -> Result<(), &'static str> {
        self.scheduled_command(entry).map(drop)
    }

    /// What the brain is told when a schedule starts its job now, if it may: everybody else comes before it (S27), and what
    /// keeps any motion from starting keeps it, too (S25).
    fn scheduled_command(&self, entry: &Entry) -> Result<Command, &'static str> {
        self.require_robot()?;
        self.arbiter.admit_now(Source::Schedule).map_err(denied)?;
        if self.mind.as_ref().is_some_and(works) {
            return Err("job-runs");
        }
        self.on_floor_of(entry).map_err(|refusal| refusal.reason)?;
        let command = self
            .command_of(&entry.plan().job)
            .map_err(|refusal| refusal.reason)?;
        match &self.mind {
            Some(mind) if mind.rests() => Ok(command),
            _ => Err("job-runs"),
        }
    }

    /// What the brain is told to start a job; refused as the brain would refuse it.
    fn command_of(&self, job: &ScheduledJob) -> Result<Command, Refusal> {
        match job {
            ScheduledJob::Start { strategy } => {
                let strategy = self.strategy_named(strategy.as_deref())?;
                let command = Command::Clean { strategy };
                self.admitted(&command)?;
                Ok(command)
            }
            ScheduledJob::Clean(order) => self.clean_command(order),
        }
    }

    fn tell_schedules(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.schedules_told_us = now_us;
        if !self.clients.any(Topic::Schedules) {
            return;
        }
        let schedules = self.schedules();
        if self.schedules_told.as_ref() != Some(&schedules) {
            self.schedules_told = Some(schedules.clone());
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Schedules),
                update: Update::Schedules(schedules),
            });
        }
    }
}
