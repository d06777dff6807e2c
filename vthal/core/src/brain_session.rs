//! The brain and what surrounds it: its observations, the commands that wait for its next step, and the borders of runs.
//!
//! *Run*: what is recorded to one file and can be replayed. Each run begins with a fresh brain that loads a checkpoint
//! of the one before, and then sees the last observation again. So a replay needs nothing from before the run.

mod floors;
mod made_void;
mod next_run;
mod runs;

use brain::config::BrainConfig;
use brain::mapping::StoredMap;
use brain::{
    Actions, BehaviorState, Body, Brain, Checkpoint, Command, JobCommand, JobRefusal, Learnt, LearntPart,
    MapCursor, Speeds,
};
pub(crate) use floors::FloorNews;
use floors::Hands;
use next_run::{LeavingHome, LoadingFloor, NextHome, NextRun};
pub(crate) use runs::Recorder;
use runs::{RecordedRun, cause_of};
use rvac_api::HomeView;

use crate::device::{Description, Part};
use crate::edges::Edges;
use crate::floors::Floors;
use crate::history::BrainAtHome;
use crate::home_view::{SurfaceSensing, home_view};
use crate::lacking::{self, Lacking};
use crate::observe::{LinkView, Observer};
use crate::storey_resolver::StoreyResolver;
use crate::{CoreConfig, FloorHome, Record, RunEnd, to_api};

/// Speed at which a robot cleans unless it is slower than that, m/s.
const CRUISE_M_PER_S: f64 = 0.25;

/// A brain for one robot.
#[derive(Debug)]
pub(crate) struct BrainSession {
    brain: Brain,
    config: BrainConfig,
    seed: u64,
    pub(crate) observer: Observer,
    /// Of what the observer has seen.
    edges: Edges,
    waiting: Vec<Command>,
    /// Edits that waited for a map which the brain has no more.
    dropped_edits: usize,
    /// Offset of the map's number from the brains before this one.
    map_base: u32,
    /// Offset of the home's revision from the brains before this one.
    home_base: u32,
    runs: u32,
    run: Option<RecordedRun>,
    /// A run that begins as soon as its home is ready; commands wait for it.
    next: Option<NextRun>,
    /// The home of a floor that is being loaded.
    loading_floor: Option<LoadingFloor>,
    /// What a run has left, until it is written down.
    leaving_home: Option<LeavingHome>,
    /// What this run has shown of the map with which it began went to the disk.
    is_trial_told: bool,
    /// The floor whose map the brain has; `None` while the floor is unknown.
    floor: Option<u16>,
    /// The search for the floor: while it is not known, and while the robot is lost on one of several.
    storey_resolver: Option<StoreyResolver>,
    hands: Hands,
    identity: (String, String),
    robot: rvac_api::RobotDescription,
    lacking: Vec<Lacking>,
    measures_currents: bool,
}

impl BrainSession {
    /// A brain that begins with what a robot of this description has learnt.
    pub(crate) fn new(
        description: &Description,
        learnt: Learnt,
        settings: &CoreConfig,
        floors: &Floors,
    ) -> Self {
        let config = brain_config(description, settings);
        let seed = settings.seed;
        let mut brain = Brain::new(config, seed);
        brain.begin_with(learnt);
        brain.number_after(floors.next_numbers_without_maps().unwrap_or_default());
        let mut session = Self {
            brain,
            config,
            seed,
            observer: Observer::new(),
            edges: Edges::default(),
            waiting: Vec::new(),
            dropped_edits: 0,
            map_base: 0,
            home_base: 0,
            runs: 0,
            run: None,
            next: None,
            loading_floor: None,
            leaving_home: None,
            is_trial_told: false,
            floor: floors.homes().next().is_none().then(|| floors.first()),
            storey_resolver: None,
            hands: Hands::default(),
            identity: (
                description.identity.device.clone(),
                description.identity.firmware.clone(),
            ),
            robot: to_api::robot(description, &[]),
            lacking: Vec::new(),
            measures_currents: description.has(Part::Currents),
        };
        session.describe(description, settings);
        session
    }

    /// The robot has described itself, for the first time or once more: meanwhile its firmware may have learnt what was measured. Gives
    /// what it lacks, if that is news.
    pub(crate) fn describe(
        &mut self,
        description: &Description,
        settings: &CoreConfig,
    ) -> Option<&[Lacking]> {
        let lacking = lacking::lacking(description, &settings.sensors, &settings.calibration);
        self.robot = to_api::robot(description, &lacking);
        let keeps = lacking.iter().any(|one| one.ability.is_needed_to_move());
        self.observer.set_not_calibrated(keeps);
        let is_news = lacking != self.lacking;
        self.lacking = lacking;
        is_news.then_some(&self.lacking)
    }

    /// What the robot lacks because values of its own were never measured.
    pub(crate) fn lacking(&self) -> &[Lacking] {
        &self.lacking
    }

    pub(crate) fn brain(&self) -> &Brain {
        &self.brain
    }

