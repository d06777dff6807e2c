//! The way to a place in front of the dock, or to one where it was heard, by the map.
//!
//! What stands in the way is remembered for some minutes and gone round; when no way is left the memory is cleared, because
//! people and chairs move, and the way is tried again. All of it is bounded by counts.

use core::task::Poll;

use crate::mapping::{CellKnowledge, Raster};
use crate::model::action::Motion;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{Gradual, StepBudget};
use crate::model::reason::Reason;
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{
    Evasion, FollowStep, Follower, Goal, Mind, Obstructions, Piece, Situation, caution, encounter, plan_way,
    reachable,
};

/// Gaps between body and known obstacles on planned ways, metres, the roomy one first: who is in no hurry to be near need
/// not touch. With the last one cells of the map may lie under the rim: a passage that is hardly wider than the body is
/// one cell too narrow in the map.
const KEEP_OFF_M: [f64; 3] = [0.05, 0.01, -0.015];
/// The same on the way back to where the robot has been: it fits through there, and what the map says of it was drawn with a
/// pose that has drifted since.
const KEEP_OFF_BACK_M: [f64; 5] = [0.05, 0.01, -0.015, -0.05, -0.09];
/// Distances from the dock at which the beams are taken up, metres: the best one first.
const FRONT_M: [f64; 6] = [1.1, 1.3, 0.9, 0.75, 0.6, 0.5];
/// Places beside the line are worse than places on it: detour for each metre.
const ASIDE_DETOUR: f64 = 6.0;
/// The same for distances from the dock.
const FRONT_DETOUR: f64 = 1.5;
/// Places beside the line, metres.
const ASIDE_M: [f64; 5] = [0.0, 0.12, -0.12, 0.25, -0.25];
/// Way back after a contact, and what is added with each plan that made no way.
const CONTACT_BACK_M: f64 = 0.03;
const MORE_BACK_M: f64 = 0.02;
/// Way back at a cliff.
const CLIFF_BACK_M: f64 = 0.08;
/// Nearer than this to where the last plan began, the plan was vain, metres.
const VAIN_M: f64 = 0.15;
/// Vain plans in a row, and plans in all, until the way counts as blocked.
const VAIN_MAX: u32 = 6;
const PLANS_MAX: u32 = 40;
/// Times that obstructions are forgotten.
const FORGET_MAX: u32 = 2;

/// The way.
#[derive(Debug)]
pub(super) struct Travel {
    goals: Vec<Goal>,
    keep_off_m: &'static [f64],
    /// Why it leads there.
    reason: Reason,
    follower: Option<Follower>,
    planning: Option<Planning>,
    evasion: Option<Evasion>,
    obstructions: Obstructions,
    plans: u32,
    vain: u32,
    forgotten: u32,
    planned_from: Option<Point2>,
}

/// State of the way after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TravelStep {
    /// On it.
    Going(Motion),
    /// There.
    Arrived,
    /// No way is left.
    Blocked,
    /// Something holds the robot.
    Held(Reason),
}

impl Travel {
    /// To the place in front of `dock`, the pose of a robot on its contacts.
    pub(super) fn to_dock(dock: Pose2) -> Self {
        Self::to(goals(dock), &KEEP_OFF_M, Reason::DockKnown)
    }

    /// To one of the places where it was heard.
    pub(super) fn to_beam(heard_at: Vec<Goal>) -> Self {
        Self::to(heard_at, &KEEP_OFF_BACK_M, Reason::DockHeard)
    }

    fn to(goals: Vec<Goal>, keep_off_m: &'static [f64], reason: Reason) -> Self {
        Self {
            goals,
            keep_off_m,
            reason,
            follower: None,
            planning: None,
            evasion: None,
            obstructions: Obstructions::default(),
            plans: 0,
            vain: 0,
            forgotten: 0,
            planned_from: None,
        }
    }

    /// Whether it is just getting away from something.
    pub(super) fn is_evading(&self) -> bool {
        self.evasion.is_some()
    }

    /// The robot was moved by somebody else.
    pub(super) fn interrupted(&mut self) {
        self.follower = None;
        self.planning = None;
        self.evasion = None;
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> TravelStep {
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return TravelStep::Going(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return TravelStep::Held(reason);
            }
            None => {}
        }
        if let Some(reason) = encounter(situation) {
            return self.evade(reason, situation, mind);
        }
        if let Some(follower) = &mut self.follower {
            match follower.step(situation, caution(situation, follower)) {
                FollowStep::Going(motion) => return TravelStep::Going(motion),
                FollowStep::Arrived => return TravelStep::Arrived,
                FollowStep::Off => {
                    mind.decide("leave-way", Reason::OffTheWay, 0.0);
                    self.follower = None;
                }
            }
        }
        self.plan_on(situation, mind)
    }

