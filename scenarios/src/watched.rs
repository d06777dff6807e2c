//! A household that is watched while it runs: what it does becomes numbers that differ when a single bit of it does.

use brain::command::StrategyName;
use brain::{BehaviorState, Brain, StoredMap};
use content_hash::ContentHash;
use home::{Home, Pcg, Pose};
use robot::RobotSettings;
use rvac_api::RequestBody;
use rvac_sim::run::{RunEnd, core_config};
use rvac_sim::{Host, Household, Scene};
use vthal_core::{CoreConfig, Record, Recording};

use crate::in_phase;

/// A job that nobody ends may take so long, seconds.
pub const JOB_S: u64 = 30 * 60;
/// A host knows its robot after so many seconds.
const CONNECT_S: u64 = 3;
/// A robot has left its dock after so many seconds.
const SET_OUT_S: u64 = 10;
/// What docking tells of the way is drawn within so long, seconds.
const SETTLE_S: u64 = 30;
/// Free floor around a body that somebody puts down, metres from its middle.
const CLEARANCE_M: f64 = 0.21;
/// Stream of the draws of places.
const STREAM: u64 = 83;

/// A household, and what it has done so far as numbers.
#[derive(Debug)]
pub struct Watched {
    household: Household,
    answers: ContentHash,
    /// Where the robot believed to be, second by second.
    beliefs: ContentHash,
    steps: u64,
    decisions: u64,
}

impl Watched {
    /// A robot on its dock that knows nothing.
    #[must_use]
    pub fn new(scene: &Scene, seed: u64) -> Self {
        Self::of(household(scene, (seed, None), usual(scene, seed)))
    }

    /// A robot somewhere in the home that knows nothing.
    #[must_use]
    pub fn somewhere(scene: &Scene, seed: u64) -> Self {
        let place = free_place(scene.home(), seed);
        Self::of(household(scene, (seed, Some(place)), usual(scene, seed)))
    }

    /// A robot on its dock whose daemon begins with `config`.
    #[must_use]
    pub fn with_config(scene: &Scene, seed: u64, config: CoreConfig) -> Self {
        Self::of(household(scene, (seed, None), config))
    }

    fn of(household: Household) -> Self {
        let mut watched = Self {
            household,
            answers: ContentHash::default(),
            beliefs: ContentHash::default(),
            steps: 0,
            decisions: 0,
        };
        if let Some(host) = watched.household.host_mut() {
            host.keep_records();
        }
        watched
    }

    /// The same after a change of its household.
    #[must_use]
    pub fn changed(self, change: impl FnOnce(Household) -> Household) -> Self {
        Self {
            household: change(self.household),
            ..self
        }
    }

    /// The same with a perfect map of the home.
    #[must_use]
    pub fn knowing_home(self) -> Self {
        self.changed(Household::with_known_map)
    }

    /// The same with this map of the home.
    #[must_use]
    pub fn with_map(self, map: StoredMap) -> Self {
        self.changed(|household| household.with_map(map))
    }

    /// The household.
    #[must_use]
    pub const fn household(&self) -> &Household {
        &self.household
    }

    /// The household, to do something to it.
    pub const fn household_mut(&mut self) -> &mut Household {
        &mut self.household
    }

    /// The brain.
    ///
    /// # Panics
    /// When the host does not know its robot.
    #[must_use]
    pub fn brain(&self) -> &Brain {
        let brain = self.household.host().and_then(Host::brain);
        brain.expect("the host knows its robot")
    }

    /// Lets it connect and asks it for a job.
    pub fn start(&mut self, job: RequestBody) {
        self.pass_s(CONNECT_S);
        self.household.ask(job);
    }

    /// Lets it connect and clean with this strategy; `None` = the one that suits the robot.
    pub fn clean(&mut self, strategy: Option<StrategyName>) {
        let strategy = strategy.map(|strategy| strategy.name().to_owned());
        self.start(RequestBody::Start { strategy });
    }

    /// Lets time pass.
    pub fn pass_s(&mut self, seconds: u64) {
        for _ in 0..seconds {
            self.household.pass_ms(1_000);
            self.note();
        }
    }

    /// Lets time pass until something is so, at most `seconds_max`.
    pub fn pass_until(&mut self, seconds_max: u64, is_so: impl Fn(&Household) -> bool) {
        for _ in 0..seconds_max {
            self.pass_s(1);
            if is_so(&self.household) {
                break;
            }
        }
    }

    /// Lets it finish its job and come home, at most `seconds_max`; then it has time to draw its map anew.
    pub fn finish(&mut self, seconds_max: u64) {
        self.pass_until(seconds_max, |household| RunEnd::JobOver.is_reached(household));
        self.pass_s(SETTLE_S);
    }

