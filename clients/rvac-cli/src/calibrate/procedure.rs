//! How each value is measured: what the person does, what is read, what comes out.

use std::time::Duration;

use anyhow::{Context as _, bail};
use rvac_protocol::message::{EncoderProbe, Motor, PROBE_CHANNELS, ProbeTarget, ProbedContent};
use rvac_units::Throttle;

use super::arithmetic::{
    count_way_nm, line_order, mean, mean_milli, scale_uv, speed_mm_per_s, spread, track_um, travelled,
};
use super::catalog::{Catalog, Item};
use super::dialog::Dialog;
use super::file::Measurements;
use crate::robot::Robot;

/// Readings whose mean is a value.
const READINGS: usize = 100;
/// Step of a duty that is raised until something turns.
const DUTY_STEP_PERMILLE: i32 = 10;
/// Highest duty that is tried.
const DUTY_MAX_PERMILLE: i32 = 900;
/// Counts within a step that mean "turns steadily".
const TURNS: i64 = 5;

/// A side of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// The closed set of ways to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Procedure {
    /// Pushed a metre by hand.
    Push,
    /// Turned ten times by hand.
    Spin,
    /// One wheel turned forward by hand.
    Order(Side),
    /// The duty of both wheels is raised until they turn.
    LeastDuty,
    /// Both wheels at full duty for a moment.
    FreeSpeed,
    /// Mean of a line of the converter.
    Mean(&'static str),
    /// Mean difference of two lines, in hundredths.
    Difference(&'static str, &'static str),
    /// A voltage at the multimeter against the mean of a line.
    Voltage(&'static str),
    /// Spread of a line that a multiplexer switches through all its sensors.
    Spread(&'static str),
    /// The person reads it off and types it.
    Typed,
}

impl Procedure {
    /// How the value of this name is measured.
    pub(crate) fn of(name: &str) -> Self {
        match name {
            "wheel-count-way" => Self::Push,
            "wheel-track" => Self::Spin,
            "wheel-left-order" => Self::Order(Side::Left),
            "wheel-right-order" => Self::Order(Side::Right),
            "wheel-dead-band" => Self::LeastDuty,
            "wheel-free-speed" => Self::FreeSpeed,
            "wheel-left-current-zero" => Self::Mean("wheel-left-current"),
            "wheel-right-current-zero" => Self::Mean("wheel-right-current"),
            "button-ladder-1" | "button-ladder-2" | "button-ladder-3" => Self::Mean("button-ladder"),
            "charge-current-zero" => Self::Difference("charger-voltage", "battery-voltage"),
            "battery-scale" => Self::Voltage("battery-voltage"),
            "proximity-none" => Self::Spread("proximity-receive"),
            _ => Self::Typed,
        }
    }

    /// Whether the robot moves by itself, which a person must know beforehand.
    pub(crate) const fn moves(self) -> bool {
        matches!(self, Self::LeastDuty | Self::FreeSpeed)
    }
}

/// What a procedure works with.
pub(crate) struct Bench<'a> {
    /// The robot.
    pub(crate) robot: &'a mut Robot,
    /// What can be measured.
    pub(crate) catalog: &'a Catalog,
    /// What was measured so far.
    pub(crate) measured: &'a Measurements,
}

impl Bench<'_> {
    /// Measures a value once the person is ready.
    pub(crate) fn measure(&mut self, item: &Item) -> anyhow::Result<i64> {
        match Procedure::of(&item.name) {
            Procedure::Push => {
                let moved = self.moved_by_hand("Push it one metre straight ahead, then press Enter.")?;
                Ok(count_way_nm(moved, 1_000)?)
            }
            Procedure::Spin => {
                let way_nm = self.needed("wheel-count-way")?;
                let moved = self.moved_by_hand("Turn it ten times around on the spot, then press Enter.")?;
                Ok(track_um(moved, 10, way_nm)?)
            }
            Procedure::Order(side) => {
                let moved = self.moved_by_hand("Turn the wheel forward by half a turn, then press Enter.")?;
                Ok(line_order(match side {
                    Side::Left => moved.0,
                    Side::Right => moved.1,
                })?)
            }
            Procedure::LeastDuty => self.least_duty(),
            Procedure::FreeSpeed => self.free_speed(),
            Procedure::Mean(signal) => Ok(mean(&self.line(signal)?)?),
            Procedure::Difference(more, less) => {
                let (more, less) = (self.catalog.channel(more)?, self.catalog.channel(less)?);
                let readings = self.readings(|raw| level(raw, more) - level(raw, less))?;
                Ok(mean_milli(&readings)? / 10)
            }
            Procedure::Voltage(signal) => {
                let volts = Dialog::number(self.robot, "What does the multimeter show, in millivolts?")?;
                Ok(scale_uv(volts, mean_milli(&self.line(signal)?)?)?)
            }
            Procedure::Spread(signal) => Ok(spread(&self.line(signal)?)?),
            Procedure::Typed => Dialog::number(self.robot, &format!("The value, in {}?", item.unit)),
        }
    }

    /// A value that another one is reckoned from.
    fn needed(&self, name: &str) -> anyhow::Result<i64> {
        self.measured
            .get(name)
            .with_context(|| format!("{name} must be measured first"))
    }

    fn line(&mut self, signal: &str) -> anyhow::Result<Vec<i64>> {
        let channel = self.catalog.channel(signal)?;
        self.readings(|raw| level(raw, channel))
    }

    fn readings(&mut self, of: impl Fn(&[u16; PROBE_CHANNELS]) -> i64) -> anyhow::Result<Vec<i64>> {
        let mut readings = Vec::with_capacity(READINGS);
        while readings.len() < READINGS {
            match self.robot.probe(ProbeTarget::Analog)? {
                ProbedContent::Analog(raw) => readings.push(of(&raw)),
                other => bail!("the robot answered with something else: {other:?}"),
            }
        }
        Ok(readings)
    }

    fn totals(&mut self) -> anyhow::Result<(i32, i32)> {
        match self.robot.probe(ProbeTarget::Encoders)? {
            ProbedContent::Encoders(EncoderProbe { left, right, .. }) => Ok((left, right)),
            other => bail!("the robot answered with something else: {other:?}"),
        }
    }

    fn moved_by_hand(&mut self, wish: &str) -> anyhow::Result<(i64, i64)> {
        let before = self.totals()?;
        Dialog::enter(self.robot, wish)?;
        Ok(travelled(before, self.totals()?))
    }

    /// Counts of both wheels, and the time they took in ms, while both run with `duty`: of the second half of `span`, when
    /// they have come to speed.
    fn counts_at(&mut self, duty: Throttle, span: Duration) -> anyhow::Result<((i64, i64), i64)> {
        self.robot.arm()?;
        let motors = [(Motor::WheelLeft, duty), (Motor::WheelRight, duty)];
        let watched = self.robot.watch(ProbeTarget::Encoders, &motors, span)?;
        let settled = watched.get(watched.len() / 2..).unwrap_or_default();
        let (Some(first), Some(last)) = (settled.first(), settled.last()) else {
            bail!("no reading came while the wheels ran");
        };
        let (ProbedContent::Encoders(from), ProbedContent::Encoders(to)) = (&first.content, &last.content)
        else {
            bail!("the robot answered with something else");
        };
        let counts = travelled((from.left, from.right), (to.left, to.right));
        Ok((counts, i64::from(last.tick.since(first.tick))))
    }

    fn least_duty(&mut self) -> anyhow::Result<i64> {
        for permille in (DUTY_STEP_PERMILLE..=DUTY_MAX_PERMILLE).step_by(DUTY_STEP_PERMILLE as usize) {
            let duty = Throttle::saturating_from_millionths(permille * 1_000);
            let ((left, right), _) = self.counts_at(duty, Duration::from_millis(400))?;
            if left.abs().min(right.abs()) >= TURNS {
                return Ok(i64::from(permille));
            }
        }
        bail!("the wheels do not turn at {DUTY_MAX_PERMILLE} permille: are motors and encoders plugged in?")
    }

    fn free_speed(&mut self) -> anyhow::Result<i64> {
        let way_nm = self.needed("wheel-count-way")?;
        let full = Throttle::saturating_from_millionths(1_000_000);
        let ((left, right), elapsed_ms) = self.counts_at(full, Duration::from_millis(1_000))?;
        Ok(speed_mm_per_s(
            (left.abs() + right.abs()) * way_nm / 2,
            elapsed_ms,
        )?)
    }
}

fn level(raw: &[u16; PROBE_CHANNELS], channel: usize) -> i64 {
    raw.get(channel).copied().map_or(0, i64::from)
}
