//! `systematic`: lanes over the whole home, with few turns, then the leftovers.
//!
//! In an unknown home it first drives a lap along the walls, which shows the outline. Then it plans over everything inside
//! as if it were floor, until it finds obstacles there.
//!
//! It plans, follows the plan, and plans again from what it has swept: when something blocked the path, when it left the
//! path, and at the end of the plan. Planning runs in steps while the robot backs off or stands. Where several plans in a
//! row have no effect it bounces out of the place. It is done when no floor is left that is worth driving to, or when even
//! bouncing fails.
//!
//! Terms are those of [`super::plan`]. *Obstruction*: a contact that is not on the map. It is remembered for a while only,
//! because things move and the pose may have been wrong.

mod assignment;
mod contact_offset;
mod detour;
mod frontier;
mod gain;
mod heading_search;
mod known_floor;
mod new_obstacles;
mod outline;
mod parameters;
mod passed;
mod plan_evaluation;
mod plan_progress;
mod position_fix;
mod recent_track;
mod relocalization;
mod share;
mod squeeze;
mod standoff;
mod way_out;

use super::escape_bounce::EscapeBounce;
use super::perimeter::LapStep;
use super::plan::{Departure, reach_cells};
use crate::coverage::parameters::MARGINS;
use crate::mapping::{CellKnowledge, Map, Raster};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, Pose2};
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;
use crate::navigation::caution::{Ahead, ahead, caution};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::parameters::EVASION;
use crate::navigation::{
    Evasion, FollowStep, Obstructions, PathFollower, Situation, Task, TaskContext, TaskStatus, encounter,
};
use assignment::{Assignment, Next};
use contact_offset::ContactOffset;
use detour::DetourStep;
use frontier::margin_cells;
use gain::Gain;
use heading_search::HeadingSearch;
use known_floor::KnownFloor;
use outline::{Laps, Outline, knows_home, shuts_in};
use parameters::{SQUEEZE, SYSTEMATIC};
use passed::{CellWindow, Passed};
use plan_evaluation::MadePlan;
use plan_progress::{PlanInputs, PlanProgress, settings};
use position_fix::PositionFix;
use relocalization::RelocalizationLap;
use share::{PassedFloor, Shares};
use squeeze::Squeeze;
use standoff::Standoff;
use way_out::WayOut;

/// The strategy.
#[derive(Debug, Default)]
pub(crate) struct Systematic {
    assignment: Assignment,
    outline: Option<Outline>,
    laps: Laps,
    plan_progress: Option<PlanProgress>,
    /// The robot stands until the plan is finished.
    waits: bool,
    follower: Option<PathFollower>,
    evasion: Option<Evasion>,
    passed: Option<Passed>,
    /// Generation of the map on which it plans.
    generation: u32,
    /// The frame of the lanes, once found for this generation of the map.
    frame: Option<LaneFrame>,
    obstructions: Obstructions,
    failed_plans: u32,
    fresh_starts: u32,
    escape_bounce: Option<EscapeBounce>,
    relocalization: RelocalizationLap,
    escapes: u32,
    /// Floor that was swept when obstructions were last forgotten.
    passed_at_start_m2: f64,
    /// Floor that was still open when the last plan was made.
    open_before_m2: f64,
    /// Most floor that was reachable at any time, assumed floor included: the reference for what is cut off.
    floor_m2: f64,
    /// Much less than `floor_m2` is reachable now.
    is_cut_off: bool,
    /// Less than `floor_m2` is reachable now, by so much that somebody may stand in a door.
    misses_a_part: bool,
    /// Keeps away from what it has just touched.
    contact_offset: ContactOffset,
    standoff: Standoff,
    squeeze: Squeeze,
    /// The map at the start of the job, in a known home.
    began: Option<Raster<CellKnowledge>>,
    /// The floor of a known home.
    known_floor: Option<KnownFloor>,
    shares: Shares,
    gain: Gain,
    way_out: WayOut,
    heading_search: HeadingSearch,
    position_fix: PositionFix,
}

