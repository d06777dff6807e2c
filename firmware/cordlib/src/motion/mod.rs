//! Motion control: a `drive` or `motor` under its lease, or a bounded `move`.
//!
//! Everything here is a request. [`crate::permit::MotionPermit::restrict`] decides whether a wheel turns.

mod base;
mod path;
mod wheel;

pub(crate) use path::{MoveLimits, Path};
pub(crate) use wheel::{CONTROL_MS, WheelStatus};

use rvac_protocol::message::{Drive, Gyro, MotionPhase, MoveEnd};
use rvac_units::{Throttle, Tick};

use crate::board::{WheelCounts, WheelDrive};
use crate::parameters::Parameters;
use crate::permit::MotionPermit;
use crate::rules::cliff;
use crate::timing::{Deadline, Periodic};

use base::BaseVelocity;
use wheel::{Haste, SpeedLimit, WheelController, WheelGoal};

/// One of the two driven wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WheelSide {
    Left,
    Right,
}

#[derive(Clone, Copy, Debug)]
enum Activity {
    Idle,
    Drive { target: BaseVelocity, lease: Deadline },
    Direct { left: DirectDuty, right: DirectDuty },
    Path(Path),
}

/// A directly commanded duty with its lease.
#[derive(Clone, Copy, Debug, Default)]
struct DirectDuty {
    duty: Throttle,
    lease: Deadline,
}

/// The wheels for rules and telemetry.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MotionStatus {
    pub(crate) left: WheelStatus,
    pub(crate) right: WheelStatus,
    /// Distance of the robot's centre since the last pass.
    pub(crate) travelled_nm: i32,
}

/// What a control period works on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Period<'a> {
    /// Time since the last one.
    pub(crate) elapsed_ms: u32,
    /// The machine.
    pub(crate) parameters: &'a Parameters,
    /// Gyro, if any.
    pub(crate) gyro: Option<Gyro>,
    /// What is allowed.
    pub(crate) permit: MotionPermit,
}

/// What ended in a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// A `move` ended.
    Move(MoveEnd),
    /// A lease ran out during motion.
    LeaseLost,
}

/// Motion control.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    activity: Activity,
    velocity: BaseVelocity,
    left: WheelController,
    right: WheelController,
    asked: (WheelDrive, WheelDrive),
    period: Periodic,
    last: Tick,
    counts: WheelCounts,
    travelled_nm: i32,
    braked_by_reflex: bool,
}

impl Motion {
    /// At rest.
    pub(crate) fn new(counts: WheelCounts, count_nm: u32, now: Tick) -> Self {
        Self {
            activity: Activity::Idle,
            velocity: BaseVelocity::default(),
            left: WheelController::new(counts.left, count_nm),
            right: WheelController::new(counts.right, count_nm),
            asked: (WheelDrive::Brake, WheelDrive::Brake),
            period: Periodic::starting_at(now.after(CONTROL_MS)),
            last: now,
            counts,
            travelled_nm: 0,
            braked_by_reflex: false,
        }
    }

    /// Starts or renews a `drive`. Returns the ending of a `move` that it replaces.
    pub(crate) fn drive(&mut self, drive: &Drive, now: Tick) -> Option<Ending> {
        let target = BaseVelocity::from(drive);
        let lease = Deadline::at(now.after(u32::from(drive.lease_ms)));
        if let Activity::Drive {
            target: old_target,
            lease: old_lease,
        } = &mut self.activity
        {
            (*old_target, *old_lease) = (target, lease);
            return None;
        }
        self.replace(Activity::Drive { target, lease })
    }