    /// Lets it come home, at most `seconds_max`; then it has time to draw its map anew.
    pub fn come_home(&mut self, seconds_max: u64) {
        self.pass_s(SET_OUT_S);
        self.pass_until(seconds_max, is_home);
        self.pass_s(SETTLE_S);
    }

    /// Somebody carries it elsewhere.
    pub fn carry(&mut self, seed: u64) {
        let there = free_place(self.household.robot().world().home(), seed);
        self.household.robot_mut().world_mut().lift();
        self.pass_s(3);
        self.household.robot_mut().world_mut().put_down_at(there);
        self.pass_s(3);
    }

    /// Its host dies, and another one takes over after so many seconds with what `next` makes of the old one.
    ///
    /// # Panics
    /// When it has no host.
    pub fn restart(&mut self, after_s: u64, next: impl FnOnce(&Host) -> CoreConfig) {
        self.note();
        let old = self.household.kill_host().expect("it has a host");
        self.pass_s(after_s);
        let mut host = Host::start(self.household.now_us(), recorded(next(&old)));
        host.keep_records();
        self.household.revive_host(host);
    }

    fn note(&mut self) {
        let Some(host) = self.household.host_mut() else {
            return;
        };
        for record in host.take_records() {
            if let Record::Actions { time_us, actions } = record {
                self.steps += 1;
                self.decisions += actions.decisions.len() as u64;
                self.answers.add_actions(time_us, &actions);
            }
        }
        if let Some(brain) = host.brain() {
            let estimate = brain.estimate();
            self.beliefs.add_pose(estimate.pose);
            self.beliefs.add_flag(estimate.lost);
        }
    }

    /// Its figures and hashes, as a row of [`crate::Table`].
    #[must_use]
    pub fn row(&self) -> String {
        let report = self.household.report();
        let truth = self.household.robot().world().truth();
        let state = self.household.host().and_then(Host::state);
        format!(
            "{:<9} {:>6} {:>5.1} % {:>5} {:>7.2} {:>3} {:>5} {:>6} {:>4}  {:016x} {:016x} {:016x} {:016x}",
            state.map_or("unknown", BehaviorState::name),
            truth.time_ms / 1_000,
            100.0 * truth.swept_share,
            truth.contacts,
            truth.path_m,
            if truth.docked { "yes" } else { "no" },
            report.monitor_violations,
            self.steps,
            self.decisions,
            self.household.robot().state_hash(),
            self.answers.value(),
            self.beliefs.value(),
            ContentHash::of_map(self.brain().map()).value(),
        )
    }
}

/// Whether the robot says that it stands on its dock.
#[must_use]
pub fn is_home(household: &Household) -> bool {
    household.host().and_then(Host::state) == Some(BehaviorState::Docked)
}

/// What the columns of [`Watched::row`] are.
pub(crate) const COLUMNS: &str = "state          s   swept bumps   way m dock unsafe answers decisions: \
    world, answers, believed places, map";

/// The settings of a daemon that records what its brain is asked and answers.
#[must_use]
pub fn recorded(config: CoreConfig) -> CoreConfig {
    CoreConfig {
        recording: Recording::On,
        ..config
    }
}

/// The settings of a scene's daemon that chooses the strategy which suits the robot.
#[must_use]
pub fn usual(scene: &Scene, seed: u64) -> CoreConfig {
    CoreConfig {
        strategy: None,
        ..core_config(scene, seed, StrategyName::Systematic)
    }
}

fn household(scene: &Scene, (seed, place): (u64, Option<Pose>), config: CoreConfig) -> Household {
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let robot = scene.robot_at(place, seed, &settings);
    in_phase(Household::new(robot, Host::start(0, recorded(config))))
}

/// A place of the home where the robot can stand, and a direction.
///
/// # Panics
/// When there is none.
#[must_use]
pub fn free_place(home: &Home, seed: u64) -> Pose {
    let places = home.reachable().iter().enumerate();
    let free: Vec<(f64, f64)> = places
        .filter(|(_, is_reachable)| **is_reachable)
        .map(|(index, _)| home.grid().centre(index))
        .filter(|(x_m, y_m)| home.clearance_m(*x_m, *y_m) > CLEARANCE_M)
        .collect();
    let mut random = Pcg::new(seed, STREAM);
    let (x_m, y_m) = free[random.below(free.len() as u32) as usize];
    Pose::new(x_m, y_m, std::f64::consts::PI * random.symmetric())
}
