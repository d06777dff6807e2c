//! Speed of one wheel: measurement from encoder counts, and a PI controller whose integral is the wheel's position lag,
//! exact to the count, so that it never drifts.

use rvac_units::Throttle;

use crate::board::WheelDrive;
use crate::limit::within;
use crate::parameters::WheelParameters;

/// Length of a control period.
pub(crate) const CONTROL_MS: u32 = 10;
/// Limit of the position lag under speed control (anti-windup): a wheel that was blocked does not catch up more than this.
const LAG_MAX_NM: i32 = 15_000_000;
/// Weight of the newest speed sample is one in this many.
const FILTER: i32 = 4;
/// Most that a duty changes in one control period, in millionths: from rest to full in 0.2 s.
const SLEW: i32 = 50_000;

/// Most that a position lag adds to the duty while the speed is a limit, in millionths: some 15 mm/s.
const LAG_DUTY_MAX: i64 = 50_000;

/// A wheel that turns faster than this is braked before a commanded duty drives it the other way.
const REVERSAL_UM_PER_S: i32 = 50_000;
/// If the speed is not known, the wheel brakes for this long instead: 0.4 s.
const BLIND_REST_PERIODS: u8 = 40;

/// One wheel as the rules and the telemetry see it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct WheelStatus {
    /// Duty that is applied, in millionths.
    pub(crate) duty: i32,
    /// Set point of the speed control; `Some(0)` at rest, `None` while the duty is commanded directly.
    pub(crate) set_point_um_per_s: Option<i32>,
    /// Measured speed, filtered.
    pub(crate) speed_um_per_s: i32,
    /// Speed that corresponds to one count in one control period: the resolution of the measurement.
    pub(crate) speed_step_um_per_s: i32,
    /// Distance in the last control period.
    pub(crate) travelled_nm: i32,
    /// Whether the encoder counted in the last control period.
    pub(crate) turned: bool,
}

impl WheelStatus {
    /// Whether the wheel still turns noticeably.
    pub(crate) fn is_turning(&self) -> bool {
        self.speed_um_per_s.saturating_abs() > self.speed_step_um_per_s.max(20_000)
    }
}

/// Controller of one wheel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WheelController {
    count: i32,
    lag_nm: i32,
    behind_nm: i32,
    duty: i32,
    status: WheelStatus,
    /// The distance per count is known, and with it the speed.
    counted: bool,
    /// Control periods for which a wheel of unknown speed still brakes before it reverses.
    coming_to_rest: u8,
}

/// What the wheel should do in one control period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WheelGoal {
    /// Speed.
    pub(crate) speed_um_per_s: i32,
    /// Distance by which the wheel is to lead its encoder count, from another sensor.
    pub(crate) lead_nm: i32,
    /// Position tolerance at rest, or `None` to let the wheel stop anywhere.
    pub(crate) settle_nm: Option<i32>,
    /// Whether the wheel may be driven faster than the goal to make up for a lag.
    pub(crate) haste: Haste,
}

/// How much a position lag may speed a wheel up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Haste {
    /// As much as the integral gain gives.
    CatchUp,
    /// Hardly: beside an edge the speed is a limit (S8).
    KeepSpeed,
}

/// A speed limit of a directly commanded duty in one control period.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpeedLimit {
    /// The limit.
    pub(crate) speed_max_um_per_s: i32,
    /// Length of the period.
    pub(crate) elapsed_ms: u32,
}

impl WheelController {
    /// Starts where the encoder stands.
    pub(crate) fn new(count: i32, count_nm: u32) -> Self {
        let step = i64::from(count_nm) / i64::from(CONTROL_MS);
        Self {
            count,
            counted: count_nm > 0,
            status: WheelStatus {
                set_point_um_per_s: Some(0),
                speed_step_um_per_s: saturate(step),
                ..WheelStatus::default()
            },
            ..Self::default()
        }
    }

    /// Takes the encoder total once for each control period.
    pub(crate) fn measure(&mut self, count: i32, count_nm: u32, elapsed_ms: u32) {
        let counts = count.wrapping_sub(self.count);
        self.count = count;
        let travelled_nm = saturate(i64::from(counts).saturating_mul(i64::from(count_nm)));
        let speed = travelled_nm / i32::try_from(elapsed_ms.max(1)).unwrap_or(i32::MAX);
        let change = speed.saturating_sub(self.status.speed_um_per_s);
        let settled = change.saturating_abs() < FILTER;
        let step = if settled { change } else { change / FILTER };
        self.status.speed_um_per_s = self.status.speed_um_per_s.saturating_add(step);
        self.status.travelled_nm = travelled_nm;
        self.status.turned = counts != 0;
        self.lag_nm = self.lag_nm.saturating_sub(travelled_nm);
    }

    /// Comes to rest and drops the position lag.
    pub(crate) fn rest(&mut self) {
        self.lag_nm = 0;
        self.behind_nm = 0;
        self.duty = 0;
        self.status.set_point_um_per_s = Some(0);
    }

    /// Advances the set point by the distance of this period.
    pub(crate) fn advance(&mut self, distance_nm: i32) {
        self.lag_nm = self.lag_nm.saturating_add(distance_nm);
    }

    /// Limits the position lag (anti-windup).
    pub(crate) fn limit_lag(&mut self) {
        self.lag_nm = within(self.lag_nm, -LAG_MAX_NM, LAG_MAX_NM);
    }

