//! The brain as its shell sees it.

mod beacon_words;
pub mod checkpoint;
pub(crate) mod estimating;
mod floor_sensing;
mod gyro_words;
mod learning;
mod map_changes;
mod map_renewal;
mod map_words;
mod next_run;
mod planned_path;
mod situation;
mod young_map;

use crate::behavior::{Behavior, JobFigures, JobKind, JobStart, Status};
use crate::brain::checkpoint::{Checkpoint, CheckpointWork};
use crate::localization::Localization;
use crate::mapping::{
    BeamMemory, Brushes, CarpetDetector, Hazard, HazardKind, LoadedHome, Map, NextNumbers, StampedOdometry,
    StoredMap,
};
use crate::model::action::Actions;
use crate::model::command::{Command, JobCommand, StrategyName};
use crate::model::config::BrainConfig;
use crate::model::energy::EnergyModel;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gyro_fault::GyroFault;
use crate::model::job_refusal::JobRefusal;
use crate::model::learnt::{GyroLearnt, Learnt};
use crate::model::map_doubt::MapDoubt;
use crate::model::observation::Observation;
use crate::model::onsets::Onsets;
use crate::model::order::CleaningOrder;
use crate::model::pose_estimate::PoseEstimate;
use crate::model::random::Random;
use crate::model::room_settings::RoomPower;
use crate::model::swept_share::SweptShare;
use crate::navigation::TaskContext;
use situation::Parts;
use young_map::YoungMapSearch;

pub use planned_path::PlannedPath;

/// Direction of a one-sided contact or cliff from straight ahead, in radians: the middle of its half of the bumper.
const SIDE_RAD: f64 = core::f64::consts::FRAC_PI_4;

/// Brain of one robot. The shell gives it each observation and the commands since the last one, and performs the actions it returns.
#[derive(Debug)]
pub struct Brain {
    config: BrainConfig,
    localization: Localization,
    map: Map,
    beams: BeamMemory,
    carpet: CarpetDetector,
    behavior: Behavior,
    mind: TaskContext,
    /// What was last said of the gyro.
    gyro_told: Option<GyroFault>,
    /// Why the map of the home is doubted; once it is, that holds for the run.
    map_doubt: Option<MapDoubt>,
    young_map_search: YoungMapSearch,
}

impl Brain {
    /// A brain at the origin of an empty map, disconnected until the first observation says otherwise. Equal seeds and
    /// equal observations give equal actions.
    #[must_use]
    pub fn new(config: BrainConfig, seed: u64) -> Self {
        let rim_max_m_per_s =
            config.speeds.max_m_per_s + 0.5 * config.body.track_m * config.speeds.turn_max_rad_per_s;
        let mut localization = Localization::new(config.body.track_m, rim_max_m_per_s);
        localization.start_line_slam(&config);
        Self {
            config,
            localization,
            map: Map::new(config.body, config.sensors),
            beams: BeamMemory::default(),
            carpet: CarpetDetector::default(),
            behavior: Behavior::new(config),
            mind: TaskContext {
                random: Random::new(seed),
                journal: Vec::new(),
            },
            gyro_told: None,
            map_doubt: None,
            young_map_search: YoungMapSearch::default(),
        }
    }

    /// A brain on the dock of a stored home, or at the origin of one without a known dock.
    #[must_use]
    pub fn with_map(config: BrainConfig, seed: u64, home: &StoredMap) -> Self {
        let mut brain = Self::new(config, seed);
        brain.map.load(home);
        brain.wake_on_dock();
        brain
    }

    /// As [`Self::with_map`], with a home that is taken up already.
    #[must_use]
    pub fn with_home(config: BrainConfig, seed: u64, home: LoadedHome) -> Self {
        let mut brain = Self::new(config, seed);
        brain.map.replace_home(home);
        brain.wake_on_dock();
        brain
    }

    /// What is new on the map from now on gets these numbers or higher ones: of a floor whose map is lost people keep numbers still.
    pub fn number_after(&mut self, next: NextNumbers) {
        self.map.number_after(next);
    }

