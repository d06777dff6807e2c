//! Detects steady driving: straight ahead at constant speed, with no load on the motors but the floor.

use super::parameters::STEADY;
use std::collections::VecDeque;

use super::baseline_load::{DrivingMode, Load, quantile};
use crate::model::observation::{MotorCurrents, Observation};

/// The filtered load of the last window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FilteredLoad {
    /// The driving mode; `None` while driving is not steady.
    pub(super) mode: Option<DrivingMode>,
    pub(super) brush_percent: u8,
    pub(super) load: Load,
    /// Distance from the robot back to the floor that caused the load, millimetres.
    pub(super) behind_mm: u8,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    time_us: u64,
    left_m: f64,
    right_m: f64,
    load: Load,
}

/// Detects steady driving and filters the load.
#[derive(Clone, Debug, Default)]
pub(super) struct SteadyDrivingDetector {
    window: VecDeque<Sample>,
    brush_percent: u8,
    brush_since_us: u64,
    /// Start of steady driving in microseconds, and the speed then.
    since: Option<(u64, f64)>,
}

impl SteadyDrivingDetector {
    /// Adds an observation. `None` while its loads are meaningless.
    pub(super) fn update(
        &mut self,
        observation: &Observation,
        brush_percent: Option<u8>,
    ) -> Option<FilteredLoad> {
        let currents = observation.currents.filter(is_finite);
        let brush_percent = brush_percent.filter(|percent| *percent > 0);
        let (Some(currents), Some(percent)) = (currents, brush_percent) else {
            self.reset();
            return None;
        };
        if observation.wheel_drop || observation.docked || !observation.link_up {
            self.reset();
            return None;
        }
        let now_us = observation.time_us;
        if self.window.is_empty() || percent != self.brush_percent {
            (self.brush_percent, self.brush_since_us) = (percent, now_us);
        }
        self.note(observation, currents);
        if is_disturbed(observation) {
            self.since = None;
        } else {
            self.track_steadiness(now_us);
        }
        (now_us >= self.brush_since_us.saturating_add(STEADY.spin_up_us)).then(|| self.filtered(now_us))
    }

    fn reset(&mut self) {
        self.window.clear();
        self.since = None;
    }

    fn note(&mut self, observation: &Observation, currents: MotorCurrents) {
        let now_us = observation.time_us;
        self.window.push_back(Sample {
            time_us: now_us,
            left_m: observation.travel_left_m,
            right_m: observation.travel_right_m,
            load: Load {
                wheels_a: 0.5 * (currents.wheel_left_a.abs() + currents.wheel_right_a.abs()),
                brush_a: currents.brush_main_a.unwrap_or(0.0).abs(),
            },
        });
        while self
            .window
            .front()
            .is_some_and(|first| first.time_us.saturating_add(STEADY.load_window_us) < now_us)
        {
            self.window.pop_front();
        }
    }

    fn track_steadiness(&mut self, now_us: u64) {
        self.since = match (self.since, self.straight_speed_m_per_s(now_us)) {
            (_, None) => None,
            (Some((since_us, begun)), Some(now)) if (now - begun).abs() <= STEADY.change_min * begun => {
                Some((since_us, begun))
            }
            (_, Some(now)) => Some((now_us, now)),
        };
    }

    /// Present speed, m/s; `None` while it is unknown, low or in a curve.
    fn straight_speed_m_per_s(&self, now_us: u64) -> Option<f64> {
        let [left, right] = self.rims_m_per_s(now_us)?;
        let speed_m_per_s = 0.5 * (left + right);
        let is_straight = speed_m_per_s >= STEADY.speed_min_m_per_s
            && (right - left).abs() <= STEADY.curve_min * speed_m_per_s;
        is_straight.then_some(speed_m_per_s)
    }

    /// Rim speeds of the left and the right wheel.
    fn rims_m_per_s(&self, now_us: u64) -> Option<[f64; 2]> {
        let last = self.window.back()?;
        let mut before = self.window.iter().rev();
        let first = before.find(|sample| sample.time_us.saturating_add(STEADY.speed_window_us) <= now_us)?;
        let time_s = last.time_us.saturating_sub(first.time_us) as f64 * 1e-6;
        let speed = |distance_m: f64| distance_m / time_s;
        Some([
            speed(last.left_m - first.left_m),
            speed(last.right_m - first.right_m),
        ])
    }

    fn filtered(&self, now_us: u64) -> FilteredLoad {
        let middle = |of: fn(&Load) -> f32| quantile(self.window.iter().map(|sample| of(&sample.load)), 0.5);
        let first_us = self.window.front().map_or(now_us, |first| first.time_us);
        let delay_s = 0.5e-6 * now_us.saturating_sub(first_us) as f64 + STEADY.lag_s;
        let speed_m_per_s = self
            .rims_m_per_s(now_us)
            .map_or(0.0, |[left, right]| 0.5 * (left + right));
        FilteredLoad {
            mode: self.mode(now_us),
            brush_percent: self.brush_percent,
            load: Load {
                wheels_a: middle(|load| load.wheels_a),
                brush_a: middle(|load| load.brush_a),
            },
            behind_mm: (1000.0 * speed_m_per_s * delay_s) as u8,
        }
    }

    /// The driving mode, once all samples of the window belong to it.
    fn mode(&self, now_us: u64) -> Option<DrivingMode> {
        let (since_us, _) = self.since?;
        let speed_m_per_s = self.straight_speed_m_per_s(now_us)?;
        let is_settled = now_us >= since_us.saturating_add(STEADY.settle_us + STEADY.load_window_us);
        is_settled.then_some(DrivingMode {
            brush_percent: self.brush_percent,
            speed_step: (speed_m_per_s / STEADY.speed_step_m_per_s + 0.5) as u8,
        })
    }
}

/// Whether anything but the floor may load the wheels.
fn is_disturbed(observation: &Observation) -> bool {
    observation.is_touching() || observation.is_at_cliff() || !observation.inhibits.is_empty()
}

fn is_finite(currents: &MotorCurrents) -> bool {
    (currents.wheel_left_a + currents.wheel_right_a + currents.brush_main_a.unwrap_or(0.0)).is_finite()
}
