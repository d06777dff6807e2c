//! The baseline load: the motor currents on hard floor in one driving mode.
//!
//! It is a low quantile of samples. So it holds in a home that is mostly carpet and when the robot starts on a rug. Samples on
//! carpet are excluded, so a large carpet does not become the baseline. Old samples are dropped, so the baseline follows hair
//! around the brush and an emptying pack.

use super::parameters::BASELINE;
use std::collections::VecDeque;

/// Currents of wheels and main brush, amperes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Load {
    /// Mean of both wheels.
    pub(super) wheels_a: f32,
    pub(super) brush_a: f32,
}

/// By how much a load is above the baseline, relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excess {
    pub(super) wheels: f32,
    pub(super) brush: f32,
}

/// A driving mode. Only loads of the same mode are comparable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DrivingMode {
    pub(super) brush_percent: u8,
    /// Speed in steps of 5 cm/s.
    pub(super) speed_step: u8,
}

/// Baseline of one driving mode.
#[derive(Clone, Debug)]
pub(super) struct BaselineLoad {
    pub(super) mode: DrivingMode,
    samples: VecDeque<Load>,
    baseline: Option<Load>,
}

impl BaselineLoad {
    pub(super) const fn new(mode: DrivingMode) -> Self {
        Self {
            mode,
            samples: VecDeque::new(),
            baseline: None,
        }
    }

    /// Adds a load that is not on carpet.
    pub(super) fn learn(&mut self, load: Load) {
        if self.samples.len() >= BASELINE.samples_max {
            self.samples.pop_front();
        }
        self.samples.push_back(load);
        if self.samples.len() >= BASELINE.samples_min {
            let low = |of: fn(&Load) -> f32| quantile(self.samples.iter().map(of), BASELINE.quantile);
            self.baseline = Some(Load {
                wheels_a: low(|load| load.wheels_a),
                brush_a: low(|load| load.brush_a),
            });
        }
    }

    /// Excess of a load over the baseline; `None` while the baseline is unknown or below the noise.
    pub(super) fn excess(&self, load: Load) -> Option<Excess> {
        let baseline = self.baseline?;
        let is_measurable =
            baseline.wheels_a >= BASELINE.load_min_a && baseline.brush_a >= BASELINE.load_min_a;
        is_measurable.then(|| Excess {
            wheels: load.wheels_a / baseline.wheels_a - 1.0,
            brush: load.brush_a / baseline.brush_a - 1.0,
        })
    }
}

/// The quantile at `share`; 0 without values.
pub(super) fn quantile(values: impl Iterator<Item = f32>, share: f32) -> f32 {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    let index = (share * sorted.len() as f32) as usize;
    sorted.get(index).copied().unwrap_or_default()
}