impl Task for Systematic {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if let Some(plan) = self.find_heading(situation, context) {
            return plan;
        }
        self.discard_outdated(situation);
        if let Some(passed) = &mut self.passed
            && !situation.estimate.lost
        {
            passed.follow(situation);
        }
        self.plan_on(situation);
        if let Some(plan) = self.relocalize(situation, context) {
            return plan;
        }
        if let Some(plan) = self.take_fix(situation, context) {
            return plan;
        }
        if let Some(plan) = self.lap(situation, context) {
            return plan;
        }
        self.gain.work(situation.observation.time_us);
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
        if let Some(plan) = self.lead_out(situation, context) {
            return plan;
        }
        self.drive(situation, context)
    }

    fn interrupted(&mut self) {
        if let Some(Outline::Lap(lap)) = &mut self.outline {
            lap.interrupted();
        }
        self.evasion = None;
        self.follower = None;
        self.way_out = WayOut::default();
        self.plan_progress = None;
        self.relocalization.interrupted();
        self.heading_search.interrupted();
        self.position_fix.interrupted();
        if let Some(escape_bounce) = &mut self.escape_bounce {
            escape_bounce.interrupted();
        }
    }

    fn planned_path(&self) -> Vec<Point2> {
        self.follower
            .as_ref()
            .map_or_else(Vec::new, PathFollower::remaining_path)
    }

    fn is_floor_shut_off(&self) -> bool {
        self.misses_a_part && matches!(self.outline, Some(Outline::Known))
    }

    fn looks_again(&mut self) {
        self.obstructions.clear();
        self.squeeze.reset_attempts();
        self.gain.begin_anew();
        (self.failed_plans, self.fresh_starts, self.escapes) = (0, 0, 0);
    }

    fn swept_share(&self, map: &Map) -> Option<SweptShare> {
        let target = self.assignment.target_floor(map);
        let passed = self.passed.as_ref().map(Passed::cells);
        let known = || self.known_floor.as_ref()?.count(passed.as_ref()?, &target, map);
        let count = |settings: &_| Some(PassedFloor::count(passed.as_ref()?, &target, map, settings));
        self.shares.share(count, known)
    }
}

impl Systematic {
    /// Cleans this order.
    pub(super) fn with(order: CleaningOrder) -> Self {
        Self {
            assignment: Assignment::of(order),
            ..Self::default()
        }
    }

    /// Goes on to the next part; `false` when there is none.
    fn turns_to_next(&mut self, is_missed: bool, map: &Map, context: &mut TaskContext) -> bool {
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
        context.decide(DecisionKind::TurnToPart, Reason::NextPart, 0.0);
        (self.floor_m2, self.open_before_m2, self.passed_at_start_m2) = (0.0, 0.0, 0.0);
        (self.failed_plans, self.fresh_starts, self.escapes) = (0, 0, 0);
        self.shares = Shares::default();
        self.gain.begin_anew();
        true
    }

    /// Drives about while the robot must learn its heading from beacons.
    fn find_heading(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        let step = self.heading_search.step(situation, context);
        self.detour(step)
    }

    /// Relocalizes when the robot is lost on its map.
    fn relocalize(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        if !situation.is_tracked || self.evasion.is_some() {
            return None;
        }
        let step = self.relocalization.step(situation, context);
        self.detour(step)
    }

    /// Goes to walls when the position has become vague.
    fn take_fix(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        if !situation.is_tracked || self.evasion.is_some() {
            return None;
        }
        let avoid = self.assignment.avoided();
        let step = self.position_fix.step(avoid, situation, context);
        self.detour(step)
    }

    /// The motion of a detour; `None` when lanes go on.
    fn detour(&mut self, step: DetourStep) -> Option<TaskStatus> {
        match step {
            DetourStep::Idle => None,
            DetourStep::Over => {
                self.interrupted();
                None
            }
            DetourStep::Driving(status) => Some(status),
        }
    }

    /// The lap along the walls of an unknown home; `None` when there is none to drive.
    fn lap(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        let outline = self.outline.get_or_insert_with(|| {
            if knows_home(situation) {
                Outline::Known
            } else {
                context.decide(DecisionKind::Lap, Reason::NoMap, 0.0);
                Outline::Lap(Box::default())
            }
        });
        let Outline::Lap(lap) = outline else { return None };
        let reason = match lap.step(situation, context) {
            LapStep::Going(motion) => return Some(TaskStatus::Go(motion)),
            LapStep::Trouble(reason) => return Some(TaskStatus::Trouble(reason)),
            LapStep::Over(reason) => reason,
        };
        let kind = match reason {
            Reason::BackAtStart => DecisionKind::ContourClosed,
            _ => DecisionKind::EndLap,
        };
        context.decide(kind, reason, lap.driven_m());
        if let Some(Outline::Lap(lap)) = self.outline.take() {
            self.outline = Some(Outline::Growing(self.laps.end(lap, reason)));
        }
        None
    }

    /// Discards everything in coordinates of a map that was drawn again with corrected poses.
    fn discard_outdated(&mut self, situation: &Situation<'_>) {
        let generation = situation.map.snapshot().generation;
        if generation != self.generation {
            self.generation = generation;
            self.passed = None;
            self.frame = None;
            self.obstructions.clear();
            self.plan_progress = self.plan_progress.take().map(PlanProgress::restarted);
        }
    }

    /// Backs off from an obstacle, and remembers it.
    fn evade(&mut self, reason: Reason, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        context.decide(DecisionKind::BackOff, reason, 0.0);
        self.obstructions.add(reason, situation);
        self.contact_offset.touched(reason);
        self.follower = None;
        self.way_out = WayOut::default();
        if situation.at_cliff {
            self.evasion = Some(Evasion::from_cliff(EVASION.cliff_back_m, self.away_rad(reason)));
            // At a cliff the plan must begin at the robot's actual position.
            self.plan_progress = None;
        } else {
            self.standoff.touched(ahead(situation));
            self.back_off(SYSTEMATIC.contact_back_m, situation);
        }
        TaskStatus::Go(Motion::Halt)
    }

