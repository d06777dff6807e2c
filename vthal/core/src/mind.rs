//! The brain and what surrounds it: its observations, the commands that wait for its next step, and the borders of runs.
//!
//! *Run*: what is recorded to one file and can be replayed. Each run begins with a fresh brain that takes up a checkpoint
//! of the one before, and then sees the last observation again. So a replay needs nothing from before the run.

use brain::config::BrainConfig;
use brain::mapping::StoredMap;
use brain::{Actions, BehaviorState, Body, Brain, Command, MapCursor, Speeds};

use crate::device::{Description, Shape};
use crate::observe::Observer;
use crate::{CoreConfig, Record, RunCause, RunEnd, RunStart, to_api};

/// Speed at which a robot cleans unless it is slower than that, m/s.
const CRUISE_M_PER_S: f64 = 0.25;
/// A run ends when the robot has rested for this long.
const REST_ENDS_RUN_US: u64 = 5_000_000;

/// A brain for one robot.
#[derive(Debug)]
pub(crate) struct Mind {
    brain: Brain,
    config: BrainConfig,
    seed: u64,
    pub(crate) observer: Observer,
    waiting: Vec<Command>,
    /// Brains before this one: part of the number of the map.
    map_base: u32,
    runs: u32,
    run: Option<Run>,
    kept_home: KeptHome,
    identity: (String, String),
    robot: rvac_api::RobotDescription,
}

/// The map of the home that was kept before the daemon's start.
#[derive(Debug)]
enum KeptHome {
    /// The robot was not seen on its dock yet, so nobody knows where in it it is.
    Offered(StoredMap),
    /// The brain has it, or there was none: what the brain knows is what is kept.
    Present,
}

#[derive(Clone, Copy, Debug)]
struct Run {
    /// Since when the robot rests, if it does.
    resting_since_us: Option<u64>,
}

/// What a step gives: actions, and records if they are wanted.
pub(crate) struct Recorder<'a> {
    /// `None` = no recording.
    pub(crate) records: Option<&'a mut Vec<Record>>,
}

impl Recorder<'_> {
    fn write(&mut self, record: impl FnOnce() -> Record) {
        if let Some(records) = &mut self.records {
            records.push(record());
        }
    }
}

impl Mind {
    pub(crate) fn new(description: &Description, settings: &CoreConfig) -> Self {
        let config = brain_config(description, settings);
        let seed = settings.seed;
        Self {
            brain: Brain::new(config, seed),
            config,
            seed,
            observer: Observer::new(),
            waiting: Vec::new(),
            map_base: 0,
            runs: 0,
            run: None,
            kept_home: settings.home.clone().map_or(KeptHome::Present, KeptHome::Offered),
            identity: (
                description.identity.device.clone(),
                description.identity.firmware.clone(),
            ),
            robot: to_api::robot(description),
        }
    }

    pub(crate) fn brain(&self) -> &Brain {
        &self.brain
    }

    /// Begins anew in a home that is known.
    pub(crate) fn take_up(&mut self, home: &StoredMap) {
        self.brain = Brain::with_map(self.config, self.seed, home);
    }

    pub(crate) fn place_at(&mut self, pose: brain::Pose2) {
        self.brain.place_at(pose);
    }

    pub(crate) fn device(&self) -> &str {
        &self.identity.0
    }

    /// Number of the present map since the daemon's start, from 1.
    pub(crate) fn map_number(&self) -> u32 {
        self.map_base + self.brain.map().snapshot().generation
    }

    pub(crate) fn map_cursor(&self) -> MapCursor {
        self.brain.map().cursor()
    }

    pub(crate) fn is_recorded(&self) -> bool {
        self.run.is_some()
    }

    /// Number of the run that is recorded now.
    pub(crate) fn recorded_run(&self) -> Option<u32> {
        self.run.map(|_| self.runs)
    }

    /// Gives `command` to the brain with its next step. The first one after rest begins a run.
    pub(crate) fn command(&mut self, now_us: u64, command: Command, recorder: &mut Recorder<'_>) {
        let cause = match command {
            Command::Clean { .. } | Command::CleanParts { .. } | Command::Spot | Command::Dock => {
                Some(RunCause::Job)
            }
            Command::Manual { .. } => Some(RunCause::Manual),
            Command::AddNoGo { .. }
            | Command::RemoveNoGo { .. }
            | Command::NameRoom { .. }
            | Command::Pause
            | Command::Resume
            | Command::Stop
            | Command::ManualEnd
            | Command::ClearError => None,
        };
        if let Some(cause) = cause
            && self.begins_run(cause)
        {
            self.end_run(now_us, RunEnd::Finished, recorder);
            let checkpoint = self.brain.checkpoint();
            self.begin_run(now_us, (cause, checkpoint), recorder);
        }
        // A stick that moves faster than telemetry comes: only its newest position counts.
        if matches!(command, Command::Manual { .. }) {
            self.waiting
                .retain(|other| !matches!(other, Command::Manual { .. }));
        }
        self.waiting.push(command);
    }