    fn wake_on_dock(&mut self) {
        let dock = self.map.dock_location();
        if let Some(pose) = dock.pose() {
            self.localization.place_at(pose);
        }
        self.track();
        self.localization.begin_with_beacons(self.map.beacons());
        if let Some(pose) = dock.pose().filter(|_| dock.is_reported()) {
            self.localization.place_roughly_at(pose);
        }
    }

    /// Draws what the robot perceives, keeps the beacons with it, and notes how far its place can be trusted meanwhile.
    fn draw(&mut self, observation: &Observation, estimate: &PoseEstimate) {
        if self.localization.knows_heading(observation.time_us) && self.localization.may_draw() {
            self.map.insert(estimate, observation);
        }
        if let Some(beacons) = self.localization.beacons_to_keep(observation.time_us) {
            self.map.keep_beacons(beacons);
        }
        if let Some(trust) = self.localization.place_trust() {
            self.map.note_trust(trust, observation.time_us);
        }
    }

    /// Takes in what the robot perceived and what people asked since the last step, and says what to do. To be called
    /// with each telemetry report, and at least ten times a second while the link is down so that the brain notices.
    pub fn step(&mut self, observation: &Observation, commands: &[Command]) -> Actions {
        let advance = self.localization.update(observation);
        self.tell_gyro();
        let correction = self.localization.refine(observation, advance);
        self.correct_map(correction);
        self.tell_beacons();
        self.doubt_map();
        let estimate = self.localization.estimate();
        let pose = estimate.pose;
        self.beams.update(observation, &estimate);
        if self.localization.has_just_docked() {
            self.observe_dock(pose);
        }
        self.draw(observation, &estimate);
        self.localization
            .check_against_map(observation, advance, &self.config);
        let correction = self
            .localization
            .learn(&self.map, &self.config, observation.time_us);
        self.correct_map(correction);
        self.search_in_young_map(advance.time_s);
        self.note_encounters(advance.onsets, observation.time_us, &estimate);
        let (mut jobs, mut edits) = (Vec::new(), Vec::new());
        for command in commands {
            match command {
                Command::Edit(edit) => edits.push(self.edit(edit, observation.docked)),
                Command::Job(job) => jobs.push(job),
            }
        }
        let situation = Parts {
            localization: &self.localization,
            map: &self.map,
            beams: &self.beams,
            config: &self.config,
        }
        .situation(observation, advance);
        let intent = self.behavior.step(&situation, &jobs, &mut self.mind);
        self.tell_no_share();
        if intent.job_start == JobStart::FreshMap {
            self.map.start_anew();
            self.map.avoid(self.behavior.avoided());
        }
        if let Some(pocket) = intent.pocket {
            self.map.forbid_pocket(pocket);
        }
        // An edit of the dock may just have moved the pose. Floor that a lost robot sweeps cannot be located and does not count.
        let here = self.localization.estimate();
        self.map.follow(
            here.pose,
            if intent.cleaners && !here.lost {
                Brushes::Sweeping
            } else {
                Brushes::Still
            },
            observation.time_us,
        );
        self.sense_floor(observation, intent.cleaners);
        Actions {
            motion: intent.motion,
            cleaners: intent.cleaners,
            arm: intent.arm,
            tones: intent.tones,
            decisions: core::mem::take(&mut self.mind.journal),
            edits,
        }
    }

    /// Whether `command` would be obeyed in the situation of the last step. A shell asks this first, to answer its client.
    ///
    /// # Errors
    /// Why it would be refused.
    pub fn admit(&self, command: &JobCommand) -> Result<(), JobRefusal> {
        self.behavior.admit(command, (&self.map, self.estimate()))
    }

    /// Pose in the map frame. The origin is the pose at the start, x points forward there.
    #[must_use]
    pub fn pose(&self) -> Pose2 {
        self.localization.pose()
    }

    /// Pose in the map frame and how sure it is.
    #[must_use]
    pub fn estimate(&self) -> PoseEstimate {
        self.localization.estimate_in_home()
    }

    /// Share of what the sensors see lately that the map explains, 0..=1; `None` while nothing is compared with a map.
    #[must_use]
    pub fn map_agreement(&self) -> Option<f64> {
        self.localization.explained()
    }

