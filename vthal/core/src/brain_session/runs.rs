//! The borders of runs: what is recorded to one file.

use brain::{Brain, Checkpoint, Command, JobCommand, LoadedHome};

use super::BrainSession;
use crate::{Outputs, Record, Recording, RunCause, RunEnd, RunStart};

/// A run ends when the robot has rested for this long.
const REST_ENDS_RUN_US: u64 = 5_000_000;

#[derive(Clone, Copy, Debug)]
pub(super) struct RecordedRun {
    /// Since when the robot rests, if it does.
    resting_since_us: Option<u64>,
}

/// What a step gives: actions, and records if enabled.
pub(crate) struct Recorder<'a> {
    /// `None` = no recording.
    records: Option<&'a mut Vec<Record>>,
}

impl<'a> Recorder<'a> {
    /// Writes to these outputs if runs are recorded.
    pub(crate) fn new(recording: Recording, outputs: &'a mut Outputs) -> Self {
        Self {
            records: (recording == Recording::On).then_some(&mut outputs.records),
        }
    }

    pub(super) fn write(&mut self, record: impl FnOnce() -> Record) {
        if let Some(records) = &mut self.records {
            records.push(record());
        }
    }
}

impl BrainSession {
    pub(crate) fn is_recorded(&self) -> bool {
        self.run.is_some()
    }

    /// Number of the run that is recorded now.
    pub(crate) fn recorded_run(&self) -> Option<u32> {
        self.run.map(|_| self.runs)
    }

    pub(super) fn begins_run(&self, cause: RunCause) -> bool {
        let rests = self.rests() && self.waiting.is_empty();
        self.next.is_none() && (self.run.is_none() || (rests && cause == RunCause::Job))
    }

    /// On a floor that is not known the map is one of nowhere.
    pub(super) fn checkpoint_for_next_run(&self) -> Checkpoint {
        match self.floor {
            Some(_) => self.brain.checkpoint_for_next_run(),
            None => self.brain.checkpoint_without_home(),
        }
    }

    /// Takes up what a daemon before this one was doing, on this floor.
    pub(crate) fn resume(
        &mut self,
        now_us: u64,
        (checkpoint, floor): (Checkpoint, Option<u16>),
        recorder: &mut Recorder<'_>,
    ) {
        self.floor = floor;
        let checkpoint = checkpoint.after(self.brain.learnt());
        self.begin_run(
            now_us,
            (RunCause::ResumedAfterRestart, checkpoint, None),
            recorder,
        );
    }

    pub(super) fn begin_run(
        &mut self,
        now_us: u64,
        (cause, checkpoint, ready): (RunCause, Checkpoint, Option<LoadedHome>),
        recorder: &mut Recorder<'_>,
    ) {
        self.map_base = self.map_number();
        self.runs += 1;
        // Any odd multiplier gives each run a seed of its own; this one is the golden ratio's.
        let seed = self.seed ^ u64::from(self.runs).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.replace(Brain::new(self.config, seed));
        match ready {
            Some(home) => self.brain.restore_at(home, &checkpoint),
            None => self.brain.restore(&checkpoint),
        }
        // A daemon that starts while nothing is to be done has nothing to record.
        if cause == RunCause::ResumedAfterRestart && checkpoint.job.is_none() {
            return;
        }
        self.run = Some(RecordedRun {
            resting_since_us: None,
        });
        recorder.write(|| {
            Record::RunStarted(Box::new(RunStart {
                time_us: now_us,
                run: self.runs,
                cause,
                seed,
                brain: self.config,
                checkpoint,
                device: self.identity.0.clone(),
                firmware: self.identity.1.clone(),
                robot: self.robot.clone(),
            }))
        });
        // What this step says was said by the brain before.
        if matches!(cause, RunCause::Job | RunCause::Manual) {
            self.step_once(&[], recorder);
        }
    }

    pub(super) fn watch_rest(&mut self, recorder: &mut Recorder<'_>) {
        let now_us = self.observer.observation().time_us;
        let rests = self.rests();
        let Some(run) = &mut self.run else { return };
        match (rests, run.resting_since_us) {
            (false, _) => run.resting_since_us = None,
            (true, None) => run.resting_since_us = Some(now_us),
            (true, Some(since_us)) if now_us >= since_us + REST_ENDS_RUN_US => {
                self.end_run(now_us, RunEnd::Finished, recorder);
            }
            (true, Some(_)) => {}
        }
    }

    /// Closes the running recording, if there is one.
    pub(crate) fn end_run(&mut self, now_us: u64, end: RunEnd, recorder: &mut Recorder<'_>) {
        if self.run.take().is_some() {
            recorder.write(|| Record::RunEnded { time_us: now_us, end });
        }
    }
}

/// Why a run begins with a command; `None` for a command that begins none.
pub(super) fn cause_of(command: &Command) -> Option<RunCause> {
    match command {
        Command::Edit(_) => None,
        Command::Job(command) => match command {
            JobCommand::Clean { .. }
            | JobCommand::CleanParts { .. }
            | JobCommand::Spot
            | JobCommand::GoTo { .. }
            | JobCommand::Dock => Some(RunCause::Job),
            JobCommand::Manual { .. } => Some(RunCause::Manual),
            JobCommand::Pause
            | JobCommand::Resume
            | JobCommand::Stop
            | JobCommand::ManualEnd
            | JobCommand::ClearError => None,
        },
    }
}