    /// Goes on, but stops before obstacles ahead while it draws the map. In a known home the paths end at walls, and a
    /// touch in passing costs less than a new plan: stopping there made 95 % take 0.05 T0 longer in the AWS house.
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

    /// Leaves a path on which an obstacle is visible, before touching it.
    fn stand_off(&mut self, seen: Ahead, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        context.decide(DecisionKind::LeaveWay, Reason::WallAhead, seen.clear_m);
        self.obstructions.add_seen(seen.at, situation);
        self.follower = None;
        self.back_off(SYSTEMATIC.seen_back_m, situation);
        TaskStatus::Go(Motion::Halt)
    }

    /// Backs off along its path, farther after plans without effect. The next plan is made meanwhile, from where the robot
    /// will stand.
    fn back_off(&mut self, least_m: f64, situation: &Situation<'_>) {
        let back_m = least_m + SYSTEMATIC.more_back_m * f64::from(self.failed_plans);
        self.evasion = Some(Evasion::from_contact(back_m, 0.0));
        self.plan_progress = Some(PlanProgress::Due(situation.pose.after_arc(-back_m, 0.0)));
    }

    /// Turn after a cliff. Where cliffs are not known yet the robot turns away before it drives on, because forward travel
    /// restores the distance that it may reverse.
    fn away_rad(&self, reason: Reason) -> f64 {
        match (&self.outline, reason) {
            (Some(Outline::Known), _) => 0.0,
            (_, Reason::CliffLeft) => -SYSTEMATIC.cliff_turn_rad,
            _ => SYSTEMATIC.cliff_turn_rad,
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
            passed.skip_beside(beside);
        }
        match step {
            FollowStep::Going(motion) => return self.go(motion, situation, context),
            FollowStep::Off => context.decide(DecisionKind::LeaveWay, Reason::OffTheWay, 0.0),
            FollowStep::Arrived => {}
        }
        self.follower = None;
        self.plan_progress = Some(PlanProgress::Due(situation.pose));
        TaskStatus::Go(Motion::Halt)
    }

    /// Continues the plan in progress, if there is one.
    fn plan_on(&mut self, situation: &Situation<'_>) {
        if let Some(floor) = &mut self.known_floor {
            floor.go_on();
        }
        self.plan_progress = match self.plan_progress.take() {
            Some(PlanProgress::Due(start)) => Some(self.begin_plan(start, situation)),
            Some(plan_progress) => Some(plan_progress.go_on()),
            None => None,
        };
    }

    /// Begins a plan for the remaining floor, for a robot that sets out from `start`, once the swept floor is recalled and
    /// the map shows the latest contacts.
    fn begin_plan(&mut self, start: Pose2, situation: &Situation<'_>) -> PlanProgress {
        let settings = settings(situation);
        let departure = Departure { start, settings };
        let knowledge = situation.map.knowledge();
        let beyond_m = match self.outline {
            Some(Outline::Growing(margin)) => Some(margin.beyond_m),
            _ => None,
        };
        if matches!(self.outline, Some(Outline::Known)) && self.began.is_none() {
            self.began = Some(knowledge.clone());
            let radius_m = situation.config.body.radius_m;
            self.known_floor = Some(KnownFloor::begin(knowledge.clone(), radius_m, departure));
        }
        let squeezed_m = self.squeeze.radius_m(situation.config.body);
        let beyond_m = beyond_m.map(|beyond_m| match squeezed_m {
            Some(_) => beyond_m.max(SQUEEZE.margin_m),
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
        let counted = PassedFloor::count(&passed, &target, situation.map, &settings);
        self.gain.count(counted.m2());
        self.shares.begin(settings, counted);
        PlanProgress::begin(PlanInputs {
            knowledge: knowledge.clone(),
            beyond_m,
            radius_m: situation.config.body.radius_m + MARGINS.clearance_m,
            squeezed_m,
            began: squeezed_m.filter(|_| self.misses_a_part).and(self.began.clone()),
            blocked: self.obstructions.points(situation.observation.time_us),
            target,
            passed,
            departure,
            frame: self.frame,
        })
    }

    /// Takes the finished plan for the remaining floor; gives what to do instead if there is none to follow.
    fn take_plan(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<TaskStatus> {
        let here = situation.pose;
        match self.plan_progress.take() {
            Some(PlanProgress::Finished { finished, request }) if request.begins_at(here.position()) => {
                self.waits = false;
                self.frame = Some(finished.frame);
                let made = MadePlan {
                    plan: finished.plan,
                    is_blocked: request.is_blocked,
                };
                return self.evaluate(made, situation, context);
            }
            Some(PlanProgress::Finished { .. }) | None => self.plan_progress = Some(PlanProgress::Due(here)),
            unfinished => self.plan_progress = unfinished,
        }
        if !core::mem::replace(&mut self.waits, true) {
            context.decide(DecisionKind::Wait, Reason::Planning, 0.0);
        }
        Some(TaskStatus::Go(Motion::Halt))
    }
}
