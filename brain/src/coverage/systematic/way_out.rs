//! Leads the robot out of floor that was forbidden around it, on the shortest way, before the job goes on.

use super::{PlanProgress, Systematic};
use crate::coverage::parameters::MARGINS;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::reason::Reason;
use crate::navigation::heading::heading_rad;
use crate::navigation::{FollowStep, PathFollower, PathSegment, Situation, TaskContext, TaskStatus, caution};

/// What the robot does about forbidden floor under it.
#[derive(Debug, Default)]
pub(super) enum WayOut {
    /// Nothing is known to be forbidden under it.
    #[default]
    Allowed,
    /// It drives out.
    Driving(PathFollower),
    /// There is no way out over known floor: the job goes on from where it stands.
    Shut,
}

impl Systematic {
    /// The motion out of forbidden floor; `None` when the robot does not stand on any, or knows no way.
    pub(super) fn lead_out(
        &mut self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> Option<TaskStatus> {
        let here = situation.pose.position();
        let avoid = self.assignment.avoided();
        let mut follower = match core::mem::take(&mut self.way_out) {
            WayOut::Allowed if !situation.map.is_forbidden(here, avoid) => return None,
            WayOut::Shut if !situation.map.is_forbidden(here, avoid) => return None,
            WayOut::Shut => {
                self.way_out = WayOut::Shut;
                return None;
            }
            // The knowledge of the map does not show the zone yet.
            WayOut::Allowed if !situation.map.is_fresh() => return Some(TaskStatus::Go(Motion::Halt)),
            WayOut::Allowed => {
                let clearance_m = situation.config.body.radius_m + MARGINS.clearance_m;
                let Some(places) = situation.map.way_out(here, clearance_m, avoid) else {
                    self.way_out = WayOut::Shut;
                    return None;
                };
                let segments = segments(situation.pose, &places);
                let length_m = segments.iter().map(|segment| segment.length_m).sum();
                context.decide(DecisionKind::LeaveWay, Reason::InsideNoGo, length_m);
                self.follower = None;
                PathFollower::new(segments)
            }
            WayOut::Driving(follower) => follower,
        };
        let caution = caution(situation, &follower);
        match follower.step(situation, caution) {
            FollowStep::Going(motion) => {
                self.way_out = WayOut::Driving(follower);
                return Some(TaskStatus::Go(motion));
            }
            // Once it is out, or as far out as the map knows, it plans from there.
            FollowStep::Arrived if situation.map.is_forbidden(here, avoid) => self.way_out = WayOut::Shut,
            FollowStep::Arrived | FollowStep::Off => {}
        }
        self.plan_progress = Some(PlanProgress::Due(situation.pose));
        Some(TaskStatus::Go(Motion::Halt))
    }
}

/// Straights between places, with turns on the spot before them.
fn segments(start: Pose2, places: &[Point2]) -> Vec<PathSegment> {
    let mut segments = Vec::with_capacity(2 * places.len());
    let mut pose = start;
    for place in places {
        let along_rad = heading_rad(pose.position(), *place);
        segments.push(PathSegment {
            start: pose,
            length_m: 0.0,
            turn_rad: normalize_rad(along_rad - pose.heading_rad),
        });
        pose.heading_rad = along_rad;
        let length_m = pose.position().distance_m(*place);
        segments.push(PathSegment {
            start: pose,
            length_m,
            turn_rad: 0.0,
        });
        pose = Pose2 {
            x_m: place.x_m,
            y_m: place.y_m,
            heading_rad: along_rad,
        };
    }
    segments
}