    fn begins_run(&self, cause: RunCause) -> bool {
        let rests = self.rests() && self.waiting.is_empty();
        self.run.is_none() || (rests && cause == RunCause::Job)
    }

    /// Takes up what a daemon before this one was doing.
    pub(crate) fn resume(&mut self, now_us: u64, checkpoint: brain::Checkpoint, recorder: &mut Recorder<'_>) {
        self.kept_home = KeptHome::Present;
        self.begin_run(now_us, (RunCause::ResumedAfterRestart, checkpoint), recorder);
    }

    fn begin_run(
        &mut self,
        now_us: u64,
        (cause, checkpoint): (RunCause, brain::Checkpoint),
        recorder: &mut Recorder<'_>,
    ) {
        self.map_base = self.map_number();
        self.runs += 1;
        // Any odd multiplier gives each run a seed of its own; this one is the golden ratio's.
        let seed = self.seed ^ u64::from(self.runs).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.brain = Brain::new(self.config, seed);
        self.brain.restore(&checkpoint);
        self.run = Some(Run {
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
        if cause != RunCause::ResumedAfterRestart {
            self.step_once(&[], recorder);
        }
    }

    /// Takes up the home that was kept, once the robot stands on its dock at rest: there it knows where it is. What it has
    /// drawn since the start, not knowing, is forgotten. `true` when it did.
    pub(crate) fn take_up_kept_home(&mut self) -> bool {
        let observation = self.observer.observation();
        if self.run.is_some() || !observation.docked || !observation.link_up {
            return false;
        }
        match core::mem::replace(&mut self.kept_home, KeptHome::Present) {
            KeptHome::Offered(home) => {
                self.take_up(&home);
                true
            }
            KeptHome::Present => false,
        }
    }

    /// Offers a kept home in place of what is known now, which is not worth keeping any more. It is taken up when the robot
    /// stands on its dock; a run that has nothing left to do ends before.
    pub(crate) fn offer(&mut self, now_us: u64, home: StoredMap, recorder: &mut Recorder<'_>) {
        self.end_run(now_us, RunEnd::Finished, recorder);
        self.kept_home = KeptHome::Offered(home);
    }

    /// Whether what the brain knows is the home that is kept, so that people may change it.
    pub(crate) fn admit_edit(&self) -> Result<(), &'static str> {
        match self.kept_home {
            KeptHome::Offered(_) => Err("map-not-taken-up"),
            KeptHome::Present if self.brain.estimate().lost => Err("place-unknown"),
            KeptHome::Present => Ok(()),
        }
    }

    /// The home as it is worth keeping; `None` while the one that was kept is a better one, or the robot is lost.
    pub(crate) fn home_to_keep(&self) -> Option<StoredMap> {
        match self.kept_home {
            KeptHome::Present if !self.brain.estimate().lost => {
                Some(self.brain.map().stored()).filter(|home| !home.is_empty())
            }
            KeptHome::Present | KeptHome::Offered(_) => None,
        }
    }

    /// One step with the present observation.
    pub(crate) fn step(&mut self, recorder: &mut Recorder<'_>) -> Actions {
        let commands = core::mem::take(&mut self.waiting);
        let actions = self.step_once(&commands, recorder);
        self.observer.seen();
        self.waiting = commands;
        self.waiting.clear();
        self.watch_rest(recorder);
        actions
    }

    fn step_once(&mut self, commands: &[Command], recorder: &mut Recorder<'_>) -> Actions {
        let observation = self.observer.observation();
        let actions = self.brain.step(observation, commands);
        if self.run.is_some() {
            for command in commands {
                recorder.write(|| Record::Command {
                    time_us: observation.time_us,
                    command: command.clone(),
                });
            }
            recorder.write(|| Record::Observation(observation.clone()));
            recorder.write(|| Record::Actions {
                time_us: observation.time_us,
                actions: actions.clone(),
            });
        }
        actions
    }

    /// Whether no job runs or waits.
    pub(crate) fn rests(&self) -> bool {
        let status = self.brain.status();
        let at_rest = matches!(
            status.state,
            BehaviorState::Idle | BehaviorState::Docked | BehaviorState::Disconnected
        );
        at_rest && !status.resumable
    }

    fn watch_rest(&mut self, recorder: &mut Recorder<'_>) {
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

fn brain_config(description: &Description, settings: &CoreConfig) -> BrainConfig {
    let Shape::Circle { radius_m } = description.shape;
    let body = Body {
        radius_m,
        swath_m: description.swath_m,
        track_m: description.drive.track_m,
    };
    let speeds = Speeds {
        cruise_m_per_s: CRUISE_M_PER_S.min(description.drive.speed_max_m_per_s),
        max_m_per_s: description.drive.speed_max_m_per_s,
        turn_max_rad_per_s: description.drive.turn_max_rad_per_s,
    };
    BrainConfig {
        task_budget_s: f64::from(settings.task_budget_s),
        sensors: settings.sensors,
        ..BrainConfig::new(body, speeds)
    }
}
