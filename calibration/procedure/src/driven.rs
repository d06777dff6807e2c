//! Values for which motors run: open loop, under leases, and always stopped at the end.

use std::time::Duration;

use rvac_protocol::message::{EncoderProbe, Motor, ProbeTarget, Probed, ProbedContent};
use rvac_units::Throttle;

use crate::arithmetic::{
    Wheels, at_nominal, current_scale_ua, mean_milli, rate_per_s, speed_mm_per_s, stall_ma, travelled,
};
use crate::bench::Bench;
use crate::error::CalibrationError;
use crate::procedure::{READINGS, level};
use crate::robot::{OpenLoop, Watch};
use crate::screen::{Question, Shown, Task};

/// Step of a duty that is raised until the motor turns, and then step of a second pass from two steps below.
const COARSE_PERMILLE: i32 = 50;
const FINE_PERMILLE: i32 = 10;
/// Highest duty that is tried.
const MOST_PERMILLE: i32 = 900;
/// How long each duty is tried, and how long in the second pass, because a slow motor gives few counts.
const TRY: Duration = Duration::from_millis(600);
const TRY_FINE: Duration = Duration::from_millis(1_200);
/// Counts in half of that which mean "turns steadily".
const TURNS: i64 = 3;
/// Pulses of the brush in half of that which mean the same.
const PULSES: i64 = 2;
/// Duty at which a wheel is held fast: a third of what it can pull.
const HELD_PERMILLE: i32 = 300;
/// A wheel that is held fast gets warm: no longer than this.
const HELD_MAX: Duration = Duration::from_secs(20);
const HELD_SHORT: Duration = Duration::from_secs(2);

/// What was counted while motors ran.
struct Counted {
    left: i64,
    right: i64,
    brush: i64,
    elapsed_ms: i64,
}

