//! Looks at each step of the brain and makes records of runs.

use brain::{BehaviorState, Brain, Decision, DecisionCause, DecisionKind, JobKind, Reason};
use rvac_api::{Evidence, RunAsker, RunJob, RunRecord, RunResult};

use super::ending::Ending;
use super::open_run::OpenRun;
use super::picture::{BrainAtHome, Painter};
use crate::schedule::{CLOCK_IS_SET_FROM_S, CLOCK_WAS_SET_S};

/// A run whose job is gone is over after this time: a robot that slips off its dock takes the job up again.
const OVER_US: u64 = 5_000_000;

/// An order that the brain was just given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Asked {
    pub(crate) by: RunAsker,
    pub(crate) job: RunJob,
}

/// A step of the brain.
pub(crate) struct Moment<'a> {
    pub(crate) now_us: u64,
    pub(crate) brain: &'a Brain,
    pub(crate) home_revision: u32,
    pub(crate) charge: Option<f32>,
    pub(crate) decisions: &'a [Decision],
    /// What its sensors reported and what it tried, if it stopped by itself.
    pub(crate) evidence: &'a Evidence,
    /// Number of the recording that goes on.
    pub(crate) recorded: Option<u32>,
    /// What was commanded is not carried out yet: the run's home is made ready first.
    pub(crate) commands_wait: bool,
}

impl Moment<'_> {
    fn at_home(&self) -> BrainAtHome<'_> {
        BrainAtHome {
            brain: self.brain,
            home_revision: self.home_revision,
        }
    }
}

/// What a step brought.
#[derive(Debug, Default)]
pub(crate) struct Step {
    /// Runs that are over.
    pub(crate) over: Vec<RunRecord>,
    /// A run whose job is gone since this step, for its recording.
    pub(crate) done: Option<RunRecord>,
}

/// Makes the records.
#[derive(Debug)]
pub(crate) struct RunFollower {
    next_number: u64,
    /// A reading of the wall clock when it was set: host time and seconds since 1970.
    wall: Option<(u64, i64)>,
    /// Runs that were ordered since the last step, each in place of the one before.
    asked: Vec<Asked>,
    /// Whoever has commanded since the last step.
    hand: Option<RunAsker>,
    /// The newest recording: its number and its name.
    recording: Option<(u32, String)>,
    open: Option<OpenRun>,
    painter: Painter,
}

impl RunFollower {
    pub(crate) fn new(next_number: u64) -> Self {
        Self {
            next_number,
            wall: None,
            asked: Vec::new(),
            hand: None,
            recording: None,
            open: None,
            painter: Painter::default(),
        }
    }

    /// The clock on the wall shows this; gives the seconds by which somebody has set it since the last time, if that is worth a word.
    pub(crate) fn set_clock(&mut self, now_us: u64, utc_s: i64) -> Option<i64> {
        if utc_s < CLOCK_IS_SET_FROM_S {
            return None;
        }
        let expected_s = self.utc_s(now_us);
        self.wall = Some((now_us, utc_s));
        let by_s = expected_s
            .map(|expected_s| utc_s.saturating_sub(expected_s))
            .filter(|by_s| by_s.unsigned_abs() >= CLOCK_WAS_SET_S);
        if let Some(open) = &mut self.open {
            if let Some(by_s) = by_s {
                open.set_clock_by(by_s);
            }
            open.learn_clock(now_us, utc_s);
        }
        by_s
    }

    /// Somebody commands, for the next step.
    pub(crate) fn commanded_by(&mut self, asker: RunAsker) {
        self.hand = Some(asker);
    }

    /// Somebody orders a run, with the next step.
    pub(crate) fn asked(&mut self, asked: Asked, at_home: Option<BrainAtHome<'_>>) {
        if let (Some(open), Some(at_home)) = (&mut self.open, at_home) {
            open.draw(at_home, &mut self.painter);
        }
        self.asked.push(asked);
    }

    /// A recording has this name.
    pub(crate) fn recorded_as(&mut self, run: u32, name: String) {
        if let Some(open) = &mut self.open {
            open.add_recording(&name);
        }
        self.recording = Some((run, name));
    }

    /// Takes up a run that a daemon before this one had begun. If it was over already, it is given back at once.
    pub(crate) fn resume(&mut self, now_us: u64, record: RunRecord, brain: &Brain) -> Option<RunRecord> {
        if record.run.result != RunResult::CutShort {
            return Some(record);
        }
        let mut open = OpenRun::resume(record, now_us);
        open.note_restart(now_us, brain);
        self.open = Some(open);
        None
    }

