//! Leads the robot out of floor that was forbidden around it, on the shortest way, before the job goes on.

use super::{PlanProgress, Systematic};
use crate::coverage::parameters::MARGINS;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::no_go::NoGo;
use crate::model::reason::Reason;
use crate::navigation::{
    FollowStep, Goal, PathFollower, PathSegment, Situation, TaskContext, TaskStatus, caution, plan_path,
};

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
                let Some(segments) = segments(situation, avoid) else {
                    self.way_out = WayOut::Shut;
                    return None;
                };
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

/// The shortest way to a place over allowed floor only, across floor that would be free if nothing were forbidden. `None` when there is
/// none.
fn segments(situation: &Situation<'_>, avoid: &[NoGo]) -> Option<Vec<PathSegment>> {
    let clearance_m = situation.config.body.radius_m + MARGINS.clearance_m;
    let [open, allowed] = situation.map.around_forbidden(clearance_m, avoid);
    let is_allowed = |index: &usize| allowed.values().get(*index) == Some(&true);
    let goals: Vec<Goal> = (0..allowed.values().len())
        .filter(is_allowed)
        .map(|index| Goal {
            at: allowed.cell(index).middle(),
            detour_m: 0.0,
        })
        .collect();
    at_once(plan_path(
        &open,
        situation.pose,
        &goals,
        &mut StepBudget::unlimited(),
    ))
}
