//! Records of runs on their way to the disk, and what clients ask of them.

use std::collections::VecDeque;

use brain::action::Decision;
use brain::{Brain, Command, HomePart};
use rvac_api::{Evidence, LogLevel, RequestBody, RoomHere, Run, RunAsker, RunJob, RunRecord, Topic, Update};

use super::Core;
use super::refusal::Refusal;
use super::standstill::is_standstill;
use crate::history::{Asked, Moment};
use crate::journal::Part;
use crate::mind::Mind;
use crate::outputs::{Delivery, Recipients};
use crate::scheduler::Asker;
use crate::{Checkpoint, Outputs, Record, RunQuery, RunTask, cut_short};

/// Runs of a list that names no number, and of any list at most.
const COUNT: u8 = 20;
const COUNT_MAX: u8 = 50;
/// Records that wait for a disk that refuses them; then the oldest is lost.
const UNKEPT_MAX: usize = 16;
/// After the disk has refused a record it is tried again so much later.
const RETRY_US: u64 = 60_000_000;

/// Records that the disk does not have yet, oldest first.
#[derive(Debug, Default)]
pub(super) struct UnkeptRuns {
    waiting: VecDeque<RunRecord>,
    /// The first one is on its way.
    is_writing: bool,
    retry_us: u64,
    /// The disk has refused it before, which was told.
    is_complained: bool,
}

impl Core {
    /// A command that somebody gives to the brain: an order begins a run with the next step.
    pub(super) fn order_run(&mut self, by: RunAsker, command: &Command) {
        self.runs.commanded_by(by.clone());
        let brain = self.mind.as_ref().map(|mind| mind.brain());
        if let Some(job) = brain.and_then(|brain| ordered_job(command, brain)) {
            self.runs.asked(Asked { by, job }, brain);
        }
    }

    /// After a step of the brain.
    pub(super) fn follow_run(&mut self, now_us: u64, decisions: &[Decision], outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        let evidence = if decisions.iter().any(is_standstill) {
            self.evidence(now_us)
        } else {
            Evidence::default()
        };
        let step = self.runs.step(&Moment {
            now_us,
            brain: mind.brain(),
            charge: mind.observer.observation().battery_charge,
            decisions,
            evidence: &evidence,
            recorded: mind.recorded_run(),
            commands_wait: self.commands_wait,
        });
        if let Some(run) = step.done
            && self.records()
        {
            outputs.records.push(Record::Told {
                time_us: now_us,
                run: Box::new(run),
            });
        }
        self.keep_run(step.over, outputs);
        if now_us >= self.unkept.retry_us {
            self.write_run(outputs);
        }
    }

    /// The daemon ends, and a run with it.
    pub(super) fn shut_down_run(&mut self, now_us: u64, outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        let over = self.runs.shut_down(now_us, mind.brain());
        self.keep_run(over, outputs);
    }

    /// Goes on with the run of a checkpoint that the brain has taken up.
    pub(super) fn resume_run(&mut self, now_us: u64, checkpoint: Checkpoint, outputs: &mut Outputs) {
        let (Some(mind), Some(run)) = (&self.mind, checkpoint.run.clone()) else {
            return;
        };
        let was_over = self.runs.resume(now_us, *run, mind.brain()).is_some();
        if was_over {
            self.keep_run(cut_short(checkpoint), outputs);
        }
    }

    /// These runs are over: they go to the disk.
    pub(super) fn keep_run(&mut self, over: impl IntoIterator<Item = RunRecord>, outputs: &mut Outputs) {
        let floor = self.mind.as_ref().and_then(Mind::floor);
        for mut record in over {
            record.run.floor = record.run.floor.or(floor);
            if self.unkept.waiting.len() == UNKEPT_MAX {
                // The first one may be on its way.
                self.unkept.waiting.remove(1);
            }
            self.unkept.waiting.push_back(record);
        }
        self.write_run(outputs);
    }

    fn write_run(&mut self, outputs: &mut Outputs) {
        if self.unkept.is_writing {
            return;
        }
        if let Some(record) = self.unkept.waiting.front() {
            self.unkept.is_writing = true;
            outputs.run = Some(Box::new(record.clone()));
        }
    }

    /// The disk has the record of a run, or says why it has not.
    pub(super) fn run_kept(
        &mut self,
        now_us: u64,
        (number, result): (u64, Result<Box<Run>, String>),
        outputs: &mut Outputs,
    ) {
        let is_first = self
            .unkept
            .waiting
            .front()
            .is_some_and(|record| record.run.number == number);
        if !is_first || !self.unkept.is_writing {
            return;
        }
        self.unkept.is_writing = false;
        match result {
            Ok(run) => {
                self.unkept.waiting.pop_front();
                (self.unkept.is_complained, self.unkept.retry_us) = (false, 0);
                let text = format!("run {number} is kept: {}", run.text);
                self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
                if self.clients.any(Topic::Runs) {
                    outputs.deliveries.push(Delivery {
                        to: Recipients::Followers(Topic::Runs),
                        update: Update::RunKept(run),
                    });
                }
                self.write_run(outputs);
            }
            Err(text) => {
                self.unkept.retry_us = now_us + RETRY_US;
                if !core::mem::replace(&mut self.unkept.is_complained, true) {
                    self.log(now_us, (LogLevel::Error, Part::Vthal, text), outputs);
                }
            }
        }
    }

    /// A client asks for what is kept of runs.
    pub(super) fn ask_of_runs(
        &self,
        (client, id): Asker,
        body: &RequestBody,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let task = match *body {
            RequestBody::Runs { before, count } => RunTask::List {
                before,
                count: count.unwrap_or(COUNT).clamp(1, COUNT_MAX),
            },
            RequestBody::Run { number } => RunTask::Show(number),
            RequestBody::RunTrack { number, recording } => RunTask::Track { number, recording },
            RequestBody::RunFile {
                number,
                recording,
                from,
            } => RunTask::File {
                number,
                recording,
                from,
            },
            _ => return Ok(()),
        };
        outputs.run_queries.push(RunQuery { client, id, task });
        Ok(())
    }
}

/// The job that a command orders; `None` for commands that order none.
fn ordered_job(command: &Command, brain: &Brain) -> Option<RunJob> {
    match command {
        Command::Clean { strategy } => Some(RunJob::Clean {
            strategy: strategy.name().to_owned(),
            rooms: Vec::new(),
            zones: 0,
            spots: 0,
            passes: 1,
        }),
        Command::CleanParts { order } => {
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
        Command::Spot => Some(RunJob::Spot),
        Command::Dock => Some(RunJob::Dock),
        _ => None,
    }
}
