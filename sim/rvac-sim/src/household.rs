//! A robot and its host in one process, on a virtual clock.

use std::sync::Arc;

use brain::mapping::StoredMap;
use home::{Beacons, BoardGyro, Home, Pose};

use crate::carpet_quality;
use crate::figures::{Belief, Collector, MeasuredFloor, Sigma};
use crate::host::CLIENT;
use crate::known_map::known_map;
use crate::line_faults::{HostClock, Tamper};
use crate::linux_board::LinuxBoard;
use crate::map_quality::judge;
use crate::report::{Driven, RunReport, StuckWatch};
use crate::trace::{Drawing, KeptRun, Trace};
use crate::{Figures, Host, Robot};

/// Microseconds of a tick.
pub const TICK_US: u64 = 1_000;
/// Milliseconds between two samples of the pose.
const SAMPLE_MS: u64 = 100;

/// A simulated robot, its host if one lives, and the figures of the run.
#[derive(Debug)]
pub struct Household {
    robot: Robot,
    host: Option<Host>,
    from_robot: Vec<u8>,
    map_from_plan: Pose,
    /// Number of the map's frame to which it belongs.
    frame: u32,
    figures: Collector,
    stuck: StuckWatch,
    pose_source: PoseSource,
    /// A map for the host as soon as it has the robot's description.
    known_home: Option<StoredMap>,
    /// With that map the robot's pose in it is given.
    tells_place: bool,
    board: LinuxBoard,
    /// The trace of the run, if enabled.
    trace: Option<Trace>,
    /// Stands between robot and host, if enabled.
    tamper: Option<Tamper>,
    suspension: Suspension,
}

/// Whether the computer of the host sleeps.
#[derive(Clone, Copy, Debug, Default)]
struct Suspension {
    until_ms: u64,
    /// The host's clock was stopped for so long in all.
    lost_us: u64,
    stops_clock: bool,
}

/// The kernel keeps so many bytes for a host that does not read them.
const KERNEL_BYTES_MAX: usize = 4_096;

/// Where the host's pose comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PoseSource {
    /// From the host itself, as on a robot.
    #[default]
    Own,
    /// From the ground truth, with each report of the robot: shows the planner without errors of the estimator.
    Truth,
}

/// What the host says of the floor that it has swept is compared with the truth so often.
const TOLD_MS: u64 = 60_000;

impl Household {
    /// Puts a robot and a host together.
    #[must_use]
    pub fn new(robot: Robot, host: Host) -> Self {
        let map_from_plan = robot.world().truth().pose.inverse();
        let home = robot.world().home();
        let floor = MeasuredFloor {
            reachable_m2: home.reachable_area_m2(),
            t0_s: home.t0_s(),
            cruise_m_per_s: robot.model().drive.cruise_m_per_s,
            rooms: home.rooms(),
        };
        Self {
            robot,
            host: Some(host),
            from_robot: Vec::new(),
            map_from_plan,
            frame: 1,
            figures: Collector::new(floor),
            stuck: StuckWatch::default(),
            pose_source: PoseSource::Own,
            known_home: None,
            tells_place: false,
            board: LinuxBoard::default(),
            trace: None,
            tamper: None,
            suspension: Suspension::default(),
        }
    }

    /// Advances one millisecond.
    pub fn tick(&mut self) {
        self.robot.tick(&mut self.from_robot);
        if self.robot.now_ms() < self.suspension.until_ms {
            self.sleep_ms();
        } else {
            self.wake_ms();
            self.from_robot.clear();
        }
        if self.robot.now_ms().is_multiple_of(SAMPLE_MS) {
            self.sample();
        }
    }

    /// A millisecond in which the host's computer sleeps.
    fn sleep_ms(&mut self) {
        self.from_robot.truncate(KERNEL_BYTES_MAX);
        if self.suspension.stops_clock {
            self.suspension.lost_us += TICK_US;
        }
    }

    /// A millisecond in which the host, if it lives, reads and answers.
    fn wake_ms(&mut self) {
        let now_us = self.now_us();
        if let Some(tamper) = &mut self.tamper {
            tamper.pass_to_host(self.robot.now_ms(), &mut self.from_robot);
        }
        if let Some(host) = &mut self.host {
            if self.pose_source == PoseSource::Truth && !self.from_robot.is_empty() {
                let truth = self.robot.world().truth();
                host.place(self.map_from_plan.then(truth.pose));
            }
            self.board.pass_ms(&self.robot, host, now_us);
            host.step(now_us, &self.from_robot);
            if self
                .known_home
                .as_ref()
                .is_some_and(|home| host.take_up_home(home))
            {
                self.known_home = None;
                if self.tells_place {
                    let truth = self.robot.world().truth();
                    host.place(self.map_from_plan.then(truth.pose));
                }
            }
            deliver(&mut self.robot, self.tamper.as_mut(), host.pending());
        }
    }

    /// The same household with somebody who can tamper with the line.
    #[must_use]
    pub fn with_tamper(self, tamper: Tamper) -> Self {
        Self {
            tamper: Some(tamper),
            ..self
        }
    }