    /// The record of the run that goes on, as far as it is known.
    pub(crate) fn so_far(&self, now_us: u64) -> Option<RunRecord> {
        self.open.as_ref().map(|open| open.so_far(now_us, None))
    }

    /// Takes in a step of the brain.
    pub(crate) fn step(&mut self, moment: &Moment<'_>) -> Step {
        let mut step = Step::default();
        let (mut asked, hand) = if moment.commands_wait {
            (Vec::new(), None)
        } else {
            (core::mem::take(&mut self.asked), self.hand.take())
        };
        let has_begun = |decision: &Decision| {
            decision.kind == DecisionKind::StateStarting
                && decision.cause == DecisionCause::Reason(Reason::Command)
        };
        let begun = moment
            .decisions
            .iter()
            .filter(|decision| has_begun(decision))
            .count();
        let refused = asked.len().saturating_sub(begun);
        for asked in asked.drain(refused..) {
            let turned_home = self.open.as_ref().and_then(OpenRun::turned_home);
            let ending = Ending::replaced(turned_home, Some(&asked.by));
            step.over.extend(self.end(moment, ending));
            self.begin(asked, moment);
        }
        if let (None, Some(kind)) = (&self.open, moment.brain.job_kind()) {
            let (by, job) = (RunAsker::Robot, job_of(kind));
            self.begin(Asked { by, job }, moment);
        }
        let Some(open) = &mut self.open else { return step };
        let was_over = open.over_us.is_some();
        open.follow(moment, hand.as_ref());
        let Some(over_us) = open.over_us else { return step };
        if !was_over {
            step.done = Some(open.so_far(moment.now_us, Some(moment.brain)));
        }
        let is_driven = moment.brain.status().state == BehaviorState::Manual;
        if is_driven || moment.now_us >= over_us + OVER_US {
            step.over.extend(self.close(moment.now_us, moment.at_home()));
        }
        step
    }

    fn begin(&mut self, asked: Asked, moment: &Moment<'_>) {
        let start_s = self.utc_s(moment.now_us);
        let mut open = OpenRun::begin(self.next_number, asked, (moment, start_s));
        self.next_number += 1;
        if let Some((run, name)) = &self.recording
            && moment.recorded == Some(*run)
        {
            open.add_recording(name);
        }
        self.open = Some(open);
    }

    fn end(&mut self, moment: &Moment<'_>, ending: Ending) -> Option<RunRecord> {
        self.open.as_mut()?.end_as(moment.now_us, ending);
        self.close(moment.now_us, moment.at_home())
    }

    /// The daemon ends.
    pub(crate) fn shut_down(&mut self, now_us: u64, at_home: BrainAtHome<'_>) -> Option<RunRecord> {
        self.open.as_mut()?.end_as(now_us, Ending::daemon_ended());
        self.close(now_us, at_home)
    }

    /// Another robot was attached.
    pub(crate) fn change_robot(&mut self, now_us: u64, at_home: BrainAtHome<'_>) -> Option<RunRecord> {
        if let Some(open) = &mut self.open {
            open.end_as(now_us, Ending::other_robot());
        }
        let over = self.close(now_us, at_home);
        self.painter.forget();
        over
    }

    fn close(&mut self, now_us: u64, at_home: BrainAtHome<'_>) -> Option<RunRecord> {
        let end_s = self.utc_s(now_us);
        let open = self.open.take()?;
        Some(open.close(now_us, (at_home, end_s), &mut self.painter))
    }

    fn utc_s(&self, now_us: u64) -> Option<i64> {
        let (then_us, utc_s) = self.wall?;
        Some(utc_s + (now_us.saturating_sub(then_us) / 1_000_000).cast_signed())
    }
}

/// A job of which only this is known.
fn job_of(kind: JobKind) -> RunJob {
    match kind {
        JobKind::Clean(strategy) => RunJob::Clean {
            strategy: strategy.name().to_owned(),
            rooms: Vec::new(),
            zones: 0,
            spots: 0,
            passes: 1,
        },
        JobKind::Spot => RunJob::Spot,
        JobKind::GoTo => RunJob::GoTo,
        JobKind::Dock => RunJob::Dock,
    }
}
