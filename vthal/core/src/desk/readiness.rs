//! What decides whether a job may start now.

use brain::{BehaviorState, JobCommand, JobRefusal, StrategyName};
use rvac_api::ScheduledJob;

use super::checkpoints::works;
use super::floors::FloorDesk;
use super::jobs::clean_command;
use crate::brain_session::BrainSession;
use crate::refusal::{Refusal, Refused};
use crate::schedule::{Entry, Keeping};

/// The robot is on another floor than the one for which an entry is.
const OTHER_FLOOR: &str = "other-floor";

/// What of it is known at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartFacts {
    /// Why no robot can be commanded.
    pub(crate) robot: Result<(), Refused>,
    /// Why a schedule may not command: everybody else comes before it (S27).
    pub(crate) schedule: Result<(), Refused>,
    /// Strategy of a job that names none.
    pub(crate) usual_strategy: StrategyName,
}

/// All of it, with what the brain and the floors say.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readiness<'a> {
    facts: StartFacts,
    brain_session: Option<&'a BrainSession>,
    pub(crate) floors: &'a FloorDesk,
}

impl<'a> Readiness<'a> {
    pub(crate) fn new(
        facts: StartFacts,
        brain_session: Option<&'a BrainSession>,
        floors: &'a FloorDesk,
    ) -> Self {
        Self {
            facts,
            brain_session,
            floors,
        }
    }

    /// The floor on which the robot is.
    pub(crate) fn floor(&self) -> Option<u16> {
        self.brain_session.and_then(BrainSession::floor)
    }

    /// # Errors
    /// There is no strategy of this name.
    pub(crate) fn strategy_named(&self, name: Option<&str>) -> Result<StrategyName, Refused> {
        match name {
            None => Ok(self.facts.usual_strategy),
            Some(name) => StrategyName::from_name(name).ok_or("unknown-strategy"),
        }
    }

    /// # Errors
    /// Why the brain would not obey.
    pub(crate) fn admit(&self, command: &JobCommand) -> Result<(), Refused> {
        let brain_session = self.brain_session.ok_or("no-robot")?;
        brain_session.admit(command).map_err(JobRefusal::name)
    }

    /// The command that starts the job of a schedule, because a person asks for it now.
    ///
    /// # Errors
    /// Why it may not start.
    pub(crate) fn command_now(&self, entry: &Entry) -> Result<JobCommand, Refusal> {
        self.facts.robot?;
        self.require_floor_of(entry)?;
        self.command_of(&entry.plan().job)
    }

    /// The command when a schedule starts its job now, if it may: everybody else comes before it (S27), and what
    /// keeps any motion from starting keeps it, too (S25).
    ///
    /// # Errors
    /// Why it may not start.
    pub(crate) fn scheduled_command(&self, entry: &Entry) -> Result<JobCommand, Refused> {
        self.facts.robot?;
        self.facts.schedule?;
        self.brain_session.map_or(Ok(()), leaves_room)?;
        self.require_floor_of(entry).map_err(|refusal| refusal.reason)?;
        let command = self
            .command_of(&entry.plan().job)
            .map_err(|refusal| refusal.reason)?;
        match self.brain_session {
            Some(brain_session) if brain_session.rests() => Ok(command),
            _ => Err("job-runs"),
        }
    }

    /// The command that starts a job; refused as the brain would refuse it.
    fn command_of(&self, job: &ScheduledJob) -> Result<JobCommand, Refusal> {
        match job {
            ScheduledJob::Start { strategy } => {
                let strategy = self.strategy_named(strategy.as_deref())?;
                let command = JobCommand::Clean { strategy };
                self.admit(&command)?;
                Ok(command)
            }
            ScheduledJob::Clean(order) => clean_command(order, self.brain_session),
        }
    }

    /// Whether the robot is on the floor of an entry.
    fn require_floor_of(&self, entry: &Entry) -> Result<(), Refusal> {
        match (entry.plan().floor, self.floor()) {
            (None, _) => Ok(()),
            (Some(_), None) => Err("map-not-taken-up".into()),
            (Some(floor), Some(here)) if floor == here => Ok(()),
            (Some(floor), Some(here)) => Err(self.on_other_floor(floor, here)),
        }
    }

    fn on_other_floor(&self, floor: u16, here: u16) -> Refusal {
        let title = |number| match self.floors.floors().get(number) {
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
}

/// # Errors
/// The job that runs or waits, by what the robot does about it: an owner does another thing about each.
fn leaves_room(brain_session: &BrainSession) -> Result<(), Refused> {
    let brain = brain_session.brain();
    match brain.status().state {
        BehaviorState::Docking => Err("drives-home"),
        BehaviorState::Docked if brain.waits_on_dock() => Err("recharging"),
        BehaviorState::Paused | BehaviorState::Stuck if brain.status().resumable => Err("job-paused"),
        // Of two entries that are due together the brain has not heard of the first one's job yet.
        _ if works(brain_session) || brain_session.awaits_job() => Err("job-runs"),
        _ => Ok(()),
    }
}

impl Keeping for Readiness<'_> {
    fn ready(&self, entry: &Entry) -> Result<(), &'static str> {
        self.scheduled_command(entry).map(drop)
    }

    fn on_floor(&self, entry: &Entry) -> Result<(), &'static str> {
        self.require_floor_of(entry).map_err(|refusal| refusal.reason)
    }
}
