//! Records of runs until they are on the disk, and requests of clients about them.

use std::collections::VecDeque;

use brain::{Brain, HomePart, JobCommand};
use rvac_api::{LogLevel, RoomHere, Run, RunAsker, RunJob, RunRecord, Topic, Update};

use super::audience::{Asker, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use crate::history::{Asked, BrainAtHome, Moment, RunFollower};
use crate::refusal::Refusal;
use crate::{Checkpoint, Outputs, Record, RunQuery, RunTask, cut_short};

/// Name of the line that says by how much the clock on the wall was set.
const CLOCK_SET: &str = "clock-set";
/// Runs of a list that names no number, and of any list at most.
const COUNT: u8 = 20;
const COUNT_MAX: u8 = 50;
/// Records that wait for a disk that refuses them; then the oldest is lost.
const UNKEPT_MAX: usize = 16;
/// After the disk has refused a record it is tried again so much later.
const RETRY_US: u64 = 60_000_000;

/// Records that the disk does not have yet, oldest first.
#[derive(Debug, Default)]
struct UnkeptRuns {
    waiting: VecDeque<RunRecord>,
    /// The first one is being written.
    is_writing: bool,
    retry_us: u64,
    /// The disk has refused it before, which was reported.
    is_complained: bool,
}

/// The run that goes on, and the records of those that the disk does not have yet.
#[derive(Debug)]
pub(crate) struct HistoryDesk {
    follower: RunFollower,
    unkept: UnkeptRuns,
}

impl HistoryDesk {
    pub(crate) fn new(next_run: u64) -> Self {
        Self {
            follower: RunFollower::new(next_run),
            unkept: UnkeptRuns::default(),
        }
    }

    /// The clock on the wall shows this.
    pub(crate) fn set_clock(&mut self, utc_s: i64, teller: &mut Teller<'_>) {
        let Some(by_s) = self.follower.set_clock(teller.now_us, utc_s) else {
            return;
        };
        let (minutes, seconds) = (by_s.unsigned_abs() / 60, by_s.unsigned_abs() % 60);
        let direction = if by_s < 0 { "back" } else { "forward" };
        let text = format!("the clock was set {direction} by {minutes} min {seconds} s ({CLOCK_SET})");
        teller.log(LogLevel::Info, LogSource::Vthal, text);
    }

    /// A recording has this name.
    pub(crate) fn recorded_as(&mut self, run: u32, name: String) {
        self.follower.recorded_as(run, name);
    }

    /// The record of the run that goes on, as far as it is known.
    pub(crate) fn so_far(&self, now_us: u64) -> Option<RunRecord> {
        self.follower.so_far(now_us)
    }

    /// Somebody commands, for the next step.
    pub(crate) fn commanded_by(&mut self, by: RunAsker) {
        self.follower.commanded_by(by);
    }

    /// A command to the brain: an order begins a run with the next step.
    pub(crate) fn order(&mut self, by: RunAsker, command: &JobCommand, at_home: Option<BrainAtHome<'_>>) {
        self.follower.commanded_by(by.clone());
        if let Some(job) = at_home.and_then(|at_home| ordered_job(command, at_home.brain)) {
            self.follower.asked(Asked { by, job }, at_home);
        }
    }

    /// After a step of the brain, on this floor.
    pub(crate) fn follow(&mut self, moment: &Moment<'_>, floor: Option<u16>, teller: &mut Teller<'_>) {
        let step = self.follower.step(moment);
        if let Some(run) = step.done {
            teller.record(|| Record::RunSummary {
                time_us: moment.now_us,
                run: Box::new(run),
            });
        }
        self.keep(step.over, floor, teller.outputs);
        if teller.now_us >= self.unkept.retry_us {
            self.write(teller.outputs);
        }
    }

    /// The daemon ends, and a run with it.
    pub(crate) fn shut_down(&mut self, now_us: u64, at_home: BrainAtHome<'_>) -> Option<RunRecord> {
        self.follower.shut_down(now_us, at_home)
    }

    /// Another robot was attached, and a run of the one before is over.
    pub(crate) fn change_robot(&mut self, now_us: u64, at_home: BrainAtHome<'_>) -> Option<RunRecord> {
        self.follower.change_robot(now_us, at_home)
    }

    /// Goes on with the run of a checkpoint that the brain has loaded; gives it back if it was over.
    pub(crate) fn resume(&mut self, now_us: u64, checkpoint: Checkpoint, brain: &Brain) -> Option<RunRecord> {
        let run = checkpoint.run.clone()?;
        let was_over = self.follower.resume(now_us, *run, brain).is_some();
        if was_over { cut_short(checkpoint) } else { None }
    }

    /// These runs are over, on this floor unless they say otherwise: they go to the disk.
    pub(crate) fn keep(
        &mut self,
        over: impl IntoIterator<Item = RunRecord>,
        floor: Option<u16>,
        outputs: &mut Outputs,
    ) {
        for mut record in over {
            record.run.floor = record.run.floor.or(floor);
            if self.unkept.waiting.len() == UNKEPT_MAX {
                // The first one may be in writing.
                self.unkept.waiting.remove(1);
            }
            self.unkept.waiting.push_back(record);
        }
        self.write(outputs);
    }

    fn write(&mut self, outputs: &mut Outputs) {
        if self.unkept.is_writing {
            return;
        }
        if let Some(record) = self.unkept.waiting.front() {
            self.unkept.is_writing = true;
            outputs.run = Some(Box::new(record.clone()));
        }
    }

    /// The disk has the record of a run, or says why it has not.
    pub(crate) fn kept(&mut self, number: u64, result: Result<Box<Run>, String>, teller: &mut Teller<'_>) {
        let first = self.unkept.waiting.front();
        let is_first = first.is_some_and(|record| record.run.number == number);
        if !is_first || !self.unkept.is_writing {
            return;
        }
        self.unkept.is_writing = false;
        match result {
            Ok(run) => {
                self.unkept.waiting.pop_front();
                (self.unkept.is_complained, self.unkept.retry_us) = (false, 0);
                let text = format!("run {number} is kept: {}", run.text);
                teller.log(LogLevel::Info, LogSource::Vthal, text);
                if teller.has_followers(Topic::Runs) {
                    teller.tell(Topic::Runs, Update::RunKept(run));
                }
                self.write(teller.outputs);
            }
            Err(text) => {
                self.unkept.retry_us = teller.now_us + RETRY_US;
                if !core::mem::replace(&mut self.unkept.is_complained, true) {
                    teller.log(LogLevel::Error, LogSource::Vthal, text);
                }
            }
        }
    }
}

/// The length of a list of runs for a client that asks for this one.
///
/// # Errors
/// There is no such list.
pub(crate) fn list_length(asked: Option<u8>) -> Result<u8, Refusal> {
    let count = asked.unwrap_or(COUNT);
    if (1..=COUNT_MAX).contains(&count) {
        return Ok(count);
    }
    Err(Refusal {
        reason: "range",
        text: format!("A list of {count} runs was asked for: it has 1 to {COUNT_MAX}."),
    })
}

/// A client asks for what is kept of runs: the shell reads it.
pub(crate) fn ask(asker: Asker, task: RunTask, outputs: &mut Outputs) -> Reply {
    let Asker { client, id } = asker;
    outputs.run_queries.push(RunQuery { client, id, task });
    Reply::ByShell
}

/// The job that a command orders; `None` for commands that order none.
fn ordered_job(command: &JobCommand, brain: &Brain) -> Option<RunJob> {
    match command {
        JobCommand::Clean { strategy } => Some(RunJob::Clean {
            strategy: strategy.name().to_owned(),
            rooms: Vec::new(),
            zones: 0,
            spots: 0,
            passes: 1,
        }),
        JobCommand::CleanParts { order } => {
            let names = brain.map().annotations();
            let room = |part: &HomePart| match part {
                HomePart::Room(id) => Some(RoomHere {
                    id: *id,
                    name: names.name(*id).map(|name| name.as_str().to_owned()),
                }),
                HomePart::Zone(_) | HomePart::Spot(_) => None,
            };
            let count = |is_it: fn(&HomePart) -> bool| {
                let parts = order.parts().iter().filter(|part| is_it(part));
                u32::try_from(parts.count()).unwrap_or(u32::MAX)
            };
            let rooms: Vec<RoomHere> = order.parts().iter().filter_map(room).collect();
            Some(RunJob::Clean {
                strategy: brain::StrategyName::Systematic.name().to_owned(),
                zones: count(|part| matches!(part, HomePart::Zone(_))),
                spots: count(|part| matches!(part, HomePart::Spot(_))),
                rooms,
                passes: order.passes(),
            })
        }
        JobCommand::Spot => Some(RunJob::Spot),
        JobCommand::GoTo { .. } => Some(RunJob::GoTo),
        JobCommand::Dock => Some(RunJob::Dock),
        JobCommand::Pause
        | JobCommand::Resume
        | JobCommand::Stop
        | JobCommand::Manual { .. }
        | JobCommand::ManualEnd
        | JobCommand::ClearError => None,
    }
}
