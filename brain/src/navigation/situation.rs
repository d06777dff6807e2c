//! The inputs of one step for everything that drives.

use crate::mapping::{BeamMemory, Map};
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::Pose2;
use crate::model::gyro_fault::GyroFault;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// What a task knows in one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Situation<'step> {
    pub(crate) observation: &'step Observation,
    /// The movement since the last step.
    pub(crate) advance: Advance,
    /// Pose in the map.
    pub(crate) pose: Pose2,
    /// The pose again, with its uncertainty.
    pub(crate) estimate: PoseEstimate,
    /// The map of the home.
    pub(crate) map: &'step Map,
    /// The particle filter compares what the sensors see with a map that is good enough for it.
    pub(crate) is_tracked: bool,
    /// Relative deviation of the gyro's scale where only deliberate turns determine it soon; `None` = there is no gyro, or
    /// a map determines it.
    pub(crate) gyro_scale_sigma: Option<f64>,
    /// Deviation of the gyro's bias, rad/s; `None` = there is no gyro.
    pub(crate) gyro_bias_sigma_rad_per_s: Option<f64>,
    /// Distance for which reversing may still be commanded, in metres.
    pub(crate) reverse_budget_m: f64,
    /// What is received of the dock, and where it was received.
    pub(crate) beams: &'step BeamMemory,
    pub(crate) config: &'step BrainConfig,
    /// A sensor besides the wheels measures the heading; without one, no map is kept.
    pub(crate) knows_heading: bool,
    /// Beacons are in range that tell the heading of a robot that drives, sooner or later.
    pub(crate) hears_beacons: bool,
    /// Why the robot's gyro does not count now; `None` = it does, or there never was one.
    pub(crate) gyro_fault: Option<GyroFault>,
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    pub(crate) touching: bool,
    /// A cliff is seen, or the firmware still holds the wheels because of one.
    pub(crate) at_cliff: bool,
}

impl Situation<'_> {
    /// Nothing is touched and no cliff is detected.
    pub(crate) fn is_free(&self) -> bool {
        !self.touching && !self.at_cliff
    }
}
