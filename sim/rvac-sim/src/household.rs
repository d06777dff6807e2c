//! A robot and its host in one process, on a virtual clock.

use home::Pose;

use crate::report::{Driven, Report, RootMeanSquare, StuckWatch};
use crate::{Host, Robot};

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
    error: RootMeanSquare,
    stuck: StuckWatch,
}

impl Household {
    /// Puts a robot and a host together.
    #[must_use]
    pub fn new(robot: Robot, host: Host) -> Self {
        let map_from_plan = robot.world().truth().pose.inverse();
        Self {
            robot,
            host: Some(host),
            from_robot: Vec::new(),
            map_from_plan,
            error: RootMeanSquare::default(),
            stuck: StuckWatch::default(),
        }
    }

    /// Advances one millisecond.
    pub fn tick(&mut self) {
        self.from_robot.clear();
        self.robot.tick(&mut self.from_robot);
        let now_us = self.now_us();
        if let Some(host) = &mut self.host {
            host.step(now_us, &self.from_robot);
            deliver(&mut self.robot, host.pending());
        }
        if self.robot.now_ms().is_multiple_of(SAMPLE_MS) {
            self.sample();
        }
    }

    /// Advances `ms` milliseconds.
    pub fn pass_ms(&mut self, ms: u64) {
        for _ in 0..ms {
            self.tick();
        }
    }

    /// The virtual clock in microseconds.
    #[must_use]
    pub const fn now_us(&self) -> u64 {
        self.robot.now_ms() * TICK_US
    }

    fn sample(&mut self) {
        let driven = Driven::of(&self.robot);
        self.stuck
            .watch(SAMPLE_MS as u32, self.robot.world().truth(), driven);
        if let Some(host) = &self.host {
            let believed = host.pose();
            let truth = self.map_from_plan.then(self.robot.world().truth().pose);
            self.error
                .add((believed.x - truth.x_m).hypot(believed.y - truth.y_m));
        }
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

    /// Asks the host for something; without a host nobody hears it.
    pub fn ask(&mut self, body: rvac_api::RequestBody) {
        let now_us = self.now_us();
        if let Some(host) = &mut self.host {
            host.ask(now_us, body);
            deliver(&mut self.robot, host.pending());
        }
    }

    /// The figures so far.
    #[must_use]
    pub fn report(&self) -> Report {
        Report {
            pose_rmse_m: self.error.value(),
            ..Report::of(&self.robot, &self.stuck)
        }
    }
}

fn deliver(robot: &mut Robot, pending: &mut Vec<u8>) {
    if !pending.is_empty() {
        let taken = robot.send(pending);
        pending.drain(..taken);
    }
}
