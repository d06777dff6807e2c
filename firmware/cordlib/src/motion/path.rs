//! A `move`: a straight line, an arc, or a turn on the spot, with a trapezoidal speed profile, ending on encoder counts.
//!
//! The wheel with the longer path sets the pace; the other follows in proportion. The reference waits for a wheel that lags
//! far behind, so that a heavy carpet costs time and not length. With a gyro the heading follows the gyro, within a limit
//! around what the encoders show.

use rvac_protocol::message::{Gyro, Move};
use rvac_units::{Angle, Tick};

use crate::limit::within;
use crate::parameters::Parameters;

use super::wheel::{Haste, WheelGoal};

/// Slowest speed of the reference, so that it always arrives, in µm/s.
const CREEP_UM_PER_S: i64 = 5_000;
/// Shares are fixed-point fractions of 2^20.
const SHARE_BITS: u32 = 20;
/// The gyro may correct the heading by this much plus a fifth of the turn so far.
const GYRO_TRUST_URAD: i64 = 50_000;
/// Least tolerance at the end; otherwise 1.5 encoder counts.
const SETTLE_MIN_NM: i64 = 700_000;
const TIMEOUT_SLACK_MS: i64 = 2_000;

/// Limits of one move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MoveLimits {
    /// Speed of the centre, in µm/s.
    pub(crate) speed_um_per_s: i32,
    /// Turn rate, in µrad/s.
    pub(crate) turn_urad_per_s: i32,
}

/// A path in execution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    /// Path length of the centre, signed.
    length_um: i64,
    left_share: i64,
    right_share: i64,
    /// Path length of the faster rim: in total and so far.
    end_nm: i64,
    made_nm: i64,
    speed_um_per_s: i64,
    speed_max_um_per_s: i64,
    acceleration_um_per_s2: i64,
    half_track_um: i64,
    settle_nm: i32,
    heading_start: Option<Angle>,
    encoder_turn_nm: i64,
    timeout: Tick,
}

/// What one period of a path asks of the wheels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathStep {
    /// Distance of the left reference in this period.
    pub(crate) left_nm: i32,
    /// Distance of the right reference in this period.
    pub(crate) right_nm: i32,
    /// Goal of the left wheel.
    pub(crate) left: WheelGoal,
    /// Goal of the right wheel.
    pub(crate) right: WheelGoal,
}

impl Path {
    /// Plans a move. `None` if there is nothing to do.
    pub(crate) fn plan(
        movement: &Move,
        pace: MoveLimits,
        parameters: &Parameters,
        start: (Tick, Option<Gyro>),
    ) -> Option<Self> {
        let asked = i64::from(movement.length.0);
        let (length_um, turn_urad) = match movement.radius.map(|radius| i64::from(radius.0)) {
            None => (asked, 0),
            Some(0) => (0, asked),
            Some(radius_um) => (asked, asked.saturating_mul(1_000_000) / radius_um),
        };
        let half_track_um = i64::from(parameters.limits.track.0 / 2);
        let swing_nm = turn_urad.saturating_mul(half_track_um) / 1_000;
        let length_nm = length_um.saturating_mul(1_000);
        let (left_nm, right_nm) = (
            length_nm.saturating_sub(swing_nm),
            length_nm.saturating_add(swing_nm),
        );
        let end_nm = left_nm.saturating_abs().max(right_nm.saturating_abs());
        if end_nm < 1_000 {
            return None;
        }
        let end_um = end_nm / 1_000;
        let motion = &parameters.motion;
        let per_rim = |speed: i32, turn: i32| {
            let by_speed = i64::from(speed).saturating_mul(end_um) / length_um.saturating_abs().max(1);
            let by_turn = i64::from(turn).saturating_mul(end_um) / turn_urad.saturating_abs().max(1);
            by_speed.min(by_turn)
        };
        let speed_max = within(
            per_rim(pace.speed_um_per_s, pace.turn_urad_per_s),
            CREEP_UM_PER_S,
            i64::from(parameters.wheel.speed_at_full.0).max(CREEP_UM_PER_S),
        );
        let acceleration = per_rim(
            motion.acceleration_um_per_s2,
            motion.turn_acceleration_urad_per_s2,
        )
        .max(10_000);
        let planned_ms = end_nm / speed_max + speed_max.saturating_mul(1_000) / acceleration;
        let timeout_ms = planned_ms.saturating_mul(2).saturating_add(TIMEOUT_SLACK_MS);
        let count_nm = i64::from(parameters.limits.count_nm);
        Some(Self {
            length_um,
            left_share: share(left_nm, end_nm),
            right_share: share(right_nm, end_nm),
            end_nm,
            made_nm: 0,
            speed_um_per_s: 0,
            speed_max_um_per_s: speed_max,
            acceleration_um_per_s2: acceleration,
            half_track_um,
            settle_nm: narrow((count_nm + count_nm / 2).max(SETTLE_MIN_NM)),
            heading_start: start.1.map(|gyro| gyro.heading),
            encoder_turn_nm: 0,
            timeout: start
                .0
                .after(u32::try_from(timeout_ms).unwrap_or(1 << 30).min(1 << 30)),
        })
    }

