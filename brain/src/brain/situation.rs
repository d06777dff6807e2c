//! The inputs of the behavior in one step, gathered from the parts of the brain.

use crate::localization::Localization;
use crate::mapping::{BeamMemory, Map};
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::observation::Observation;
use crate::navigation::Situation;

/// The parts of the brain that a situation describes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<'step> {
    pub(super) localization: &'step Localization,
    pub(super) map: &'step Map,
    pub(super) beams: &'step BeamMemory,
    pub(super) config: &'step BrainConfig,
}

impl<'step> Parts<'step> {
    /// The situation after this observation and the motion before it.
    pub(super) fn situation(self, observation: &'step Observation, advance: Advance) -> Situation<'step> {
        let localization = self.localization;
        Situation {
            observation,
            advance,
            pose: localization.pose(),
            estimate: localization.estimate(),
            map: self.map,
            is_tracked: localization.explained().is_some(),
            gyro_scale_sigma: localization.slam_gyro_scale_sigma(observation.time_us),
            gyro_bias_sigma_rad_per_s: localization.gyro_bias_sigma_rad_per_s(observation.time_us),
            reverse_budget_m: localization.reverse_left_m(),
            beams: self.beams,
            config: self.config,
            knows_heading: localization.knows_heading(observation.time_us),
            hears_beacons: observation.hears_beacons(),
            gyro_fault: localization.gyro_fault(),
            touching: observation.is_touching(),
            at_cliff: observation.is_at_cliff(),
        }
    }
}
