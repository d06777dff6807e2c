//! What everything that drives sees in one step.

use crate::mapping::{BeamMemory, Map};
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// What a task sees in one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Situation<'step> {
    pub(crate) observation: &'step Observation,
    /// What was moved since the last step.
    pub(crate) advance: Advance,
    /// Pose in the map.
    pub(crate) pose: Pose2,
    /// The pose again, and how sure it is.
    pub(crate) estimate: PoseEstimate,
    /// What is known of the home.
    pub(crate) map: &'step Map,
    /// What is seen is compared with a map of the home that is good enough for it.
    pub(crate) is_tracked: bool,
    /// Deviation of the gyro's scale, relative, where only what the robot does on purpose tells it soon; `None` = it has no gyro, or
    /// a map tells it.
    pub(crate) gyro_scale_sigma: Option<f64>,
    /// Deviation of the gyro's bias, rad/s; `None` = it has no gyro.
    pub(crate) gyro_bias_sigma_rad_per_s: Option<f64>,
    /// Way for which backing may still be commanded, in metres.
    pub(crate) reverse_budget_m: f64,
    /// What is heard of the dock, and where it was heard.
    pub(crate) beams: &'step BeamMemory,
    pub(crate) config: &'step BrainConfig,
    /// Something besides the wheels tells the heading; without, no map is kept.
    pub(crate) knows_heading: bool,
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    pub(crate) touching: bool,
    /// A cliff is seen, or the firmware still holds the wheels because of one.
    pub(crate) at_cliff: bool,
}

impl Situation<'_> {
    /// Nothing is touched and no cliff seen.
    pub(crate) fn is_free(&self) -> bool {
        !self.touching && !self.at_cliff
    }
}