    /// Sets the pose at the last observation, for a simulator that tests a planner without the estimator's error. This is not part
    /// of a recording, so such a run cannot be replayed.
    pub fn place_at(&mut self, pose: Pose2) {
        self.localization.place_at(pose);
    }

    /// Strategy that suits the robot of the last step. [`StrategyName::Systematic`] needs range sensors with known mounting positions
    /// and a source of heading besides the wheels. A robot without such a source cleans by statistics.
    #[must_use]
    pub fn usual_strategy(&self) -> StrategyName {
        let sees = !self.config.sensors.proximity.sensors().is_empty();
        match (self.behavior.knows_heading(), sees) {
            (true, true) => StrategyName::Systematic,
            (true, false) => StrategyName::Bounce,
            (false, _) => StrategyName::Statistical,
        }
    }

    /// What the robot is doing and why.
    #[must_use]
    pub fn status(&self) -> Status {
        self.behavior.status()
    }

    /// Whether a job waits on the dock and goes on by itself, however low the pack still is.
    #[must_use]
    pub fn waits_on_dock(&self) -> bool {
        self.behavior.waits_on_dock()
    }

    /// Identity of the room in which the robot is, if it knows both.
    #[must_use]
    pub fn room(&self) -> Option<u16> {
        let estimate = self.estimate();
        self.map
            .rooms()
            .room_at(estimate.pose.position())
            .filter(|_| estimate.is_sure())
    }

    /// How hard brushes and suction run in a job where the robot is: as the job says, else as is set for the room.
    #[must_use]
    pub fn power_here(&self) -> RoomPower {
        let of_room = || {
            let settings = self.map.annotations().settings(self.room()?)?;
            Some(settings.power())
        };
        let of_job = self.behavior.order().and_then(CleaningOrder::power);
        of_job.or_else(of_room).unwrap_or(RoomPower::FULL)
    }

    /// The map of the running or last job.
    #[must_use]
    pub fn map(&self) -> &Map {
        &self.map
    }

    /// What the running or last job has done.
    #[must_use]
    pub fn job(&self) -> JobFigures {
        JobFigures {
            swept_m2: self.map.swept_m2(),
            ..self.behavior.figures()
        }
    }

    /// Learnt energy use of driving and cleaning.
    #[must_use]
    pub fn energy(&self) -> EnergyModel {
        self.behavior.energy()
    }

    /// What the running or waiting job is for, if there is one.
    #[must_use]
    pub fn job_kind(&self) -> Option<JobKind> {
        self.behavior.job_kind()
    }

    /// The job resumes once the pack is charged: the robot is driving to the dock for that, or is on it.
    #[must_use]
    pub fn awaits_charge(&self) -> bool {
        self.behavior.awaits_charge()
    }

    /// The planned path of the running or waiting job from here on, for display.
    #[must_use]
    pub fn planned_path(&self) -> PlannedPath {
        PlannedPath::up_to_walls(self.behavior.planned_path(), self.map.knowledge())
    }

    /// Share of its target floor that the running or waiting job has swept; `None` for a job without a target, and where the map is
    /// doubted. Iterates over all swept cells, so it is to be called a few times a minute at most.
    #[must_use]
    pub fn swept_share(&self) -> Option<SweptShare> {
        self.behavior
            .swept_share(&self.map)
            .filter(|_| self.map_doubt.is_none())
    }

