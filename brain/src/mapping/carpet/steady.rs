//! When loads tell of the floor: while the robot drives straight ahead at one speed and nothing else loads its motors.

use std::collections::VecDeque;

use super::usual::{Load, Way, quantile};
use crate::model::observation::{MotorCurrents, Observation};

/// Loads are looked at over this time, microseconds: the median of it passes over what is shorter than 3 cm.
const WINDOW_US: u64 = 250_000;
/// The speed is that over this time, microseconds.
const PACE_US: u64 = 120_000;
/// Steady driving lasts this long before its loads count, microseconds: motors are through with what came before.
const SETTLE_US: u64 = 80_000;
/// A brush that was started or changed runs evenly after this time, microseconds.
const SPIN_UP_US: u64 = 600_000;
/// Slower driving is backing off, turning or feeling along something.
const PACE_MIN_M_PER_S: f64 = 0.1;
/// Steps of speed: within one, loads are compared.
const PACE_STEP_M_PER_S: f64 = 0.05;
/// Least difference between the wheels that is a curve, and least change of speed that is an acceleration, relative.
const CURVE: f64 = 0.3;
const CHANGE: f64 = 0.2;
/// Time from what happens on the floor to what is told of it, seconds: the motor's own lag and half a report.
const LAG_S: f64 = 0.06;

/// What the motors draw on the way of the last moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drawn {
    /// How the robot drives; `None` while that is not steady, and loads tell little.
    pub(super) way: Option<Way>,
    pub(super) brush_percent: u8,
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
    /// Takes an observation in; `None` while its loads tell nothing at all.
    pub(super) fn take(&mut self, observation: &Observation, brush_percent: Option<u8>) -> Option<Drawn> {
        let currents = observation.currents.filter(is_finite);
        let brush_percent = brush_percent.filter(|percent| *percent > 0);
        let (Some(currents), Some(percent)) = (currents, brush_percent) else {
            self.begin_anew();
            return None;
        };
        if observation.wheel_drop || observation.docked || !observation.link_up {
            self.begin_anew();
            return None;
        }
        let now_us = observation.time_us;
        if self.moments.is_empty() || percent != self.brush_percent {
            (self.brush_percent, self.brush_since_us) = (percent, now_us);
        }
        self.note(observation, currents);
        if is_disturbed(observation) {
            self.since = None;
        } else {
            self.follow(now_us);
        }
        (now_us >= self.brush_since_us.saturating_add(SPIN_UP_US)).then(|| self.drawn(now_us))
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

    fn follow(&mut self, now_us: u64) {
        self.since = match (self.since, self.straight_pace(now_us)) {
            (_, None) => None,
            (Some((since_us, begun)), Some(now)) if (now - begun).abs() <= CHANGE * begun => {
                Some((since_us, begun))
            }
            (_, Some(now)) => Some((now_us, now)),
        };
    }

    /// Present speed, m/s; `None` while it is not known, slow or in a curve.
    fn straight_pace(&self, now_us: u64) -> Option<f64> {
        let [left, right] = self.rims_m_per_s(now_us)?;
        let budget = 0.5 * (left + right);
        let is_straight = budget >= PACE_MIN_M_PER_S && (right - left).abs() <= CURVE * budget;
        is_straight.then_some(budget)
    }

    /// Speeds of the left and the right wheel's rim.
    fn rims_m_per_s(&self, now_us: u64) -> Option<[f64; 2]> {
        let last = self.moments.back()?;
        let mut before = self.moments.iter().rev();
        let first = before.find(|moment| moment.time_us.saturating_add(PACE_US) <= now_us)?;
        let time_s = last.time_us.saturating_sub(first.time_us) as f64 * 1e-6;
        let speed = |way_m: f64| way_m / time_s;
        Some([
            speed(last.left_m - first.left_m),
            speed(last.right_m - first.right_m),
        ])
    }

    fn drawn(&self, now_us: u64) -> Drawn {
        let middle = |of: fn(&Load) -> f32| quantile(self.moments.iter().map(|moment| of(&moment.load)), 0.5);
        let first_us = self.moments.front().map_or(now_us, |first| first.time_us);
        let late_s = 0.5e-6 * now_us.saturating_sub(first_us) as f64 + LAG_S;
        let pace_m_per_s = self
            .rims_m_per_s(now_us)
            .map_or(0.0, |[left, right]| 0.5 * (left + right));
        Drawn {
            way: self.way(now_us),
            brush_percent: self.brush_percent,
            load: Load {
                wheels_a: middle(|load| load.wheels_a),
                brush_a: middle(|load| load.brush_a),
            },
            behind_mm: (1000.0 * pace_m_per_s * late_s) as u8,
        }
    }

    /// How the robot drives, once it has driven so since the oldest of the moments that count.
    fn way(&self, now_us: u64) -> Option<Way> {
        let (since_us, _) = self.since?;
        let pace_m_per_s = self.straight_pace(now_us)?;
        let is_settled = now_us >= since_us.saturating_add(SETTLE_US + WINDOW_US);
        is_settled.then_some(Way {
            brush_percent: self.brush_percent,
            budget: (pace_m_per_s / PACE_STEP_M_PER_S + 0.5) as u8,
        })
    }
}

/// Something but the floor loads the wheels, or may.
fn is_disturbed(observation: &Observation) -> bool {
    observation.is_touching() || observation.is_at_cliff() || !observation.inhibits.is_empty()
}

fn is_finite(currents: &MotorCurrents) -> bool {
    (currents.wheel_left_a + currents.wheel_right_a + currents.brush_main_a).is_finite()
}