    /// Starts or renews a directly commanded duty. The other wheel keeps its duty.
    pub(crate) fn direct(&mut self, side: WheelSide, duty: Throttle, lease_end: Tick) -> Option<Ending> {
        let lease = Deadline::at(lease_end);
        let new = DirectDuty { duty, lease };
        let (mut left, mut right) = match self.activity {
            Activity::Direct { left, right } => (left, right),
            _ => <(DirectDuty, DirectDuty)>::default(),
        };
        match side {
            WheelSide::Left => left = new,
            WheelSide::Right => right = new,
        }
        let goes_on = matches!(self.activity, Activity::Direct { .. });
        let next = Activity::Direct { left, right };
        if goes_on {
            self.activity = next;
            return None;
        }
        self.replace(next)
    }

    /// Starts a planned `move`. Returns the ending of a `move` that it replaces.
    pub(crate) fn follow(&mut self, path: Path) -> Option<Ending> {
        self.replace(Activity::Path(path))
    }

    fn replace(&mut self, next: Activity) -> Option<Ending> {
        let ending = self.halt(MoveEnd::Replaced);
        self.activity = next;
        ending
    }

    /// Drops all requests: the wheels brake. Returns the ending of a `move`, if one ran.
    pub(crate) fn halt(&mut self, end: MoveEnd) -> Option<Ending> {
        let ending = matches!(self.activity, Activity::Path(_)).then_some(Ending::Move(end));
        self.activity = Activity::Idle;
        self.velocity = BaseVelocity::default();
        self.left.rest();
        self.right.rest();
        self.asked = (WheelDrive::Brake, WheelDrive::Brake);
        self.braked_by_reflex = false;
        ending
    }

    /// As [`Self::halt`], for a reflex: telemetry shows `reflex` until the next command.
    pub(crate) fn brake(&mut self) -> Option<Ending> {
        let was_active = self.is_active();
        let ending = self.halt(MoveEnd::Inhibited);
        self.braked_by_reflex = was_active;
        ending
    }

    /// Whether any motion is requested.
    pub(crate) const fn is_active(&self) -> bool {
        !matches!(self.activity, Activity::Idle)
    }

    /// Whether a lease or the bound of a `move` covers the request.
    pub(crate) const fn is_fresh(&self) -> bool {
        match &self.activity {
            Activity::Idle => false,
            Activity::Drive { lease, .. } => lease.is_running(),
            Activity::Direct { left, right } => left.lease.is_running() || right.lease.is_running(),
            Activity::Path(_) => true,
        }
    }

    /// Whether `permit` allows the direction of the request.
    pub(crate) fn suits(&self, permit: &MotionPermit, parameters: &Parameters) -> bool {
        let (left, right) = match &self.activity {
            Activity::Idle => return true,
            Activity::Drive { target, .. } => return suits_velocity(*target, permit, parameters),
            Activity::Direct { left, right } => (left.duty.millionths(), right.duty.millionths()),
            Activity::Path(path) => return suits_path(path, permit),
        };
        permit.allows_direction(left, right)
    }

    /// Whether a `move` runs.
    pub(crate) const fn is_following(&self) -> bool {
        matches!(self.activity, Activity::Path(_))
    }

    /// What motion control does, for telemetry.
    pub(crate) const fn phase(&self) -> MotionPhase {
        match self.activity {
            Activity::Idle if self.braked_by_reflex => MotionPhase::Reflex,
            Activity::Idle => MotionPhase::Idle,
            Activity::Drive { .. } => MotionPhase::Drive,
            Activity::Direct { .. } => MotionPhase::Motor,
            Activity::Path(_) => MotionPhase::Move,
        }
    }

