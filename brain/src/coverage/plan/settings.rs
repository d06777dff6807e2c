//! What a plan depends on besides the floor.

use crate::mapping::CELL_M;
use crate::model::geometry::Pose2;
use crate::navigation::PathSegment;

/// What a plan depends on besides the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSettings {
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Standard deviation of the pose estimate in metres: lanes overlap by twice as much.
    pub sigma_m: f64,
    /// Speed on lanes and links, m/s.
    pub cruise_m_per_s: f64,
    /// Turn rate, rad/s.
    pub turn_rad_per_s: f64,
    /// Leftovers beside the way are swept while passing. In a home that is still being found out the plan is soon another one,
    /// and the lanes of the first round show more of it (three seeds of home 7: 95 % after 2.45 instead of 2.6 T0).
    pub takes_along: bool,
}

impl PlanSettings {
    /// Time of a piece at cruise speed, or as long as the turn takes.
    #[must_use]
    pub fn time_s(&self, segment: &PathSegment) -> f64 {
        (segment.length_m / self.cruise_m_per_s).max(segment.turn_rad.abs() / self.turn_rad_per_s)
    }
}

/// Where a plan begins, and what it depends on besides the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Departure {
    pub(crate) start: Pose2,
    pub(crate) settings: PlanSettings,
}

/// Cells to either side of a lane's own that it counts as swept.
pub(crate) fn reach_cells(settings: &PlanSettings) -> usize {
    let half_m = 0.5 * settings.swath_m - settings.sigma_m;
    (libm::floor(half_m / CELL_M - 0.25).clamp(1.0, 40.0)) as usize
}