    /// Everything that must survive a restart of the shell. Copies the whole home at once: for a robot at rest.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            home: Some(self.map.stored()).filter(|home| !home.is_blank()),
            ..self.checkpoint_without_home()
        }
    }

    /// As [`Self::checkpoint`], of the present state, in steps: for a robot in motion.
    #[must_use]
    pub fn begin_checkpoint(&self) -> CheckpointWork {
        CheckpointWork {
            rest: self.checkpoint_without_home(),
            home: self.map.stored_in_steps(),
        }
    }

    /// As [`Self::checkpoint`], without the home: for a reader that has the home or does not need it.
    #[must_use]
    pub fn checkpoint_without_home(&self) -> Checkpoint {
        let map = self.map.snapshot();
        Checkpoint {
            pose: self.pose(),
            random_state: self.mind.random.state(),
            backed_m: self.localization.backed_m(),
            job: self.behavior.checkpoint(),
            energy: self.behavior.energy(),
            gyro: self.learnt_gyro(),
            swept: self.map.swept_runs(),
            path: map.path.to_vec(),
            hazards: map.hazards.to_vec(),
            home: None,
            tracking: self.localization.checkpoint(),
            map_doubt: self.map_doubt,
        }
    }

    /// What was learnt of the gyro.
    pub(crate) fn learnt_gyro(&self) -> Option<GyroLearnt> {
        self.localization.learnt_gyro()
    }

    /// Discards what was learnt of the gyro.
    pub(crate) fn forget_gyro(&mut self) {
        self.localization.forget_gyro();
    }

    /// A new brain begins with what the robot has learnt of itself before.
    pub fn begin_with(&mut self, learnt: Learnt) {
        if let Some(gyro) = learnt.gyro {
            self.localization.begin_with_gyro(gyro);
        }
        self.behavior.learn_energy(learnt.energy);
    }

    /// Takes up a checkpoint in a new brain: the pose holds on from the next observation, a job that ran goes on by itself
    /// (announced as after any start) once the link is up, a job that waited waits on.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        if let Some(home) = &checkpoint.home {
            self.map.load(home);
        }
        self.go_on_from(checkpoint);
    }

    /// As [`Self::restore`], with the checkpoint's home taken up already.
    pub fn restore_at(&mut self, home: LoadedHome, checkpoint: &Checkpoint) {
        self.map.replace_home(home);
        self.go_on_from(checkpoint);
    }

    fn go_on_from(&mut self, checkpoint: &Checkpoint) {
        self.localization.place_at(checkpoint.pose);
        self.localization.resume_backed(checkpoint.backed_m);
        self.mind.random = Random::from_state(checkpoint.random_state);
        self.map
            .restore(&checkpoint.swept, &checkpoint.path, &checkpoint.hazards);
        if let Some(tracking) = checkpoint.tracking {
            self.track();
            self.localization.resume_tracking(tracking);
        } else {
            self.map.draw_afresh();
        }
        self.localization.begin_with_beacons(self.map.beacons());
        self.begin_with(Learnt {
            gyro: checkpoint.gyro,
            energy: checkpoint.energy,
        });
        self.map_doubt = checkpoint.map_doubt;
        if let Some(job) = &checkpoint.job {
            self.behavior.restore(job.clone());
            self.map.avoid(self.behavior.avoided());
        }
    }

    /// Localizes in the present map. Where the map is too poor for that, the walls that the robot finds are the reference.
    fn track(&mut self) {
        self.localization
            .start_monte_carlo(&self.map, &self.config, self.mind.random.state());
        if self.map_agreement().is_none() {
            self.map.draw_afresh();
            self.localization.start_line_slam(&self.config);
        }
    }

    /// Marks and counts contacts and cliffs as they begin.
    fn note_encounters(&mut self, onsets: Onsets, time_us: u64, estimate: &PoseEstimate) {
        let (contacts, cliffs) = (onsets.contacts, onsets.cliffs);
        if contacts.any() {
            self.behavior.count_bump();
            let sides = (contacts.left, contacts.right);
            self.mark(HazardKind::Contact, (time_us, estimate), sides);
        }
        if onsets.is_first_cliff {
            let sides = (cliffs.left, cliffs.right);
            self.mark(HazardKind::Cliff, (time_us, estimate), sides);
        }
    }

    fn mark(
        &mut self,
        kind: HazardKind,
        (time_us, estimate): (u64, &PoseEstimate),
        (left, right): (bool, bool),
    ) {
        let bearing_rad = SIDE_RAD * (f64::from(u8::from(left)) - f64::from(u8::from(right)));
        let in_base = Point2::in_direction(bearing_rad, self.config.body.radius_m);
        let seen = StampedOdometry {
            time_us,
            odom: estimate.odom.transform(in_base),
        };
        let at = estimate.pose.transform(in_base);
        self.map.add_hazard(Hazard { at, kind }, seen);
        self.map.begin_refresh();
    }
}