    /// Who tampers with the line, if anybody.
    pub const fn tamper_mut(&mut self) -> Option<&mut Tamper> {
        self.tamper.as_mut()
    }

    /// The host's computer sleeps for `ms` from now on.
    pub const fn suspend_host(&mut self, ms: u64, clock: HostClock) {
        self.suspension.until_ms = self.robot.now_ms() + ms;
        self.suspension.stops_clock = matches!(clock, HostClock::Stands);
    }

    /// The same household whose host has a perfect map of the home as soon as it has the robot's description.
    #[must_use]
    pub fn with_known_map(self) -> Self {
        let home = Arc::clone(self.robot.world().home());
        self.with_map_of(&home)
    }

    /// The same household whose host has a perfect map of how the home was another day. Both days have the same walls.
    #[must_use]
    pub fn with_map_of(self, home: &Home) -> Self {
        let docked = self.robot.world().docked_pose();
        let map = known_map(home, self.map_from_plan, docked);
        Self {
            tells_place: true,
            ..self.with_map(map)
        }
    }

    /// The same household whose host has this map of the home as soon as it has the robot's description.
    #[must_use]
    pub fn with_map(self, map: StoredMap) -> Self {
        Self {
            known_home: Some(map),
            ..self
        }
    }

    /// The same household with a gyro on the Linux board.
    #[must_use]
    pub fn with_board_gyro(mut self, gyro: BoardGyro) -> Self {
        self.board.gyro = Some(gyro);
        self
    }

    /// The gyro on the Linux board says nothing from now on.
    pub fn silence_board_gyro(&mut self) {
        self.board.gyro_is_silent = true;
    }

    /// It measures again.
    pub fn wake_board_gyro(&mut self) {
        self.board.gyro_is_silent = false;
    }

    /// The same household with beacons for the Linux board's radio.
    #[must_use]
    pub fn with_beacons(mut self, beacons: Beacons) -> Self {
        self.board.beacons = Some(beacons);
        self
    }

    /// The same household that remembers what happens.
    #[must_use]
    pub fn with_trace(self) -> Self {
        Self {
            trace: Some(Trace::default()),
            ..self
        }
    }

    /// The run up to now, for a picture.
    ///
    /// # Errors
    /// When the figures cannot be written as JSON.
    pub fn kept_run(&self, title: String) -> anyhow::Result<KeptRun> {
        let home = self.robot.world().home();
        let host = self.host.as_ref();
        Ok(KeptRun {
            map: host.and_then(|host| Drawing::of_map(host, self.map_from_plan.inverse())),
            trace: self.trace.clone().unwrap_or_default(),
            ..KeptRun::new(title, &self.report(), home)?
        })
    }

    /// The same household whose host gets its pose from elsewhere.
    #[must_use]
    pub fn with_pose_source(self, pose_source: PoseSource) -> Self {
        Self { pose_source, ..self }
    }

    /// The job began and is over.
    #[must_use]
    pub fn job_is_over(&self) -> bool {
        self.figures.job_is_over()
    }

    /// Seconds since the job began, whether it is over or not; 0 before.
    #[must_use]
    pub fn job_s(&self) -> f64 {
        self.figures.job_s(self.robot.now_ms())
    }

    /// Milliseconds of work: those since it was switched on, without those on the charger in the middle of the job.
    #[must_use]
    pub fn work_ms(&self) -> u64 {
        self.robot.now_ms() - self.figures.charging_ms()
    }

    /// 95 % of the reachable floor were swept during the job.
    #[must_use]
    pub fn reached_all_shares(&self) -> bool {
        self.figures.reached_all_shares()
    }

    /// Advances `ms` milliseconds.
    pub fn pass_ms(&mut self, ms: u64) {
        for _ in 0..ms {
            self.tick();
        }
    }

    /// Advances second by second until something is so; the seconds that it took, `None` if it is not so after
    /// `seconds_max`.
    pub fn pass_until(&mut self, seconds_max: u64, mut is_so: impl FnMut(&Self) -> bool) -> Option<u64> {
        (1..=seconds_max).find(|_| {
            self.pass_ms(1_000);
            is_so(self)
        })
    }

    /// The virtual clock in microseconds, as the host reads it.
    #[must_use]
    pub const fn now_us(&self) -> u64 {
        self.robot.now_ms() * TICK_US - self.suspension.lost_us
    }