    /// Position lag of the wheel.
    pub(crate) const fn lag_nm(&self) -> i32 {
        self.lag_nm
    }

    /// Whether the lag is so large that the set point should wait.
    pub(crate) fn is_far_behind(&self) -> bool {
        let direction = self.status.set_point_um_per_s.unwrap_or(0).signum();
        self.behind_nm.saturating_mul(direction) > LAG_MAX_NM
    }

    /// The duty for this period: feed-forward over the dead band, the speed error, and the position lag. It never opposes
    /// the direction of the set point: a wheel that is too fast brakes.
    pub(crate) fn control(&mut self, goal: WheelGoal, parameters: &WheelParameters) -> WheelDrive {
        self.status.set_point_um_per_s = Some(goal.speed_um_per_s);
        let behind_nm = self.lag_nm.saturating_add(goal.lead_nm);
        self.behind_nm = behind_nm;
        let direction = match goal.settle_nm {
            _ if goal.speed_um_per_s != 0 => goal.speed_um_per_s.signum(),
            Some(tolerance_nm) if behind_nm.saturating_abs() > tolerance_nm => behind_nm.signum(),
            _ => 0,
        };
        let asked = self.duty_for(goal, behind_nm, parameters);
        let along = i64::from(asked).saturating_mul(i64::from(direction));
        if direction == 0 || along <= 0 {
            self.duty = 0;
            return WheelDrive::Brake;
        }
        let dead_band = parameters.dead_band.millionths();
        let wanted = saturate(along).saturating_add(dead_band).min(1_000_000);
        self.duty = self.slew(wanted.saturating_mul(direction), dead_band);
        WheelDrive::Duty(Throttle::saturating_from_millionths(self.duty))
    }

    /// A directly commanded duty as a speed that is controlled, at most as fast as `limit`.
    pub(crate) fn closed_loop(
        &mut self,
        duty: Throttle,
        limit: SpeedLimit,
        parameters: &WheelParameters,
    ) -> WheelDrive {
        let most = limit.speed_max_um_per_s;
        let speed_um_per_s = within(parameters.speed_at(duty), most.saturating_neg(), most);
        let elapsed_ms = i32::try_from(limit.elapsed_ms).unwrap_or(i32::MAX);
        if speed_um_per_s == 0 {
            self.rest();
        }
        self.advance(speed_um_per_s.saturating_mul(elapsed_ms));
        self.limit_lag();
        let goal = WheelGoal {
            speed_um_per_s,
            lead_nm: 0,
            settle_nm: None,
            haste: Haste::KeepSpeed,
        };
        self.control(goal, parameters)
    }

    /// A directly commanded duty, reached with a ramp.
    pub(crate) fn open_loop(&mut self, duty: Throttle, parameters: &WheelParameters) -> WheelDrive {
        self.status.set_point_um_per_s = None;
        self.lag_nm = 0;
        let along = self
            .status
            .speed_um_per_s
            .saturating_mul(duty.millionths().signum());
        let opposite = self.duty.signum() * duty.millionths().signum() < 0;
        if opposite && !self.counted {
            self.coming_to_rest = BLIND_REST_PERIODS;
        }
        let rests = self.coming_to_rest > 0;
        self.coming_to_rest = self.coming_to_rest.saturating_sub(1);
        self.duty = if rests || along < -REVERSAL_UM_PER_S {
            0
        } else {
            self.slew(duty.millionths(), parameters.dead_band.millionths())
        };
        if self.duty == 0 {
            return WheelDrive::Brake;
        }
        WheelDrive::Duty(Throttle::saturating_from_millionths(self.duty))
    }

    /// Notes what was applied after the permit.
    pub(crate) const fn applied(&mut self, drive: WheelDrive) {
        self.status.duty = drive.duty().millionths();
        if self.status.duty == 0 {
            self.duty = 0;
        }
    }

    /// Whether its speed is known.
    pub(crate) const fn is_counted(&self) -> bool {
        self.counted
    }

    /// The wheel for rules and telemetry.
    pub(crate) const fn status(&self) -> WheelStatus {
        self.status
    }

    fn duty_for(&self, goal: WheelGoal, behind_nm: i32, parameters: &WheelParameters) -> i32 {
        let span = i64::from(1_000_000_i32.saturating_sub(parameters.dead_band.millionths()));
        let full = i64::from(parameters.speed_at_full.0.max(1));
        let speed = i64::from(goal.speed_um_per_s);
        let error = speed.saturating_sub(i64::from(self.status.speed_um_per_s));
        let forward = speed.saturating_mul(span) / full;
        let proportional = error.saturating_mul(i64::from(parameters.proportional)) / 1_000;
        let integral = i64::from(behind_nm).saturating_mul(i64::from(parameters.integral)) / 1_000_000;
        let integral = match goal.haste {
            Haste::CatchUp => integral,
            Haste::KeepSpeed if speed < 0 => integral.max(-LAG_DUTY_MAX),
            Haste::KeepSpeed => integral.min(LAG_DUTY_MAX),
        };
        saturate(forward.saturating_add(proportional).saturating_add(integral))
    }

    /// One step towards the wanted duty. The dead band is skipped, because the motor does not turn within it.
    fn slew(&self, wanted: i32, dead_band: i32) -> i32 {
        let from = if self.duty.signum() == wanted.signum() {
            self.duty
        } else {
            dead_band.saturating_mul(wanted.signum())
        };
        within(wanted, from.saturating_sub(SLEW), from.saturating_add(SLEW))
    }
}

fn saturate(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}