impl Bench<'_> {
    /// Both wheels are given more and more until they turn.
    pub(super) fn least_duty(&mut self) -> Result<i64, CalibrationError> {
        self.raise(&[Motor::WheelLeft, Motor::WheelRight], |counted| {
            counted.left.abs().min(counted.right.abs()) >= TURNS
        })
    }

    /// Speed of the rims at full duty and nominal voltage: a full pack turns them faster.
    pub(super) fn free_speed(&mut self) -> Result<i64, CalibrationError> {
        let way_nm = self.needed("wheel-distance-per-count")?;
        let wheels = [Motor::WheelLeft, Motor::WheelRight];
        let counted = self.count(&wheels, 1000, Duration::from_millis(1_000))?;
        let way_nm = (counted.left.abs() + counted.right.abs()) * way_nm / 2;
        let found = speed_mm_per_s(way_nm, counted.elapsed_ms)?;
        let pack_mv = self.pack_mv()?;
        let note = format!("{found} mm/s with a pack of {pack_mv} mV");
        self.screen.show(Shown::Note(&note))?;
        Ok(at_nominal(found, pack_mv)?)
    }

    /// Voltage of the pack, with the divider as far as it is known.
    fn pack_mv(&mut self) -> Result<i64, CalibrationError> {
        let assumed = self.catalog.find("battery-scale")?.assumed;
        let scale = self.measured.get("battery-scale").or(assumed);
        let scale_uv = scale.ok_or_else(|| CalibrationError::Needed("battery-scale".to_owned()))?;
        let readings = self.line("battery-voltage", READINGS)?;
        Ok(mean_milli(&readings)? * scale_uv / 1_000_000)
    }

    /// The main brush is given more and more until it turns.
    pub(super) fn brush_least_duty(&mut self) -> Result<i64, CalibrationError> {
        self.raise(&[Motor::BrushMain], |counted| counted.brush >= PULSES)
    }

    /// Pulses of the main brush in a second at full duty.
    pub(super) fn brush_rate(&mut self) -> Result<i64, CalibrationError> {
        let counted = self.count(&[Motor::BrushMain], 1000, Duration::from_secs(3))?;
        Ok(rate_per_s(counted.brush, counted.elapsed_ms)?)
    }

    /// The left wheel pulls while it is held fast; the person reads the ammeter.
    pub(super) fn current_scale(&mut self) -> Result<i64, CalibrationError> {
        let rest_ma = self.number(Question::AtRestMa)?;
        let rest = mean_milli(&self.line("wheel-left-current", READINGS)?)?;
        let readings = self.held_wheel(Task::HoldWheelRead, Watch::UntilTyped(HELD_MAX))?;
        let pulled_ma = self.number(Question::PulledMa)?;
        Ok(current_scale_ua(
            pulled_ma - rest_ma,
            mean_milli(&readings)? - rest,
        )?)
    }

    /// What a held wheel would draw at full duty, which S11 does not allow: its current follows the duty.
    pub(super) fn stall_current(&mut self) -> Result<i64, CalibrationError> {
        let zero = self.needed("wheel-left-current-zero")?;
        let scale_ua = self.needed("wheel-current-scale")?;
        let readings = self.held_wheel(Task::HoldWheel, Watch::For(HELD_SHORT))?;
        let held_milli = mean_milli(&readings)? - zero * 1_000;
        Ok(stall_ma(held_milli, scale_ua, i64::from(HELD_PERMILLE))?)
    }

    /// The left wheel pulls while it is held fast; the readings of its current, once they have settled.
    fn held_wheel(&mut self, task: Task, span: Watch) -> Result<Vec<i64>, CalibrationError> {
        let channel = self.catalog.channel("wheel-left-current")?;
        self.enter(task)?;
        self.hold_on()?;
        self.screen.show(Shown::Duty(HELD_PERMILLE))?;
        self.robot.arm()?;
        let motors = [OpenLoop {
            motor: Motor::WheelLeft,
            throttle: duty(HELD_PERMILLE),
        }];
        let watched = self.robot.watch(ProbeTarget::Analog, &motors, span)?;
        let analog = second_half(&watched).iter();
        Ok(analog
            .filter_map(|probed| match &probed.content {
                ProbedContent::Analog(raw) => Some(level(raw, channel)),
                _ => None,
            })
            .collect())
    }

    /// The least duty at which `turns` is content.
    fn raise(&mut self, motors: &[Motor], turns: impl Fn(&Counted) -> bool) -> Result<i64, CalibrationError> {
        let mut coarse = COARSE_PERMILLE;
        while !turns(&self.count(motors, coarse, TRY)?) {
            coarse += COARSE_PERMILLE;
            if coarse > MOST_PERMILLE {
                return Err(CalibrationError::NothingTurns(MOST_PERMILLE));
            }
        }
        // The longer pass may detect a turn that the shorter one at the previous step missed.
        let mut permille = (coarse - 2 * COARSE_PERMILLE).max(0) + FINE_PERMILLE;
        while permille < coarse && !turns(&self.count(motors, permille, TRY_FINE)?) {
            permille += FINE_PERMILLE;
        }
        Ok(i64::from(permille))
    }

    /// Runs these motors for `span` and counts in the second half of it, when they have come to speed.
    fn count(
        &mut self,
        motors: &[Motor],
        permille: i32,
        span: Duration,
    ) -> Result<Counted, CalibrationError> {
        self.hold_on()?;
        self.screen.show(Shown::Duty(permille))?;
        self.robot.arm()?;
        let motors: Vec<_> = motors
            .iter()
            .map(|motor| OpenLoop {
                motor: *motor,
                throttle: duty(permille),
            })
            .collect();
        let watched = self
            .robot
            .watch(ProbeTarget::Encoders, &motors, Watch::For(span))?;
        let settled = second_half(&watched);
        let ends = settled.first().zip(settled.last());
        let (first, last) = ends.ok_or(CalibrationError::NoReadingDriven)?;
        let (from, to) = (totals(first)?, totals(last)?);
        let wheels = |probe: &EncoderProbe| Wheels {
            left: probe.left,
            right: probe.right,
        };
        let Wheels { left, right } = travelled(wheels(&from), wheels(&to));
        Ok(Counted {
            left,
            right,
            brush: match (from.brush, to.brush) {
                (Some(before), Some(after)) => i64::from(after.wrapping_sub(before)),
                _ => return Err(CalibrationError::NoBrushPulses),
            },
            elapsed_ms: i64::from(last.tick.since(first.tick)),
        })
    }
}

fn totals(probed: &Probed) -> Result<EncoderProbe, CalibrationError> {
    match probed.content {
        ProbedContent::Encoders(totals) => Ok(totals),
        _ => Err(CalibrationError::OtherReading),
    }
}

fn second_half(watched: &[Probed]) -> &[Probed] {
    watched.get(watched.len() / 2..).unwrap_or_default()
}

fn duty(permille: i32) -> Throttle {
    Throttle::saturating_from_millionths(permille * 1_000)
}