    /// Notes the distance since the last pass and ends motion whose lease or time is over. Called in every pass.
    pub(crate) fn expire(&mut self, counts: WheelCounts, count_nm: u32, now: Tick) -> Option<Ending> {
        let moved = counts
            .left
            .wrapping_sub(self.counts.left)
            .saturating_add(counts.right.wrapping_sub(self.counts.right));
        self.counts = counts;
        let moved_nm = i64::from(moved).saturating_mul(i64::from(count_nm)) / 2;
        self.travelled_nm = i32::try_from(moved_nm).unwrap_or(0);
        match &mut self.activity {
            Activity::Idle => None,
            Activity::Drive { target, lease } => {
                let moving = *target != BaseVelocity::default() || self.velocity != BaseVelocity::default();
                if !lease.has_come(now) {
                    return None;
                }
                self.halt(MoveEnd::Inhibited);
                moving.then_some(Ending::LeaseLost)
            }
            Activity::Direct { left, right } => {
                let lost = left.expire(now) | right.expire(now);
                if !left.lease.is_running() && !right.lease.is_running() {
                    self.halt(MoveEnd::Inhibited);
                }
                lost.then_some(Ending::LeaseLost)
            }
            Activity::Path(path) => {
                let overdue = path.is_overdue(now);
                overdue.then(|| self.halt(MoveEnd::TimedOut)).flatten()
            }
        }
    }

    /// The length of the control period that has just ended, if one has. The wheels are measured then.
    pub(crate) fn begin_period(&mut self, parameters: &Parameters, now: Tick) -> Option<u32> {
        if !self.period.is_due(now, CONTROL_MS) {
            return None;
        }
        let elapsed_ms = now.since(self.last);
        self.last = now;
        let count_nm = parameters.limits.count_nm;
        self.left.measure(self.counts.left, count_nm, elapsed_ms);
        self.right.measure(self.counts.right, count_nm, elapsed_ms);
        Some(elapsed_ms)
    }

    /// One control period.
    pub(crate) fn control(&mut self, period: &Period<'_>) -> Option<Ending> {
        match self.activity {
            Activity::Idle => {
                self.left.rest();
                self.right.rest();
                None
            }
            Activity::Drive { target, .. } => {
                self.control_drive(target, period);
                None
            }
            Activity::Direct { left, right } => {
                self.asked = (
                    control_direct(&mut self.left, left.duty, period),
                    control_direct(&mut self.right, right.duty, period),
                );
                None
            }
            Activity::Path(path) => self.control_path(path, period),
        }
    }

    fn control_drive(&mut self, target: BaseVelocity, period: &Period<'_>) {
        let (parameters, elapsed_ms) = (period.parameters, period.elapsed_ms);
        self.velocity = self.velocity.ramp_to(target, parameters, elapsed_ms);
        let rims = self.velocity.rims(parameters, period.permit.sees_cliff());
        let goal = |speed_um_per_s| WheelGoal {
            speed_um_per_s,
            lead_nm: 0,
            settle_nm: None,
            haste: haste(&period.permit),
        };
        self.left.advance(distance_nm(rims.left, elapsed_ms));
        self.right.advance(distance_nm(rims.right, elapsed_ms));
        for (wheel, rim) in [(&mut self.left, rims.left), (&mut self.right, rims.right)] {
            wheel.limit_lag();
            if rim == 0 && self.velocity == BaseVelocity::default() {
                wheel.rest();
            }
        }
        self.asked = (
            self.left.control(goal(rims.left), &parameters.wheel),
            self.right.control(goal(rims.right), &parameters.wheel),
        );
    }

    fn control_path(&mut self, mut path: Path, period: &Period<'_>) -> Option<Ending> {
        let (parameters, gyro) = (period.parameters, period.gyro);
        if period.permit.sees_cliff() {
            path.limit_speed(cliff::SPEED_MAX_UM_PER_S);
        }
        let travelled_nm = (self.left.status().travelled_nm, self.right.status().travelled_nm);
        let waits = self.left.is_far_behind() || self.right.is_far_behind();
        let mut step = if waits {
            path.wait(travelled_nm, gyro)
        } else {
            path.step(period.elapsed_ms, travelled_nm, gyro)
        };
        step.left.haste = haste(&period.permit);
        step.right.haste = step.left.haste;
        self.left.advance(step.left_nm);
        self.right.advance(step.right_nm);
        self.activity = Activity::Path(path);
        if path.has_arrived() && self.is_settled(&step, path.settle_nm()) {
            return self.halt(MoveEnd::Done);
        }
        self.asked = (
            self.left.control(step.left, &parameters.wheel),
            self.right.control(step.right, &parameters.wheel),
        );
        None
    }

