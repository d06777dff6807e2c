//! Detects carpet by the currents of the motors.
//!
//! *Load*: the currents of the wheels and the main brush. *Steady driving*: forwards, nearly straight, at constant speed and
//! without contact. Only then do both loads depend on the floor alone. *Baseline*: the load on this home's hard floor in the same
//! driving mode, see [`baseline_load`]. *Excess*: by how much a load is above the baseline, relative.
//!
//! Pile resists a wheel that rolls in it and bristles that turn in it. Pulling a robot of this class over a loop pile took 18 N
//! (robotreviews.com, topic 16830), and makers detect floors by steps of the roller's current above a baseline (US 11882986).
//! Both loads must be in excess here, because each alone has other causes: a slope, a threshold or a pushed chair loads the
//! wheels, hair loads the brush. In simulated homes flat mats raise the wheels' load by some 45 % and the brush's by 35 %, deep
//! piles by 200 % and 100 %, with a scatter below 5 %.
//!
//! Limits: a home that is all carpet shows no difference, so the detector reports nothing. Clients distinguish a robot without
//! current measurement from a home without carpets.

mod baseline_load;
mod parameters;
mod steady_driving;

use crate::model::observation::Observation;
use baseline_load::{BaselineLoad, DrivingMode, Load};
use parameters::CARPET;
use steady_driving::{FilteredLoad, SteadyDrivingDetector};

/// The floor surface under the brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// Hard floor, or the most common surface of the home.
    Hard,
    /// A rug or a carpet.
    Carpet,
}

/// A detected surface and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SurfaceObservation {
    pub(crate) kind: SurfaceKind,
    /// Distance behind the robot, millimetres: the load is filtered over some time.
    pub(crate) behind_mm: u8,
}

/// Detects the surface under the robot from observations.
#[derive(Clone, Debug, Default)]
pub(crate) struct CarpetDetector {
    steady: SteadyDrivingDetector,
    /// One per driving mode, the most recently used one last.
    baseline: Vec<BaselineLoad>,
    is_on_carpet: bool,
    carpet_samples: u32,
    sampled_us: u64,
}

impl CarpetDetector {
    /// Adds an observation. `brush_percent` is the power of the main brush, `None` while it rests or is unknown.
    pub(crate) fn update(
        &mut self,
        observation: &Observation,
        brush_percent: Option<u8>,
    ) -> Option<SurfaceObservation> {
        let Some(filtered) = self.steady.update(observation, brush_percent) else {
            self.is_on_carpet = false;
            return None;
        };
        let kind = match filtered.mode {
            Some(mode) => self.classify(observation.time_us, mode, filtered.load),
            None => self.persists(&filtered).then_some(SurfaceKind::Carpet),
        };
        self.is_on_carpet = kind == Some(SurfaceKind::Carpet);
        kind.map(|kind| SurfaceObservation {
            kind,
            behind_mm: filtered.behind_mm,
        })
    }

    /// The surface of a load in steady driving. In a home with a single surface it is unknown.
    fn classify(&mut self, now_us: u64, mode: DrivingMode, load: Load) -> Option<SurfaceKind> {
        let is_sample = now_us >= self.sampled_us.saturating_add(CARPET.sample_interval_us);
        if is_sample {
            self.sampled_us = now_us;
        }
        let least = if self.is_on_carpet {
            CARPET.excess_off
        } else {
            CARPET.excess_on
        };
        let baseline = self.baseline_of(mode);
        let excess = baseline.excess(load);
        let is_carpet = excess.is_some_and(|excess| excess.wheels >= least && excess.brush >= least);
        if is_sample && !is_carpet {
            baseline.learn(load);
        }
        self.carpet_samples = self
            .carpet_samples
            .saturating_add(u32::from(is_sample && is_carpet));
        match excess? {
            _ if is_carpet => Some(SurfaceKind::Carpet),
            _ if self.carpet_samples >= CARPET.contrast_samples => Some(SurfaceKind::Hard),
            _ => None,
        }
    }

    /// Carpet from steady driving persists in curves and contacts while the brush stays loaded: those load only the wheels.
    fn persists(&self, filtered: &FilteredLoad) -> bool {
        let same_power = |baseline: &&BaselineLoad| baseline.mode.brush_percent == filtered.brush_percent;
        let baseline = self.baseline.iter().rev().find(same_power);
        let excess = baseline.and_then(|baseline| baseline.excess(filtered.load));
        self.is_on_carpet && excess.is_some_and(|excess| excess.brush >= CARPET.excess_on)
    }

    fn baseline_of(&mut self, mode: DrivingMode) -> &mut BaselineLoad {
        let known = self.baseline.iter().position(|baseline| baseline.mode == mode);
        let baseline = match known {
            Some(index) => self.baseline.remove(index),
            None => BaselineLoad::new(mode),
        };
        if self.baseline.len() >= CARPET.modes_max {
            self.baseline.remove(0);
        }
        let last = self.baseline.len();
        self.baseline.push(baseline);
        &mut self.baseline[last]
    }
}

#[cfg(test)]
mod layer_tests;
#[cfg(test)]
mod tests;