    /// Stamps the observation with the time, for the next step.
    pub(crate) fn stamp(&mut self, now_us: u64, link: LinkView) {
        self.observer.stamp(now_us, link);
        self.edges.take(now_us, self.observer.observation());
    }

    /// Changes of the contacts: bumper, cliffs, wheel drops.
    pub(crate) fn edges(&self) -> &Edges {
        &self.edges
    }

    /// Starts again in a known home.
    pub(crate) fn take_up(&mut self, home: &StoredMap) {
        self.begin_with(Brain::with_map(self.config, self.seed, home));
    }

    /// Replaces the brain. Its map gets a revision that no earlier one had.
    fn replace(&mut self, brain: Brain) {
        self.home_base = self.home_revision().wrapping_add(1);
        self.is_trial_told = false;
        self.brain = brain;
    }

    /// Replaces the brain, without a run, and gives it the learned values.
    fn begin_with(&mut self, brain: Brain) {
        let learnt = self.brain.learnt();
        self.replace(brain);
        self.brain.begin_with(learnt);
        self.prepare_anew();
    }

    /// A run that is about to begin starts from the brain's present state.
    pub(super) fn prepare_anew(&mut self) {
        if let Some(next) = self.next.take() {
            let anew = self.next.insert(NextRun::after(&self.brain, next.cause));
            anew.stick_was_centred = next.stick_was_centred;
        }
    }

    /// The robot is on this floor from now on. Edits that wait were admitted for the map of another one, and are not made in this one.
    pub(super) fn change_floor(&mut self, floor: Option<u16>) {
        if self.floor == floor {
            return;
        }
        self.floor = floor;
        let before = self.waiting.len();
        self.waiting
            .retain(|command| !matches!(command, Command::Edit(_)));
        self.dropped_edits += before - self.waiting.len();
    }

    /// How many of the oldest edits were dropped since the last call.
    pub(crate) fn take_dropped_edits(&mut self) -> usize {
        core::mem::take(&mut self.dropped_edits)
    }

    /// Whether commands wait for a run whose home is being made ready.
    pub(crate) fn holds_commands(&self) -> bool {
        self.next.is_some()
    }

    /// Whether a job was commanded that the brain has not heard yet.
    pub(crate) fn awaits_job(&self) -> bool {
        self.waiting.iter().any(|command| cause_of(command).is_some())
    }

    /// Whether a job was commanded about that the brain has not heard yet, and would hear with a step.
    pub(crate) fn owes_a_step(&self) -> bool {
        let is_about_job = |command: &Command| match command {
            Command::Job(JobCommand::Manual { .. }) | Command::Edit(_) => false,
            Command::Job(_) => true,
        };
        !self.holds_commands() && self.waiting.iter().any(is_about_job)
    }

    /// Forgets these learned values. The robot rests and is not recorded.
    pub(crate) fn forget(&mut self, parts: &[LearntPart]) {
        for part in parts {
            self.brain.forget(*part);
        }
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

    /// Revision of what is known of the home; no two of this daemon's life are the same.
    pub(crate) fn home_revision(&self) -> u32 {
        let map = self.brain.map();
        self.home_base
            .wrapping_add(map.revision())
            .wrapping_add(map.surface_revision())
    }

    /// The brain, with that revision.
    pub(crate) fn at_home(&self) -> BrainAtHome<'_> {
        BrainAtHome {
            brain: &self.brain,
            home_revision: self.home_revision(),
        }
    }

    /// Whether the robot measures what its motors draw.
    pub(crate) fn measures_currents(&self) -> bool {
        self.measures_currents
    }

    /// What is known of the home, for clients.
    pub(crate) fn home_view(&self) -> HomeView {
        HomeView {
            revision: self.home_revision(),
            ..home_view(self.brain.map(), self.surface_sensing())
        }
    }

    fn surface_sensing(&self) -> SurfaceSensing {
        match self.measures_currents {
            true => SurfaceSensing::Measured,
            false => SurfaceSensing::NotMeasured,
        }
    }

    pub(crate) fn map_cursor(&self) -> MapCursor {
        self.brain.map().cursor()
    }

    /// Gives `command` to the brain with its next step. The first one after rest begins a run, in which it is carried out; with a
    /// home that takes some steps.
    pub(crate) fn command(&mut self, now_us: u64, command: Command, recorder: &mut Recorder<'_>) {
        let cause = cause_of(&command);
        if let Some(cause) = cause
            && self.begins_run(cause)
        {
            // A run whose floor is being loaded begins there.
            let is_ready = self.loading_floor.is_none() && self.brain.map().knowledge().values().is_empty();
            if is_ready {
                self.end_run(now_us, RunEnd::Finished, recorder);
                let checkpoint = self.brain.checkpoint();
                self.begin_run(now_us, (cause, checkpoint, None), recorder);
            } else {
                self.next = Some(NextRun::after(&self.brain, cause));
            }
        }
        self.watch_stick(&command);
        // A stick that moves faster than telemetry comes: only its newest position counts, and that it was in the centre before.
        if let Some(newest) = StickPosition::of(&command) {
            self.waiting.retain(|other| match StickPosition::of(other) {
                Some(other) => other == StickPosition::Centred && newest != StickPosition::Centred,
                None => true,
            });
        }
        if made_void::is_stop(&command) {
            made_void::drop_what_stops_enclose(&mut self.waiting);
        }
        self.waiting.push(command);
    }

