//! The path by the map to one of several places.
//!
//! Obstructions are remembered for some minutes and avoided. When no path is left they are forgotten, because people and
//! chairs move, and the robot tries again. When the map still has none, the robot waits, and then what is occupied now and was
//! floor before counts as floor: a person who was touched in a door is drawn there, and has mostly left it. Counts bound everything.

use core::task::Poll;

use super::parameters::TRAVEL;
use super::path_inputs::{PathInputs, goals, length_m};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::Gradual;
use crate::model::reason::Reason;
use crate::navigation::parameters::EVASION;
use crate::navigation::{
    Evasion, FollowStep, Goal, Obstructions, PathFollower, PathSegment, Situation, TaskContext, caution,
    encounter,
};

/// The drive.
#[derive(Debug)]
pub(crate) struct Travel {
    goals: Vec<Goal>,
    /// Pose of a docked robot, when the goals lie before it.
    dock: Option<Pose2>,
    clearances_m: &'static [f64],
    /// Why the robot drives there.
    reason: Reason,
    follower: Option<PathFollower>,
    path_search: Option<PathSearch>,
    evasion: Option<Evasion>,
    obstructions: Obstructions,
    plans: u32,
    failed_plans: u32,
    forgotten: u32,
    past: PastFloor,
    planned_from: Option<Point2>,
    is_obstructed: bool,
}

/// What floor counts as where something was met since.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PastFloor {
    /// What was met.
    Superseded,
    /// The same, until no path is left.
    Spare,
    /// Floor.
    Floor,
}

/// State of the drive after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TravelStep {
    /// It goes on.
    Going(Motion),
    /// The robot is there.
    Arrived,
    /// No path is left.
    Blocked,
    /// The robot is held.
    Held(Reason),
}

impl Travel {
    /// To the place in front of `dock`, the pose of a docked robot.
    pub(crate) fn to_dock(dock: Pose2, past: PastFloor) -> Self {
        Self {
            past,
            dock: Some(dock),
            ..Self::to(goals(dock), &TRAVEL.clearances_m, Reason::DockKnown)
        }
    }

    /// To one of the places where a beam was received.
    pub(crate) fn to_beam(heard_at: Vec<Goal>) -> Self {
        Self::to(heard_at, &TRAVEL.clearances_back_m, Reason::DockHeard)
    }

    /// To one of these places, which a person has named.
    pub(super) fn to_place(goals: Vec<Goal>) -> Self {
        Self {
            past: PastFloor::Spare,
            ..Self::to(goals, &TRAVEL.clearances_m, Reason::Command)
        }
    }

    fn to(goals: Vec<Goal>, clearances_m: &'static [f64], reason: Reason) -> Self {
        Self {
            goals,
            dock: None,
            clearances_m,
            reason,
            follower: None,
            path_search: None,
            evasion: None,
            obstructions: Obstructions::default(),
            plans: 0,
            failed_plans: 0,
            forgotten: 0,
            past: PastFloor::Superseded,
            planned_from: None,
            is_obstructed: false,
        }
    }

    /// Whether it has met anything.
    pub(crate) fn is_obstructed(&self) -> bool {
        self.is_obstructed
    }

    /// Whether an evasion is in progress.
    pub(crate) fn is_evading(&self) -> bool {
        self.evasion.is_some()
    }

    /// Somebody else moved the robot.
    pub(crate) fn interrupted(&mut self) {
        self.follower = None;
        self.path_search = None;
        self.evasion = None;
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TravelStep {
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return TravelStep::Going(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return TravelStep::Held(reason);
            }
            None => {}
        }
        if let Some(reason) = encounter(situation) {
            return self.evade(reason, situation, context);
        }
        if let Some(follower) = &mut self.follower {
            match follower.step(situation, caution(situation, follower)) {
                FollowStep::Going(motion) => return TravelStep::Going(motion),
                FollowStep::Arrived => return TravelStep::Arrived,
                FollowStep::Off => {
                    context.decide(DecisionKind::LeaveWay, Reason::OffTheWay, 0.0);
                    self.follower = None;
                }
            }
        }
        self.plan_on(situation, context)
    }

    /// Corners of the path from here on.
    pub(super) fn planned_path(&self) -> Vec<Point2> {
        self.follower
            .as_ref()
            .map_or_else(Vec::new, PathFollower::remaining_path)
    }

    fn evade(&mut self, reason: Reason, situation: &Situation<'_>, context: &mut TaskContext) -> TravelStep {
        context.decide(DecisionKind::BackOff, reason, 0.0);
        self.obstructions.add(reason, situation);
        self.is_obstructed = true;
        self.follower = None;
        self.path_search = None;
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(EVASION.cliff_back_m, 0.0)
        } else {
            Evasion::from_contact(
                TRAVEL.contact_back_m + TRAVEL.more_back_m * f64::from(self.failed_plans),
                0.0,
            )
        });
        TravelStep::Going(Motion::Halt)
    }

    /// Begins a path search or continues the one in progress, while the robot stands.
    fn plan_on(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TravelStep {
        let Some(path_search) = &mut self.path_search else {
            return self.begin_plan(situation, context);
        };
        let Poll::Ready(found) = path_search.rest.go_on() else {
            return TravelStep::Going(Motion::Halt);
        };
        let is_blocked = path_search.is_blocked;
        self.path_search = None;
        if let Some(segments) = found {
            let kind = match self.reason {
                Reason::Command => DecisionKind::PlaceWay,
                _ => DecisionKind::DockWay,
            };
            context.decide(kind, self.reason, length_m(&segments));
            self.follower = Some(PathFollower::new(segments));
            return TravelStep::Going(Motion::Halt);
        }
        if is_blocked && self.forgotten < TRAVEL.forget_max {
            self.forgotten += 1;
        } else if self.past == PastFloor::Spare {
            self.past = PastFloor::Floor;
        } else {
            return TravelStep::Blocked;
        }
        context.decide(
            DecisionKind::ForgetObstructions,
            Reason::WayBlocked,
            f64::from(self.forgotten),
        );
        self.obstructions.clear();
        TravelStep::Going(Motion::Halt)
    }

    fn begin_plan(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TravelStep {
        let here = situation.pose.position();
        let is_failed = self
            .planned_from
            .is_some_and(|from| from.distance_m(here) < TRAVEL.progress_min_m);
        self.failed_plans = if is_failed { self.failed_plans + 1 } else { 0 };
        self.planned_from = Some(here);
        self.plans += 1;
        if self.failed_plans > TRAVEL.failed_plans_max || self.plans > TRAVEL.plans_max {
            return TravelStep::Blocked;
        }
        context.decide(DecisionKind::Wait, Reason::Planning, 0.0);
        let blocked = self.obstructions.points(situation.observation.time_us);
        let is_blocked = !blocked.is_empty();
        let mut inputs = PathInputs::of(situation, self.goals.clone());
        inputs.blocked = blocked;
        inputs.dock = self.dock;
        if self.past == PastFloor::Floor {
            inputs.open_past_floor(situation);
        }
        self.path_search = Some(PathSearch {
            rest: Gradual::new(inputs.first_path(self.clearances_m)),
            is_blocked,
        });
        TravelStep::Going(Motion::Halt)
    }
}

/// A path search in progress.
#[derive(Debug)]
struct PathSearch {
    rest: Gradual<Option<Vec<PathSegment>>>,
    /// Obstructions that are not on the map block the path.
    is_blocked: bool,
}
