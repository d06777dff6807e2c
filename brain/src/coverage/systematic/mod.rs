//! `systematic`: lanes over the whole home, few turns, then what was left over.
//!
//! In a home that it does not know it first drives a lap along the walls, which shows the outline, and then plans over what
//! lies within as if it were floor, until something is met there.
//!
//! It plans, follows the plan, and plans again from what it has passed: when something stood in the way, when the way was
//! lost, and when the plan is at its end. Plans are made step by step, while the robot backs off or stands. Where plan after plan brings nothing it bounces out of the place. It is done when
//! nothing is left that is worth the way, or when even that leads nowhere. Terms are those of [`super::plan`]; *obstruction*: a place where something was met that the map
//! does not know, kept for a while because things are moved and the robot may have been wrong about its place.

mod assignment;
mod contact_offset;
mod frontier;
mod judging;
mod new_obstacles;
mod outline;
mod passed;
mod plan_progress;
mod recent_track;
mod relocalization;
mod share;
mod squeeze;
mod standoff;

use super::escape_bounce::EscapeBounce;
use super::margins::KEEP_OFF_M;
use super::perimeter::LapStep;
use super::plan::{Departure, reach_cells};
use crate::mapping::{CellKnowledge, Map, Raster};
use crate::model::action::Motion;
use crate::model::geometry::{Point2, Pose2};
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;
use crate::navigation::caution::{Ahead, ahead, caution};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{
    Evasion, FollowStep, Obstructions, PathFollower, Situation, Task, TaskContext, TaskStatus, encounter,
};
use assignment::{Assignment, Next};
use contact_offset::ContactOffset;
use frontier::margin_cells;
use outline::{OptimisticMargin, Outline, knows_home, shuts_in};
use passed::{CellWindow, Passed};
use plan_progress::{PlanInputs, PlanProgress, settings};
use relocalization::{RelocalizationLap, RelocalizationStep};
use share::{PassedFloor, Shares};
use squeeze::Squeeze;
use standoff::Standoff;

/// Way back after a contact: far enough to turn.
const CONTACT_BACK_M: f64 = 0.03;
/// Way back from what is seen ahead.
const SEEN_BACK_M: f64 = 0.02;
/// Way back that is added for each plan in a row that brought nothing.
const MORE_BACK_M: f64 = 0.02;
/// Way back at a cliff.
const CLIFF_BACK_M: f64 = 0.08;
/// Turn away from an edge that nobody knew, radians.
const AWAY_RAD: f64 = 1.2;

/// The strategy.
#[derive(Debug, Default)]
pub(crate) struct Systematic {
    assignment: Assignment,
    outline: Option<Outline>,
    plan_progress: Option<PlanProgress>,
    /// It stands until the plan is made.
    waits: bool,
    follower: Option<PathFollower>,
    evasion: Option<Evasion>,
    passed: Option<Passed>,
    /// Generation of the map in which it plans.
    generation: u32,
    /// The frame in which lanes are planned, once it is found in this drawing of the map.
    frame: Option<LaneFrame>,
    obstructions: Obstructions,
    failed_plans: u32,
    fresh_starts: u32,
    escape_bounce: Option<EscapeBounce>,
    relocalization: RelocalizationLap,
    escapes: u32,
    /// Floor that was passed when obstructions were forgotten last.
    passed_at_start_m2: f64,
    /// Floor that was still open when the last plan was made.
    open_before_m2: f64,
    /// Most floor that could be reached at any time, with what was hoped for: by it is judged whether something is cut off.
    floor_m2: f64,
    /// Much less than that can be reached now.
    is_cut_off: bool,
    /// Less than that can be reached now, by so much that somebody may stand in a door.
    misses_a_part: bool,
    /// It keeps off what it has just touched.
    contact_offset: ContactOffset,
    standoff: Standoff,
    squeeze: Squeeze,
    /// What was known when it began, in a home that was known then.
    began: Option<Raster<CellKnowledge>>,
    shares: Shares,
}

impl Task for Systematic {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.heed_redrawing(situation);
        if let Some(passed) = &mut self.passed
            && !situation.estimate.lost
        {
            passed.follow(situation);
        }
        self.plan_on(situation);
        if let Some(plan) = self.relocalize(situation, context) {
            return plan;
        }
        if let Some(plan) = self.lap(situation, context) {
            return plan;
        }
        if let Some(escape_bounce) = &mut self.escape_bounce {
            if let Some(plan) = escape_bounce.step(situation, context) {
                return plan;
            }
            self.escape_bounce = None;
        }
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return TaskStatus::Go(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return TaskStatus::Trouble(reason);
            }
            None => {}
        }
        if let Some(reason) = encounter(situation) {
            return self.evade(reason, situation, context);
        }
        self.drive(situation, context)
    }

    fn interrupted(&mut self) {
        if let Some(Outline::Lap(lap)) = &mut self.outline {
            lap.interrupted();
        }
        self.evasion = None;
        self.follower = None;
        self.plan_progress = None;
        self.relocalization.interrupted();
        if let Some(escape_bounce) = &mut self.escape_bounce {
            escape_bounce.interrupted();
        }
    }

    fn planned_path(&self) -> Vec<Point2> {
        self.follower
            .as_ref()
            .map_or_else(Vec::new, PathFollower::remaining_path)
    }

    fn swept_share(&self, map: &Map) -> Option<SweptShare> {
        let target = self.assignment.target_floor(map);
        self.shares.share(|settings| {
            let passed = self.passed.as_ref()?.cells();
            Some(PassedFloor::count(&passed, (&target, map), settings))
        })
    }
}

