//! When loads tell of the floor: while the robot drives straight ahead at one speed and nothing else loads its motors.

use std::collections::VecDeque;

use super::usual::{Load, Way, quantile};
use crate::observation::{MotorCurrents, Observation};

/// Loads are looked at over this time, microseconds: the median of it passes over a threshold of up to 6 cm.
const WINDOW_US: u64 = 500_000;
/// The speed is that over this time, microseconds.
const PACE_US: u64 = 200_000;
/// Steady driving lasts this long before its loads count, microseconds: motors are through with what came before.
const SETTLE_US: u64 = 200_000;
/// A brush that was started or changed runs evenly after this time, microseconds.
const SPIN_UP_US: u64 = 1_000_000;
/// Slower driving is backing off, turning or feeling along something.
const PACE_MIN_M_PER_S: f64 = 0.1;
/// Steps of speed: within one, loads are compared.
const PACE_STEP_M_PER_S: f64 = 0.05;
/// Least difference between the wheels that is a curve, and least change of speed that is an acceleration, relative.
const CURVE: f64 = 0.12;
const CHANGE: f64 = 0.12;
/// Time from what happens on the floor to what is told of it, seconds: the motor's own lag and half a report.
const LAG_S: f64 = 0.06;

/// Steady driving.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steady {
    pub(super) way: Way,
    pub(super) load: Load,
    /// So far back the floor is of which the load tells, millimetres.
    pub(super) behind_mm: u8,
}

#[derive(Clone, Copy, Debug)]
struct Moment {
    time_us: u64,
    left_m: f64,
    right_m: f64,
    load: Load,
}

/// Watches for steady driving.
#[derive(Clone, Debug, Default)]
pub(super) struct SteadyWatch {
    moments: VecDeque<Moment>,
    brush_percent: u8,
    brush_since_us: u64,
    /// Since when the driving is steady, and its speed then.
    since: Option<(u64, f64)>,
}

impl SteadyWatch {
    /// Takes an observation in; `None` while its loads tell nothing.
    pub(super) fn take(&mut self, observation: &Observation, brush_percent: Option<u8>) -> Option<Steady> {
        let (Some(currents), Some(percent)) = (observation.currents, brush_percent) else {
            self.begin_anew();
            return None;
        };
        if percent == 0 || is_disturbed(observation) || !is_finite(&currents) {
            self.begin_anew();
            return None;
        }
        let now_us = observation.time_us;
        if self.moments.is_empty() || percent != self.brush_percent {
            (self.brush_percent, self.brush_since_us) = (percent, now_us);
        }
        self.note(observation, currents);
        let since_us = self.follow(now_us)?;
        let from_us = since_us
            .saturating_add(SETTLE_US)
            .max(self.brush_since_us.saturating_add(SPIN_UP_US));
        if now_us < from_us.saturating_add(WINDOW_US) {
            return None;
        }
        let (_, pace_m_per_s) = self.since?;
        Some(self.judge(now_us, pace_m_per_s))
    }

    fn begin_anew(&mut self) {
        self.moments.clear();
        self.since = None;
    }

    fn note(&mut self, observation: &Observation, currents: MotorCurrents) {
        let now_us = observation.time_us;
        self.moments.push_back(Moment {
            time_us: now_us,
            left_m: observation.travel_left_m,
            right_m: observation.travel_right_m,
            load: Load {
                wheels_a: 0.5 * (currents.wheel_left_a.abs() + currents.wheel_right_a.abs()),
                brush_a: currents.brush_main_a.abs(),
            },
        });
        while self
            .moments
            .front()
            .is_some_and(|first| first.time_us.saturating_add(WINDOW_US) < now_us)
        {
            self.moments.pop_front();
        }
    }

    /// Since when the driving is steady, microseconds.
    fn follow(&mut self, now_us: u64) -> Option<u64> {
        let pace_m_per_s = self.straight_pace(now_us);
        self.since = match (self.since, pace_m_per_s) {
            (_, None) => None,
            (Some((since_us, begun)), Some(now)) if (now - begun).abs() <= CHANGE * begun => {
                Some((since_us, begun))
            }
            (_, Some(now)) => Some((now_us, now)),
        };
        self.since.map(|(since_us, _)| since_us)
    }

    /// Present speed, m/s; `None` while it is not known, slow or in a curve.
    fn straight_pace(&self, now_us: u64) -> Option<f64> {
        let last = self.moments.back()?;
        let mut before = self.moments.iter().rev();
        let first = before.find(|moment| moment.time_us.saturating_add(PACE_US) <= now_us)?;
        let time_s = last.time_us.saturating_sub(first.time_us) as f64 * 1e-6;
        let left = (last.left_m - first.left_m) / time_s;
        let right = (last.right_m - first.right_m) / time_s;
        let pace = 0.5 * (left + right);
        let is_straight = pace >= PACE_MIN_M_PER_S && (right - left).abs() <= CURVE * pace;
        is_straight.then_some(pace)
    }

    fn judge(&self, now_us: u64, pace_m_per_s: f64) -> Steady {
        let middle = |of: fn(&Load) -> f32| quantile(self.moments.iter().map(|moment| of(&moment.load)), 0.5);
        let first_us = self.moments.front().map_or(now_us, |first| first.time_us);
        let late_s = 0.5e-6 * now_us.saturating_sub(first_us) as f64 + LAG_S;
        Steady {
            way: Way {
                brush_percent: self.brush_percent,
                pace: (pace_m_per_s / PACE_STEP_M_PER_S + 0.5) as u8,
            },
            load: Load {
                wheels_a: middle(|load| load.wheels_a),
                brush_a: middle(|load| load.brush_a),
            },
            behind_mm: (1000.0 * pace_m_per_s * late_s) as u8,
        }
    }
}

/// Something but the floor loads the motors, or nothing is heard of them.
fn is_disturbed(observation: &Observation) -> bool {
    observation.is_touching()
        || observation.is_at_cliff()
        || observation.wheel_drop
        || observation.docked
        || !observation.link_up
        || !observation.inhibits.is_empty()
}

fn is_finite(currents: &MotorCurrents) -> bool {
    (currents.wheel_left_a + currents.wheel_right_a + currents.brush_main_a).is_finite()
}