    fn sample(&mut self) {
        self.follow_frame();
        let driven = Driven::of(&self.robot);
        self.stuck
            .watch(SAMPLE_MS as u32, self.robot.world().truth(), driven);
        if let Some(host) = &self.host {
            let truth = self.robot.world().truth();
            let believed = host.pose();
            let belief = Belief {
                pose: Pose::new(believed.x, believed.y, believed.heading),
                state: host.state(),
                lost: host.brain().is_some_and(|brain| brain.estimate().lost),
                sigma: host.brain().map_or_else(Sigma::default, |brain| Sigma {
                    place_m: brain.estimate().sigma_m,
                    heading_rad: brain.estimate().sigma_rad,
                }),
                awaits_charge: host.brain().is_some_and(brain::Brain::awaits_charge),
            };
            let truth_in_map = self.truth_in_map();
            self.figures.sample(truth, truth_in_map, &belief);
            if truth.time_ms.is_multiple_of(TOLD_MS) && belief.state == Some(brain::BehaviorState::Cleaning) {
                let reported = host.brain().and_then(brain::Brain::swept_share);
                self.figures.note_reported(reported, truth.swept_share);
            }
            if let Some(trace) = &mut self.trace {
                let time_ms = truth.time_ms - self.figures.charging_ms();
                trace.sample((time_ms, truth), belief.pose.distance_m(truth_in_map), &belief);
            }
        }
    }

    /// A map that is begun anew has a frame of its own, which the robot's belief fixes at that moment.
    fn follow_frame(&mut self) {
        let Some(brain) = self.host.as_ref().and_then(Host::brain) else {
            return;
        };
        let frame = brain.map().frame();
        if frame == self.frame {
            return;
        }
        let believed = brain.pose();
        let believed = Pose::new(believed.x_m, believed.y_m, believed.heading_rad);
        // A brain that was begun since counts from 1 again, in the frame that it was given.
        if frame > self.frame {
            self.map_from_plan = believed.then(self.robot.world().truth().pose.inverse());
        }
        self.frame = frame;
    }

    /// The host dies on the spot: nothing more is sent, and what its driver held is gone.
    pub fn kill_host(&mut self) -> Option<Host> {
        self.robot.host_died();
        self.host.take()
    }

    /// Another host takes over.
    pub fn revive_host(&mut self, host: Host) {
        self.host = Some(host);
    }

    /// The true pose in the frame of the host's map.
    #[must_use]
    pub fn truth_in_map(&self) -> Pose {
        self.map_from_plan.then(self.robot.world().truth().pose)
    }

    /// The robot.
    #[must_use]
    pub const fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The robot, to break it.
    pub const fn robot_mut(&mut self) -> &mut Robot {
        &mut self.robot
    }

    /// The host, if it lives.
    #[must_use]
    pub const fn host(&self) -> Option<&Host> {
        self.host.as_ref()
    }

    /// The host, if it lives, to ask it.
    pub const fn host_mut(&mut self) -> Option<&mut Host> {
        self.host.as_mut()
    }

    /// Sends a request to the host; without a host it is lost.
    pub fn ask(&mut self, body: rvac_api::RequestBody) {
        let now_us = self.now_us();
        if let Some(host) = &mut self.host {
            host.ask(now_us, body);
            deliver(&mut self.robot, self.tamper.as_mut(), host.pending());
        }
    }

    /// Sends a request to the host, and gives why it is refused, if it is.
    pub(crate) fn ask_and_hear(&mut self, body: rvac_api::RequestBody) -> Option<String> {
        let now_us = self.now_us();
        let host = self.host.as_mut()?;
        let refused = host.ask_as(now_us, CLIENT, body);
        deliver(&mut self.robot, self.tamper.as_mut(), host.pending());
        refused
    }

    fn all_figures(&self) -> Figures {
        let world = self.robot.world();
        let figures = self.figures.figures(world.truth());
        let Some(brain) = self.host.as_ref().and_then(Host::brain) else {
            return figures;
        };
        let plan_from_map = self.map_from_plan.inverse();
        let quality = judge(brain.map(), world.home(), plan_from_map);
        let measures = self.host.as_ref().is_some_and(Host::measures_currents);
        let carpet = carpet_quality::judge(brain.map(), world, (plan_from_map, measures));
        let swept_m2 = brain.job().swept_m2 - world.truth().swept_m2;
        Figures {
            map_iou: quality.map(|quality| quality.placed.iou),
            map_iou_aligned: quality.map(|quality| quality.aligned.iou),
            wall_error_m: quality.and_then(|quality| quality.placed.wall_error_m),
            map_obstacles: quality.map(|quality| quality.obstacles),
            wall_error_aligned_m: quality.and_then(|quality| quality.aligned.wall_error_m),
            carpet_recall: carpet.recall,
            carpet_precision: carpet.precision,
            estimate_error: Some(swept_m2 / world.home().reachable_area_m2()),
            ..figures
        }
    }

    /// The figures so far.
    #[must_use]
    pub fn report(&self) -> RunReport {
        RunReport {
            pose_rmse_m: self.figures.pose_rmse_m(),
            figures: Some(Box::new(self.all_figures())),
            ..RunReport::of(&self.robot, &self.stuck)
        }
    }
}

fn deliver(robot: &mut Robot, tamper: Option<&mut Tamper>, pending: &mut Vec<u8>) {
    if let Some(tamper) = tamper {
        // The line of a robot whose host keeps up has room for all.
        robot.send(&tamper.pass_to_robot(pending));
    } else if !pending.is_empty() {
        let taken = robot.send(pending);
        pending.drain(..taken);
    }
}