impl Systematic {
    /// Cleans what is ordered.
    pub(super) fn with(order: CleaningOrder) -> Self {
        Self {
            assignment: Assignment::of(order),
            ..Self::default()
        }
    }

    /// Turns to what comes after the present part; `false` when nothing does.
    fn turns_to_next(&mut self, is_missed: bool, (map, context): (&Map, &mut TaskContext)) -> bool {
        self.assignment.is_missed |= is_missed;
        match self.assignment.advance(map) {
            Next::End => return false,
            Next::Part => {}
            Next::Again => {
                if let Some(passed) = &mut self.passed {
                    passed.forget();
                }
            }
        }
        context.decide("turn-to-part", Reason::NextPart, 0.0);
        (self.floor_m2, self.open_before_m2, self.passed_at_start_m2) = (0.0, 0.0, 0.0);
        (self.failed_plans, self.fresh_starts, self.escapes) = (0, 0, 0);
        self.shares = Shares::default();
        true
    }

    /// Looks for its own place, once it knows no more where it is in a map that it has.
    fn relocalize(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        if !situation.is_tracked || self.evasion.is_some() {
            return None;
        }
        match self.relocalization.step(situation, context) {
            RelocalizationStep::Idle => None,
            RelocalizationStep::Over => {
                self.interrupted();
                None
            }
            RelocalizationStep::Driving(plan) => Some(plan),
        }
    }

    /// The lap along the walls of an unknown home; `None` when there is none to drive.
    fn lap(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        let outline = self.outline.get_or_insert_with(|| {
            if knows_home(situation) {
                Outline::Known
            } else {
                context.decide("lap", Reason::NoMap, 0.0);
                Outline::Lap(Box::default())
            }
        });
        let Outline::Lap(lap) = outline else { return None };
        let reason = match lap.step(situation, context) {
            LapStep::Going(motion) => return Some(TaskStatus::Go(motion)),
            LapStep::Trouble(reason) => return Some(TaskStatus::Trouble(reason)),
            LapStep::Over(reason) => reason,
        };
        let (what, margin) = match reason {
            Reason::BackAtStart => ("contour-closed", OptimisticMargin::CLOSED),
            Reason::KnownWall => ("end-lap", OptimisticMargin::KNOWN),
            _ => ("end-lap", OptimisticMargin::OPEN),
        };
        context.decide(what, reason, lap.driven_m());
        self.outline = Some(Outline::Growing(margin));
        None
    }

    /// Forgets what it remembers in places of a map that was drawn again with other poses.
    fn heed_redrawing(&mut self, situation: &Situation<'_>) {
        let generation = situation.map.snapshot().generation;
        if generation != self.generation {
            self.generation = generation;
            self.passed = None;
            self.frame = None;
            self.obstructions.clear();
            self.plan_progress = self.plan_progress.take().map(PlanProgress::afresh);
        }
    }

    /// Backs off from what was met, and remembers it.
    fn evade(&mut self, reason: Reason, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        context.decide("back-off", reason, 0.0);
        self.obstructions.add(reason, situation);
        self.contact_offset.touched(reason);
        self.follower = None;
        if situation.at_cliff {
            self.evasion = Some(Evasion::from_cliff(CLIFF_BACK_M, self.away_rad(reason)));
            // Beside an edge a plan begins where the robot really stands.
            self.plan_progress = None;
        } else {
            self.standoff.touched(ahead(situation));
            self.back_off(CONTACT_BACK_M, situation);
        }
        TaskStatus::Go(Motion::Halt)
    }

    /// Goes on, unless it would run into what it sees in a home of which it draws the map. In a home that is known the ways end where
    /// walls are, and a touch in passing costs less than a new plan: with it 95 % took 0.05 T0 longer in the AWS house.
    fn go(&mut self, motion: Motion, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let explores = matches!(self.outline, Some(Outline::Growing(_)));
        let drives = situation.advance.distance_m > 0.0
            && matches!(motion, Motion::Drive { speed_m_per_s, .. } if speed_m_per_s > 0.0);
        let seen = if explores && drives {
            ahead(situation)
        } else {
            None
        };
        match seen {
            Some(seen) if self.standoff.is_reached(seen) => self.stand_off(seen, situation, context),
            _ => TaskStatus::Go(motion),
        }
    }

