//! What a plan depends on besides the floor.

use crate::mapping::CELL_M;
use crate::model::geometry::Pose2;
use crate::navigation::PathSegment;

/// Parameters of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSettings {
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Standard deviation of the pose estimate in metres: lanes overlap by twice this.
    pub sigma_m: f64,
    /// Speed on lanes and links, m/s.
    pub cruise_m_per_s: f64,
    /// Turn rate, rad/s.
    pub turn_rad_per_s: f64,
    /// Leftovers beside the path are swept while passing. While the robot still explores a home, the plan changes soon, and
    /// lanes of the first round show more of the home (three seeds of home 7: 95 % after 2.45 instead of 2.6 T0).
    pub takes_along: bool,
}

impl PlanSettings {
    /// Time of a segment: at cruise speed, or as long as its turn takes.
    #[must_use]
    pub fn time_s(&self, segment: &PathSegment) -> f64 {
        (segment.length_m / self.cruise_m_per_s).max(segment.turn_rad.abs() / self.turn_rad_per_s)
    }
}

/// Where a plan begins, and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Departure {
    /// Pose of the robot.
    pub start: Pose2,
    /// Parameters of the plan.
    pub settings: PlanSettings,
}

/// Cells on either side of a lane that count as swept.
pub(crate) fn reach_cells(settings: &PlanSettings) -> usize {
    let half_m = 0.5 * settings.swath_m - settings.sigma_m;
    (libm::floor(half_m / CELL_M - 0.25).clamp(1.0, 40.0)) as usize
}