    /// Whether both wheels have reached their goal and stand still.
    fn is_settled(&self, step: &path::PathStep, tolerance_nm: i32) -> bool {
        [(&self.left, step.left), (&self.right, step.right)]
            .into_iter()
            .all(|(wheel, goal)| {
                let behind_nm = wheel.lag_nm().saturating_add(goal.lead_nm);
                behind_nm.saturating_abs() <= tolerance_nm && !wheel.status().turned
            })
    }

    /// Measured speeds of left and right rim; `None` without calibrated encoders.
    pub(crate) fn rims_um_per_s(&self) -> Option<[i32; 2]> {
        let speeds = [
            self.left.status().speed_um_per_s,
            self.right.status().speed_um_per_s,
        ];
        self.left.is_counted().then_some(speeds)
    }

    /// Drive requested of the bridges until the next control period.
    pub(crate) const fn asked(&self) -> (WheelDrive, WheelDrive) {
        self.asked
    }

    /// Notes what was permitted and written to the bridges.
    pub(crate) const fn applied(&mut self, outputs: (WheelDrive, WheelDrive)) {
        self.left.applied(outputs.0);
        self.right.applied(outputs.1);
    }

    /// The wheels for rules and telemetry.
    pub(crate) const fn status(&self) -> MotionStatus {
        MotionStatus {
            left: self.left.status(),
            right: self.right.status(),
            travelled_nm: self.travelled_nm,
        }
    }
}

impl DirectDuty {
    /// Ends with its lease; true if that stopped the wheel.
    fn expire(&mut self, now: Tick) -> bool {
        let ended = self.lease.has_come(now);
        let stopped = ended && self.duty != Throttle::ZERO;
        if ended {
            self.duty = Throttle::ZERO;
        }
        stopped
    }
}

/// Whether a `drive` is allowed: a pressed bumper or a cliff forbids any forward speed.
pub(crate) fn suits_drive(drive: &Drive, permit: &MotionPermit, parameters: &Parameters) -> bool {
    suits_velocity(BaseVelocity::from(drive), permit, parameters)
}

/// Whether a planned `move` is allowed.
pub(crate) fn suits_path(path: &Path, permit: &MotionPermit) -> bool {
    if permit.inhibits_forward() && path.heading_sign() > 0 {
        return false;
    }
    let (left, right) = path.direction();
    permit.allows_direction(left, right)
}

fn suits_velocity(velocity: BaseVelocity, permit: &MotionPermit, parameters: &Parameters) -> bool {
    if permit.inhibits_forward() && velocity.speed_um_per_s > 0 {
        return false;
    }
    let rims = velocity.rims(parameters, false);
    permit.allows_direction(rims.left, rims.right)
}

/// One period of a directly commanded duty. Beside an edge it is a speed, and limited as every other (S8).
fn control_direct(wheel: &mut WheelController, duty: Throttle, period: &Period<'_>) -> WheelDrive {
    let parameters = &period.parameters.wheel;
    if !period.permit.sees_cliff() || !wheel.is_counted() {
        return wheel.open_loop(duty, parameters);
    }
    let limit = SpeedLimit {
        speed_max_um_per_s: cliff::SPEED_MAX_UM_PER_S,
        elapsed_ms: period.elapsed_ms,
    };
    wheel.closed_loop(duty, limit, parameters)
}

const fn haste(permit: &MotionPermit) -> Haste {
    if permit.sees_cliff() {
        Haste::KeepSpeed
    } else {
        Haste::CatchUp
    }
}

fn distance_nm(speed_um_per_s: i32, elapsed_ms: u32) -> i32 {
    speed_um_per_s.saturating_mul(i32::try_from(elapsed_ms).unwrap_or(i32::MAX))
}