    fn evade(&mut self, reason: Reason, situation: &Situation<'_>, mind: &mut Mind) -> TravelStep {
        mind.decide("back-off", reason, 0.0);
        self.obstructions.add(reason, situation);
        self.follower = None;
        self.planning = None;
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(CLIFF_BACK_M, 0.0)
        } else {
            Evasion::from_contact(CONTACT_BACK_M + MORE_BACK_M * f64::from(self.vain), 0.0)
        });
        TravelStep::Going(Motion::Halt)
    }

    /// Begins a plan, or goes on with the one that is being made, while the robot stands.
    fn plan_on(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> TravelStep {
        let Some(planning) = &mut self.planning else {
            return self.begin_plan(situation, mind);
        };
        let Poll::Ready(found) = planning.rest.go_on() else {
            return TravelStep::Going(Motion::Halt);
        };
        let is_blocked = planning.is_blocked;
        self.planning = None;
        if let Some(pieces) = found {
            mind.decide("dock-way", self.reason, length_m(&pieces));
            self.follower = Some(Follower::new(pieces));
            return TravelStep::Going(Motion::Halt);
        }
        if !is_blocked || self.forgotten >= FORGET_MAX {
            return TravelStep::Blocked;
        }
        mind.decide(
            "forget-obstructions",
            Reason::WayBlocked,
            f64::from(self.forgotten),
        );
        self.forgotten += 1;
        self.obstructions.clear();
        TravelStep::Going(Motion::Halt)
    }

    fn begin_plan(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> TravelStep {
        let here = situation.pose.position();
        let is_vain = self
            .planned_from
            .is_some_and(|from| from.distance_m(here) < VAIN_M);
        self.vain = if is_vain { self.vain + 1 } else { 0 };
        self.planned_from = Some(here);
        self.plans += 1;
        if self.vain > VAIN_MAX || self.plans > PLANS_MAX {
            return TravelStep::Blocked;
        }
        mind.decide("wait", Reason::Planning, 0.0);
        let blocked = self.obstructions.points(situation.observation.time_us);
        let is_blocked = !blocked.is_empty();
        let basis = Basis::of(situation, self.goals.clone(), blocked);
        self.planning = Some(Planning {
            rest: Gradual::new(basis.first_way(self.keep_off_m)),
            is_blocked,
        });
        TravelStep::Going(Motion::Halt)
    }
}

/// A way that is being looked for.
#[derive(Debug)]
struct Planning {
    rest: Gradual<Option<Vec<Piece>>>,
    /// Something that the map does not know stands in the way.
    is_blocked: bool,
}

/// All that a way depends on.
#[derive(Debug)]
struct Basis {
    knowledge: Raster<CellKnowledge>,
    body_m: f64,
    blocked: Vec<Point2>,
    start: Pose2,
    goals: Vec<Goal>,
}

impl Basis {
    fn of(situation: &Situation<'_>, goals: Vec<Goal>, blocked: Vec<Point2>) -> Self {
        Self {
            knowledge: situation.map.knowledge().clone(),
            body_m: situation.config.body.radius_m,
            blocked,
            start: situation.pose,
            goals,
        }
    }

    /// The way with the first of these gaps with which there is one.
    async fn first_way(self, keep_off_m: &'static [f64]) -> Option<Vec<Piece>> {
        let budget = &mut StepBudget::limited();
        for gap_m in keep_off_m {
            let around = (self.body_m + gap_m, self.blocked.as_slice());
            let ground = reachable(&self.knowledge, &LaneFrame::OF_MAP, around, budget).await;
            if let Some(pieces) = plan_way(&ground, (self.start, &self.goals), budget).await {
                return Some(pieces);
            }
        }
        None
    }
}

/// Looks for the length of the way to the place in front of `dock`, metres; `None` when the map knows none.
pub(super) fn way_m(dock: Pose2, situation: &Situation<'_>) -> Gradual<Option<f64>> {
    let basis = Basis::of(situation, goals(dock), Vec::new());
    Gradual::new(async move { Some(length_m(&basis.first_way(&KEEP_OFF_M[1..2]).await?)) })
}

fn length_m(pieces: &[Piece]) -> f64 {
    pieces.iter().map(|piece| piece.length_m).sum()
}

/// Places in front of the dock, those on the line at a good distance first.
pub(super) fn goals(dock: Pose2) -> Vec<Goal> {
    let mut goals = Vec::with_capacity(FRONT_M.len() * ASIDE_M.len());
    for (rank, front_m) in FRONT_M.into_iter().enumerate() {
        for aside_m in ASIDE_M {
            goals.push(Goal {
                at: dock.transform(Point2 {
                    x_m: -front_m,
                    y_m: aside_m,
                }),
                detour_m: FRONT_DETOUR * 0.2 * rank as f64 + ASIDE_DETOUR * aside_m.abs(),
            });
        }
    }
    goals
}