    /// Leaves a way on which something is seen, before it is touched.
    fn stand_off(&mut self, seen: Ahead, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        context.decide("leave-way", Reason::WallAhead, seen.clear_m);
        self.obstructions.add_seen(seen.at, situation);
        self.follower = None;
        self.back_off(SEEN_BACK_M, situation);
        TaskStatus::Go(Motion::Halt)
    }

    /// Backs off on the way it came, farther the more plans were vain; the next one is made meanwhile, for where the robot will stand.
    fn back_off(&mut self, least_m: f64, situation: &Situation<'_>) {
        let back_m = least_m + MORE_BACK_M * f64::from(self.failed_plans);
        self.evasion = Some(Evasion::from_contact(back_m, 0.0));
        self.plan_progress = Some(PlanProgress::Due(situation.pose.after_arc(-back_m, 0.0)));
    }

    /// Turn after an edge: where edges are not known yet the robot looks away from one before it drives on, because way
    /// forward is what lets it back off again.
    fn away_rad(&self, reason: Reason) -> f64 {
        match (&self.outline, reason) {
            (Some(Outline::Known), _) => 0.0,
            (_, Reason::CliffLeft) => -AWAY_RAD,
            _ => AWAY_RAD,
        }
    }

    fn drive(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if self.follower.is_none()
            && let Some(instead) = self.take_plan(situation, context)
        {
            return instead;
        }
        let Some(follower) = &mut self.follower else {
            return TaskStatus::Go(Motion::Halt);
        };
        let mut caution = caution(situation, follower);
        self.standoff.follow(situation.advance);
        caution.offset_m += self.contact_offset.offset_m(situation.advance);
        let step = follower.step(situation, caution);
        if let (Some(passed), Some(beside)) = (&mut self.passed, follower.beside(situation)) {
            passed.give_up(beside);
        }
        match step {
            FollowStep::Going(motion) => return self.go(motion, situation, context),
            FollowStep::Off => context.decide("leave-way", Reason::OffTheWay, 0.0),
            FollowStep::Arrived => {}
        }
        self.follower = None;
        self.plan_progress = Some(PlanProgress::Due(situation.pose));
        TaskStatus::Go(Motion::Halt)
    }

    /// Goes on with the plan that is being made, if one is.
    fn plan_on(&mut self, situation: &Situation<'_>) {
        self.plan_progress = match self.plan_progress.take() {
            Some(PlanProgress::Due(start)) => Some(self.begin_plan(start, situation)),
            Some(plan_progress) => Some(plan_progress.go_on()),
            None => None,
        };
    }

    /// Begins a plan for what is left, for a robot that sets out from `start`, once it is recalled what was passed and the map
    /// shows what was met.
    fn begin_plan(&mut self, start: Pose2, situation: &Situation<'_>) -> PlanProgress {
        let settings = settings(situation);
        let knowledge = situation.map.knowledge();
        let beyond_m = match self.outline {
            Some(Outline::Growing(margin)) => Some(margin.beyond_m),
            _ => None,
        };
        if matches!(self.outline, Some(Outline::Known)) && self.began.is_none() {
            self.began = Some(knowledge.clone());
        }
        let squeezed_m = self.squeeze.radius_m(situation.config.body);
        let beyond_m = beyond_m.map(|beyond_m| match squeezed_m {
            Some(_) => beyond_m.max(squeeze::BEYOND_M),
            None => beyond_m,
        });
        let window = CellWindow::around(knowledge, beyond_m.map_or(0, margin_cells));
        let passed = self
            .passed
            .get_or_insert_with(|| Passed::new(situation.map, &window, reach_cells(&settings)));
        if !passed.recall(situation.map) || !situation.map.is_fresh() {
            return PlanProgress::Due(start);
        }
        passed.cover(&window);
        let (passed, target) = (passed.cells(), self.assignment.target_floor(situation.map));
        let counted = PassedFloor::count(&passed, (&target, situation.map), &settings);
        self.shares.begin(settings, counted);
        PlanProgress::begin(PlanInputs {
            knowledge: knowledge.clone(),
            beyond_m,
            radius_m: situation.config.body.radius_m + KEEP_OFF_M,
            squeezed_m,
            began: squeezed_m.filter(|_| self.misses_a_part).and(self.began.clone()),
            blocked: self.obstructions.points(situation.observation.time_us),
            target,
            passed,
            departure: Departure { start, settings },
            frame: self.frame,
        })
    }

    /// Takes up the plan that was made for what is left; gives what to do instead if there is none to follow.
    fn take_plan(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        let here = situation.pose;
        match self.plan_progress.take() {
            Some(PlanProgress::Finished { finished, request }) if request.begins_at(here.position()) => {
                self.waits = false;
                self.frame = Some(finished.frame);
                return self.judge(finished.plan, request.is_blocked, (situation, context));
            }
            Some(PlanProgress::Finished { .. }) | None => self.plan_progress = Some(PlanProgress::Due(here)),
            unfinished => self.plan_progress = unfinished,
        }
        if !core::mem::replace(&mut self.waits, true) {
            context.decide("wait", Reason::Planning, 0.0);
        }
        Some(TaskStatus::Go(Motion::Halt))
    }
}