    /// Whether `command` would be obeyed, by this brain once it has taken the waiting commands, or by the one of the run that is about to
    /// begin.
    pub(crate) fn admit(&self, command: &JobCommand) -> Result<(), JobRefusal> {
        let was_centred = self.next.as_ref().is_some_and(|next| next.stick_was_centred);
        match self.brain.admit(command) {
            Err(JobRefusal::CentreFirst) if was_centred || self.centred_meanwhile() => Ok(()),
            answer => answer,
        }
    }

    /// Whether the stick came to the centre since the last stop which reaches the brain with the next telemetry.
    fn centred_meanwhile(&self) -> bool {
        let newest = self.waiting.iter().rev().find_map(is_centred_by);
        newest.unwrap_or(false)
    }

    /// Remembers for the next run where the stick was; after a stop it must return to the centre.
    fn watch_stick(&mut self, command: &Command) {
        if let (Some(next), Some(is_centred)) = (&mut self.next, is_centred_by(command)) {
            next.stick_was_centred = is_centred;
        }
    }

    /// Whether [`Self::prepare`] has something to do.
    pub(crate) fn is_preparing(&self) -> bool {
        self.next.is_some() || self.loading_floor.is_some() || self.leaving_home.is_some()
    }

    /// Continues to load the home of a floor, then that of the next run, and begins the run when it is ready; then to write down what
    /// a run has left. Gives that once it is ready.
    pub(crate) fn prepare(&mut self, now_us: u64, recorder: &mut Recorder<'_>) -> Option<FloorHome> {
        if let Some(floor) = &mut self.loading_floor {
            floor.go_on();
        } else if self.next.is_some() {
            self.prepare_run(now_us, recorder);
        } else {
            let home = self.leaving_home.as_mut()?.go_on()?;
            self.leaving_home = None;
            return Some(self.with_trial_once(home)).filter(|left| !left.home.is_empty());
        }
        None
    }

    fn prepare_run(&mut self, now_us: u64, recorder: &mut Recorder<'_>) {
        let Some(next) = &mut self.next else { return };
        let Some(NextHome { written, ready }) = next.go_on(&self.config) else {
            return;
        };
        let cause = next.cause;
        self.next = None;
        self.end_run(now_us, RunEnd::Finished, recorder);
        let checkpoint = Checkpoint {
            home: Some(written),
            ..self.checkpoint_for_next_run()
        };
        self.begin_run(now_us, (cause, checkpoint, Some(ready)), recorder);
    }

    /// Whether the brain's map is the stored one, so that people may edit it.
    pub(crate) fn admit_edit(&self) -> Result<(), &'static str> {
        match self.floor {
            None => Err("map-not-taken-up"),
            Some(_) if self.brain.estimate().lost => Err("place-unknown"),
            Some(_) => Ok(()),
        }
    }

    /// One step with the present observation.
    pub(crate) fn step(&mut self, recorder: &mut Recorder<'_>) -> Actions {
        let commands = if self.holds_commands() {
            Vec::new()
        } else {
            core::mem::take(&mut self.waiting)
        };
        let actions = self.step_once(&commands, recorder);
        self.observer.seen();
        if !self.holds_commands() {
            self.waiting = commands;
            self.waiting.clear();
            self.watch_rest(recorder);
        }
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
        at_rest && !status.resumable && !self.brain.waits_on_dock()
    }
}

/// Where a person's stick is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StickPosition {
    Centred,
    Deflected,
}

impl StickPosition {
    /// Where a command says that the robot is; `None` for a command that does not say.
    fn of(command: &Command) -> Option<Self> {
        let Command::Job(JobCommand::Manual {
            speed_m_per_s,
            turn_rad_per_s,
            ..
        }) = command
        else {
            return None;
        };
        Some(match *speed_m_per_s == 0.0 && *turn_rad_per_s == 0.0 {
            true => Self::Centred,
            false => Self::Deflected,
        })
    }
}

/// Whether the stick counts as centred after a command; `None` where that changes nothing.
fn is_centred_by(command: &Command) -> Option<bool> {
    match StickPosition::of(command) {
        Some(StickPosition::Centred) => Some(true),
        Some(StickPosition::Deflected) => None,
        None if *command == Command::Job(JobCommand::Stop) => Some(false),
        None => (*command == Command::Job(JobCommand::ManualEnd)).then_some(true),
    }
}

fn brain_config(description: &Description, settings: &CoreConfig) -> BrainConfig {
    let body = Body {
        radius_m: description.shape.circumscribed_radius_m(),
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
