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
mod caution;
mod edges;
mod frontier;
mod obstructions;
mod outline;
mod passed;
mod planning;
mod reachable;
mod seeking;
mod share;
mod shyness;
mod squeeze;
mod trail;

use super::astray::Astray;
use super::lane_frame::LaneFrame;
use super::perimeter::LapStep;
use super::plan::{CoveragePlan, Departure, reach_cells};
use crate::action::Motion;
use crate::behavior::Reason;
use crate::geometry::{Point2, Pose2};
use crate::manoeuvre::{Evasion, FollowStep, Follower};
use crate::mapping::Map;
use crate::order::CleaningOrder;
use crate::task::{Mind, Plan, Situation, Task};
use assignment::{Assignment, Next};
pub(crate) use caution::caution;
use edges::Edges;
use frontier::margin_cells;
pub(crate) use obstructions::{Obstructions, encounter};
use outline::{Hope, Outline, knows_home, shuts_in};
use passed::{Passed, Window};
use planning::{Basis, Planning, settings};
pub(crate) use reachable::reachable;
use seeking::{Seeking, Sought};
pub use share::SweptShare;
use share::{PassedFloor, Shares};
use shyness::Shyness;
use squeeze::Squeeze;

/// Gap between body and known obstacles on planned ways, metres; the size of cells adds a little.
pub(super) const KEEP_OFF_M: f64 = 0.01;
/// Lanes overlap by twice this at least, whatever the estimate says of itself.
pub(super) const SIGMA_MIN_M: f64 = 0.01;
/// Way back after a contact: far enough to turn.
const CONTACT_BACK_M: f64 = 0.03;
/// Way back that is added for each plan in a row that brought nothing.
const MORE_BACK_M: f64 = 0.02;
/// Way back at a cliff.
const CLIFF_BACK_M: f64 = 0.08;
/// Turn away from an edge that nobody knew, radians.
const AWAY_RAD: f64 = 1.2;
/// A plan that swept less than this brought nothing, square metres.
const NOTHING_M2: f64 = 0.02;
/// Plans in a row that brought nothing until the robot bounces out of the place.
const VAIN_PLANS_MAX: u32 = 4;
/// Times that obstructions are forgotten in order to try again before `FRESH_WON_M2` were won by it.
const FRESH_STARTS_MAX: u32 = 2;
/// Times that it bounces out of a place before `FRESH_WON_M2` were won by it.
const STRAYS_MAX: u32 = 6;
/// The same while a part of the home is cut off: giving up would leave all of that.
const STRAYS_CUT_OFF_MAX: u32 = 18;
/// Floor that makes a fresh start worth it, square metres.
const FRESH_WON_M2: f64 = 0.5;
/// Less than this share of the floor that was once in reach: something is cut off. A map that is drawn while the robot's
/// place is known to centimetres only loses a little floor along all walls.
const WHOLE_SHARE: f64 = 0.85;

/// The strategy.
#[derive(Debug, Default)]
pub(crate) struct Systematic {
    assignment: Assignment,
    outline: Option<Outline>,
    planning: Option<Planning>,
    /// It stands until the plan is made.
    waits: bool,
    follower: Option<Follower>,
    evasion: Option<Evasion>,
    passed: Option<Passed>,
    /// Generation of the map in which it plans.
    generation: u32,
    /// The frame in which lanes are planned, once it is found in this drawing of the map.
    frame: Option<LaneFrame>,
    obstructions: Obstructions,
    edges: Edges,
    vain_plans: u32,
    fresh_starts: u32,
    astray: Option<Astray>,
    seeking: Seeking,
    strays: u32,
    /// Floor that was passed when obstructions were forgotten last.
    passed_at_start_m2: f64,
    /// Floor that was still open when the last plan was made.
    open_before_m2: f64,
    /// Most floor that could be reached at any time: what is cut off later still counts as not swept.
    floor_m2: f64,
    /// Much less than that can be reached now.
    is_cut_off: bool,
    /// It keeps off what it has just touched.
    shyness: Shyness,
    squeeze: Squeeze,
    shares: Shares,
}