    /// Directions of the two wheels, by sign.
    pub(crate) const fn direction(&self) -> (i32, i32) {
        (self.left_share.signum() as i32, self.right_share.signum() as i32)
    }

    /// Whether the centre goes forward, 1, back, -1, or stays, 0.
    pub(crate) const fn heading_sign(&self) -> i32 {
        self.length_um.signum() as i32
    }

    /// Whether it takes too long.
    pub(crate) const fn is_overdue(&self, now: Tick) -> bool {
        now.reached(self.timeout)
    }

    /// Whether the reference has arrived.
    pub(crate) const fn has_arrived(&self) -> bool {
        self.made_nm >= self.end_nm
    }

    /// Tolerance of a wheel's position at the end.
    pub(crate) const fn settle_nm(&self) -> i32 {
        self.settle_nm
    }

    /// Slows the reference down to `limit`.
    pub(crate) fn limit_speed(&mut self, limit_um_per_s: i32) {
        self.speed_max_um_per_s = self.speed_max_um_per_s.min(i64::from(limit_um_per_s));
    }

    /// One control period. `travelled_nm` is the distance of the left and right rim in it. A waiting reference does not
    /// advance.
    pub(crate) fn step(&mut self, elapsed_ms: u32, travelled_nm: (i32, i32), gyro: Option<Gyro>) -> PathStep {
        let turned_nm = i64::from(travelled_nm.1).saturating_sub(i64::from(travelled_nm.0));
        self.encoder_turn_nm = self.encoder_turn_nm.saturating_add(turned_nm);
        let distance_nm = self.advance(i64::from(elapsed_ms));
        let lead_nm = self.gyro_lead_nm(gyro);
        let goal = |share: i64, lead_nm: i32| WheelGoal {
            speed_um_per_s: narrow(of_share(self.speed_um_per_s, share)),
            lead_nm,
            settle_nm: Some(self.settle_nm),
            haste: Haste::CatchUp,
        };
        PathStep {
            left_nm: narrow(of_share(distance_nm, self.left_share)),
            right_nm: narrow(of_share(distance_nm, self.right_share)),
            left: goal(self.left_share, lead_nm.saturating_neg()),
            right: goal(self.right_share, lead_nm),
        }
    }

    /// A period in which the reference waits for the wheels.
    pub(crate) fn wait(&mut self, travelled_nm: (i32, i32), gyro: Option<Gyro>) -> PathStep {
        self.speed_um_per_s = (self.speed_um_per_s / 2).max(CREEP_UM_PER_S);
        self.step(0, travelled_nm, gyro)
    }

    fn advance(&mut self, elapsed_ms: i64) -> i64 {
        let left_nm = self.end_nm.saturating_sub(self.made_nm);
        if left_nm <= 0 {
            self.speed_um_per_s = 0;
            return 0;
        }
        let faster = self
            .speed_um_per_s
            .saturating_add(self.acceleration_um_per_s2.saturating_mul(elapsed_ms) / 1_000);
        let stoppable = stopping_speed(self.acceleration_um_per_s2, left_nm / 1_000);
        self.speed_um_per_s = faster
            .min(self.speed_max_um_per_s)
            .min(stoppable)
            .max(CREEP_UM_PER_S);
        let distance_nm = self.speed_um_per_s.saturating_mul(elapsed_ms).min(left_nm);
        self.made_nm = self.made_nm.saturating_add(distance_nm);
        distance_nm
    }

    /// Distance by which the right wheel must lead its encoder count, and the left must lag, so that the heading agrees
    /// with the gyro.
    fn gyro_lead_nm(&self, gyro: Option<Gyro>) -> i32 {
        let (Some(start), Some(gyro)) = (self.heading_start, gyro) else {
            return 0;
        };
        let track_um = self.half_track_um.saturating_mul(2).max(1);
        let encoder_urad = self.encoder_turn_nm.saturating_mul(1_000) / track_um;
        let gyro_urad = i64::from(gyro.heading.0.wrapping_sub(start.0));
        let trust = GYRO_TRUST_URAD.saturating_add(encoder_urad.saturating_abs() / 5);
        let excess = within(encoder_urad.saturating_sub(gyro_urad), -trust, trust);
        narrow(excess.saturating_mul(self.half_track_um) / 1_000)
    }
}

/// Highest speed from which the robot can stop within the distance.
fn stopping_speed(acceleration_um_per_s2: i64, distance_um: i64) -> i64 {
    let square = acceleration_um_per_s2
        .saturating_mul(2)
        .saturating_mul(distance_um);
    i64::try_from(u64::try_from(square).unwrap_or(0).isqrt()).unwrap_or(i64::MAX)
}

fn share(part_nm: i64, whole_nm: i64) -> i64 {
    part_nm.saturating_mul(1 << SHARE_BITS) / whole_nm.max(1)
}

const fn of_share(value: i64, share: i64) -> i64 {
    value.saturating_mul(share) >> SHARE_BITS
}

fn narrow(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}