impl Task for Systematic {
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        self.heed_redrawing(situation);
        if let Some(passed) = &mut self.passed
            && !situation.estimate.lost
        {
            passed.follow(situation);
        }
        self.plan_on(situation);
        if let Some(plan) = self.seek_place(situation, mind) {
            return plan;
        }
        if let Some(plan) = self.lap(situation, mind) {
            return plan;
        }
        if let Some(astray) = &mut self.astray {
            if let Some(plan) = astray.step(situation, mind) {
                return plan;
            }
            self.astray = None;
        }
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return Plan::Go(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return Plan::Trouble(reason);
            }
            None => {}
        }
        if let Some(reason) = encounter(situation) {
            return self.evade(reason, situation, mind);
        }
        if self.edges.must_wait(situation.observation.time_us, mind) {
            return Plan::Go(Motion::Halt);
        }
        self.drive(situation, mind)
    }

    fn interrupted(&mut self) {
        if let Some(Outline::Lap(lap)) = &mut self.outline {
            lap.interrupted();
        }
        self.evasion = None;
        self.follower = None;
        self.planning = None;
        self.seeking.interrupted();
        if let Some(astray) = &mut self.astray {
            astray.interrupted();
        }
    }

    fn way(&self) -> Vec<Point2> {
        self.follower.as_ref().map_or_else(Vec::new, Follower::way)
    }

    fn swept_share(&self, map: &Map) -> Option<SweptShare> {
        let wanted = self.assignment.wanted(map);
        self.shares.share(self.floor_m2, |settings| {
            let passed = self.passed.as_ref()?.cells();
            Some(PassedFloor::count(&passed, (&wanted, map), settings))
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
    fn turns_to_next(&mut self, is_missed: bool, (map, mind): (&Map, &mut Mind)) -> bool {
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
        mind.decide("turn-to-part", Reason::NextPart, 0.0);
        (self.floor_m2, self.open_before_m2, self.passed_at_start_m2) = (0.0, 0.0, 0.0);
        (self.vain_plans, self.fresh_starts, self.strays) = (0, 0, 0);
        true
    }

    /// Looks for its own place, once it knows no more where it is in a map that it has.
    fn seek_place(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Option<Plan> {
        if !situation.is_tracked || self.evasion.is_some() {
            return None;
        }
        match self.seeking.step(situation, mind) {
            Sought::Nothing => None,
            Sought::Over => {
                self.interrupted();
                None
            }
            Sought::Still(plan) => Some(plan),
        }
    }

    /// The lap along the walls of an unknown home; `None` when there is none to drive.
    fn lap(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Option<Plan> {
        let outline = self.outline.get_or_insert_with(|| {
            if knows_home(situation) {
                Outline::Known
            } else {
                mind.decide("lap", Reason::NoMap, 0.0);
                Outline::Lap(Box::default())
            }
        });
        let Outline::Lap(lap) = outline else { return None };
        let reason = match lap.step(situation, mind) {
            LapStep::Going(motion) => return Some(Plan::Go(motion)),
            LapStep::Trouble(reason) => return Some(Plan::Trouble(reason)),
            LapStep::Over(reason) => reason,
        };
        let (what, hope) = match reason {
            Reason::BackAtStart => ("contour-closed", Hope::CLOSED),
            Reason::KnownWall => ("end-lap", Hope::KNOWN),
            _ => ("end-lap", Hope::OPEN),
        };
        mind.decide(what, reason, lap.way_m());
        self.outline = Some(Outline::Growing(hope));
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
            self.planning = self.planning.take().map(Planning::afresh);
        }
    }

    /// Backs off from what was met, and remembers it.
    fn evade(&mut self, reason: Reason, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        mind.decide("back-off", reason, 0.0);
        self.obstructions.add(reason, situation);
        self.shyness.touched(reason);
        self.follower = None;
        if situation.at_cliff {
            self.edges.note(situation.observation.time_us);
            self.evasion = Some(Evasion::from_cliff(CLIFF_BACK_M, self.away_rad(reason)));
            // Beside an edge a plan begins where the robot really stands.
            self.planning = None;
        } else {
            let back_m = CONTACT_BACK_M + MORE_BACK_M * f64::from(self.vain_plans);
            self.evasion = Some(Evasion::from_contact(back_m, 0.0));
            // The plan is made meanwhile, for where the robot will stand.
            self.planning = Some(Planning::Due(situation.pose.after_arc(-back_m, 0.0)));
        }
        Plan::Go(Motion::Halt)
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

    fn drive(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        if self.follower.is_none()
            && let Some(instead) = self.take_plan(situation, mind)
        {
            return instead;
        }
        let Some(follower) = &mut self.follower else {
            return Plan::Go(Motion::Halt);
        };
        let mut caution = caution(situation, follower);
        caution.offset_m += self.shyness.offset_m(situation.advance);
        let step = follower.step(situation, caution);
        if let (Some(passed), Some(beside)) = (&mut self.passed, follower.beside(situation)) {
            passed.give_up(beside);
        }
        match step {
            FollowStep::Going(motion) => return Plan::Go(motion),
            FollowStep::Off => mind.decide("leave-way", Reason::OffTheWay, 0.0),
            FollowStep::Arrived => {}
        }
        self.follower = None;
        self.planning = Some(Planning::Due(situation.pose));
        Plan::Go(Motion::Halt)
    }

    /// Goes on with the plan that is being made, if one is.
    fn plan_on(&mut self, situation: &Situation<'_>) {
        self.planning = match self.planning.take() {
            Some(Planning::Due(start)) => Some(self.begin_plan(start, situation)),
            Some(planning) => Some(planning.go_on()),
            None => None,
        };
    }

    /// Begins a plan for what is left, for a robot that sets out from `start`, once it is recalled what was passed and the map
    /// shows what was met.
    fn begin_plan(&mut self, start: Pose2, situation: &Situation<'_>) -> Planning {
        let settings = settings(situation);
        let knowledge = situation.map.knowledge();
        let beyond_m = match self.outline {
            Some(Outline::Growing(hope)) => Some(hope.beyond_m),
            _ => None,
        };
        let squeezed_m = self.squeeze.radius_m(situation.config.body);
        let beyond_m = beyond_m.map(|beyond_m| match squeezed_m {
            Some(_) => beyond_m.max(squeeze::BEYOND_M),
            None => beyond_m,
        });
        let window = Window::around(knowledge, beyond_m.map_or(0, margin_cells));
        let passed = self
            .passed
            .get_or_insert_with(|| Passed::new(situation.map, &window, reach_cells(&settings)));
        if !passed.recall(situation.map) || !situation.map.is_fresh() {
            return Planning::Due(start);
        }
        passed.cover(&window);
        let (passed, wanted) = (passed.cells(), self.assignment.wanted(situation.map));
        let counted = PassedFloor::count(&passed, (&wanted, situation.map), &settings);
        self.shares.begin(settings, counted);
        Planning::begin(Basis {
            knowledge: knowledge.clone(),
            beyond_m,
            radius_m: situation.config.body.radius_m + KEEP_OFF_M,
            squeezed_m,
            blocked: self.obstructions.points(situation.observation.time_us),
            wanted,
            passed,
            departure: Departure { start, settings },
            frame: self.frame,
        })
    }

    /// Takes up the plan that was made for what is left; gives what to do instead if there is none to follow.
    fn take_plan(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Option<Plan> {
        let here = situation.pose;
        match self.planning.take() {
            Some(Planning::Made { made, draft }) if draft.begins_at(here.position()) => {
                self.waits = false;
                self.frame = Some(made.frame);
                return self.judge(made.plan, draft.is_blocked, (situation, mind));
            }
            Some(Planning::Made { .. }) | None => self.planning = Some(Planning::Due(here)),
            unfinished => self.planning = unfinished,
        }
        if !core::mem::replace(&mut self.waits, true) {
            mind.decide("wait", Reason::Planning, 0.0);
        }
        Some(Plan::Go(Motion::Halt))
    }

    /// Follows a plan if it is worth it; gives what to do instead if it is not.
    fn judge(
        &mut self,
        plan: CoveragePlan,
        is_blocked: bool,
        (situation, mind): (&Situation<'_>, &mut Mind),
    ) -> Option<Plan> {
        mind.decide("plan", Reason::UnsweptFloor, plan.time_s);
        if let Some(ended) = self.squeeze.end() {
            return self.judge_squeeze(plan, &ended, (situation, mind));
        }
        let is_vain = (self.open_before_m2 - plan.open_m2).abs() < NOTHING_M2;
        self.vain_plans = if is_vain { self.vain_plans + 1 } else { 0 };
        self.open_before_m2 = plan.open_m2;
        self.floor_m2 = self.floor_m2.max(plan.floor_m2);
        self.shares.take(&plan);
        self.is_cut_off = plan.floor_m2 < WHOLE_SHARE * self.floor_m2;
        if plan.passed_m2() > self.passed_at_start_m2 + FRESH_WON_M2 {
            (self.fresh_starts, self.strays) = (0, 0);
            self.passed_at_start_m2 = plan.passed_m2();
            self.squeeze.start_anew();
        }
        if plan.floor_m2 <= 0.0 {
            if self.turns_to_next(true, (situation.map, mind)) {
                return Some(Plan::Go(Motion::Halt));
            }
            let is_whole_home = self.assignment.is_whole_home();
            return Some(Plan::Finished(if is_whole_home {
                Reason::NoMap
            } else {
                Reason::RestOutOfReach
            }));
        }
        if plan.lanes == 0 {
            return Some(self.end(&plan, is_blocked, (situation, mind)));
        }
        if self.vain_plans > VAIN_PLANS_MAX {
            return Some(self.go_astray(situation, mind));
        }
        self.follower = Some(Follower::new(plan.pieces));
        None
    }

    /// Nothing is left to plan: the end, unless something may have been cut off.
    fn end(
        &mut self,
        plan: &CoveragePlan,
        is_blocked: bool,
        (situation, mind): (&Situation<'_>, &mut Mind),
    ) -> Plan {
        self.is_cut_off = self.is_cut_off || self.is_shut_in(plan, situation);
        if is_blocked && self.fresh_starts < FRESH_STARTS_MAX {
            return self.start_afresh();
        }
        if self.hopes_for_more() {
            return Plan::Go(Motion::Halt);
        }
        if self.assignment.is_whole_home() && self.squeeze.begin(plan) {
            return Plan::Go(Motion::Halt);
        }
        if self.is_cut_off && self.strays < STRAYS_CUT_OFF_MAX {
            return self.go_astray(situation, mind);
        }
        if self.turns_to_next(self.is_cut_off, (situation.map, mind)) {
            return Plan::Go(Motion::Halt);
        }
        let reason = if self.assignment.is_missed {
            Reason::RestOutOfReach
        } else {
            Reason::Finished
        };
        mind.decide("covered", reason, plan.passed_m2() / self.floor_m2);
        Plan::Finished(reason)
    }

    /// Follows a plan for what lies behind a gap if that is worth it; what to do instead if it is not.
    fn judge_squeeze(
        &mut self,
        plan: CoveragePlan,
        ended: &CoveragePlan,
        (situation, mind): (&Situation<'_>, &mut Mind),
    ) -> Option<Plan> {
        if plan.lanes > 0 && plan.open_m2 > squeeze::WORTH_M2 {
            mind.decide("squeeze", Reason::BoxedIn, plan.open_m2);
            self.follower = Some(Follower::new(plan.pieces));
            return None;
        }
        self.squeeze.give_up();
        Some(self.end(ended, false, (situation, mind)))
    }

    /// Hopes for floor farther beyond what is known, once, after a lap that ended for want of anything new: it may have missed a
    /// way on.
    fn hopes_for_more(&mut self) -> bool {
        match &mut self.outline {
            Some(Outline::Growing(hope)) => hope.grow(),
            _ => false,
        }
    }

    /// Whether all of a home is to be cleaned whose map is drawn meanwhile.
    fn is_first_run(&self) -> bool {
        matches!(self.outline, Some(Outline::Growing(_))) && self.assignment.is_whole_home()
    }

    /// Whether a robot that has gone along all walls can hardly get anywhere on the map that it has drawn: it came there.
    fn is_shut_in(&self, plan: &CoveragePlan, situation: &Situation<'_>) -> bool {
        self.is_first_run() && shuts_in(plan.floor_m2, situation.map.free_m2())
    }

    /// Forgets what stood in the way: perhaps it is gone, or never was there.
    fn start_afresh(&mut self) -> Plan {
        self.interrupted();
        self.fresh_starts += 1;
        self.obstructions.clear();
        Plan::Go(Motion::Halt)
    }

    /// No plan works here: bounces out of the place. That ends after a few times, too.
    fn go_astray(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        self.interrupted();
        self.vain_plans = 0;
        self.strays += 1;
        let most = if self.is_cut_off {
            STRAYS_CUT_OFF_MAX
        } else {
            STRAYS_MAX
        };
        if self.strays > most {
            return Plan::Finished(Reason::RestOutOfReach);
        }
        mind.decide("bounce", Reason::BoxedIn, f64::from(self.strays));
        // What was touched in a narrow place blocks the way out of it on the map sooner than in truth.
        self.obstructions.clear();
        self.astray = Some(Astray::from(situation.pose.position()));
        Plan::Go(Motion::Halt)
    }
}
