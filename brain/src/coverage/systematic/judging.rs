//! What becomes of a plan once it is made: it is followed, or nothing is left, or something must have been cut off.

use super::{Outline, Systematic, shuts_in, squeeze};
use crate::coverage::escape_bounce::EscapeBounce;
use crate::coverage::plan::CoveragePlan;
use crate::model::action::Motion;
use crate::model::reason::Reason;
use crate::navigation::{PathFollower, Situation, Task, TaskContext, TaskStatus};

/// A plan that swept less than this brought nothing, square metres.
const NOTHING_M2: f64 = 0.02;
/// Plans in a row that brought nothing until the robot bounces out of the place.
const FAILED_PLANS_MAX: u32 = 4;
/// Times that obstructions are forgotten in order to try again before `FRESH_WON_M2` were won by it.
const FRESH_STARTS_MAX: u32 = 2;
/// Times that it bounces out of a place before `FRESH_WON_M2` were won by it.
const ESCAPES_MAX: u32 = 6;
/// The same while a part of the home is cut off: giving up would leave all of that.
const ESCAPES_CUT_OFF_MAX: u32 = 18;
/// Floor that makes a fresh start worth it, square metres.
const FRESH_WON_M2: f64 = 0.5;
/// Less than this share of the floor that was once in reach: something is cut off. A map that is drawn while the robot's
/// place is known to centimetres only loses a little floor along all walls.
const WHOLE_SHARE: f64 = 0.85;
/// Unswept floor that is worth waiting for who stands before it, as a share of the floor that was once in reach.
const REST_SHARE: f64 = 0.05;

impl Systematic {
    /// Follows a plan if it is worth it; gives what to do instead if it is not.
    pub(super) fn judge(
        &mut self,
        plan: CoveragePlan,
        is_blocked: bool,
        (situation, context): (&Situation<'_>, &mut TaskContext),
    ) -> Option<TaskStatus> {
        context.decide("plan", Reason::UnsweptFloor, plan.time_s);
        if let Some(ended) = self.squeeze.end() {
            return self.judge_squeeze(plan, &ended, (situation, context));
        }
        let has_failed = (self.open_before_m2 - plan.open_m2).abs() < NOTHING_M2;
        self.failed_plans = if has_failed { self.failed_plans + 1 } else { 0 };
        self.open_before_m2 = plan.open_m2;
        let is_elsewhere = self.shares.is_elsewhere(&plan);
        if is_elsewhere {
            self.shares.pass_over();
        } else {
            self.floor_m2 = self.floor_m2.max(plan.floor_m2);
            self.take_share(&plan, situation);
        }
        self.is_cut_off = is_elsewhere || plan.floor_m2 < WHOLE_SHARE * self.floor_m2;
        self.misses_a_part = plan.floor_m2 < (1.0 - REST_SHARE) * self.floor_m2;
        if plan.passed_m2() > self.passed_at_start_m2 + FRESH_WON_M2 {
            (self.fresh_starts, self.escapes) = (0, 0);
            self.passed_at_start_m2 = plan.passed_m2();
            self.squeeze.start_anew();
        }
        if plan.floor_m2 <= 0.0 {
            if self.turns_to_next(true, (situation.map, context)) {
                return Some(TaskStatus::Go(Motion::Halt));
            }
            let is_whole_home = self.assignment.is_whole_home();
            return Some(TaskStatus::Finished(if is_whole_home {
                Reason::NoMap
            } else {
                Reason::RestOutOfReach
            }));
        }
        if plan.lanes == 0 {
            return Some(self.end(&plan, is_blocked, (situation, context)));
        }
        if self.failed_plans > FAILED_PLANS_MAX {
            return Some(self.bounce_out(situation, context));
        }
        self.follower = Some(PathFollower::new(plan.segments));
        None
    }

    /// Nothing is left to plan: the end, unless something may have been cut off.
    fn end(
        &mut self,
        plan: &CoveragePlan,
        is_blocked: bool,
        (situation, context): (&Situation<'_>, &mut TaskContext),
    ) -> TaskStatus {
        self.is_cut_off = self.is_cut_off || self.is_shut_in(plan, situation);
        if is_blocked && self.fresh_starts < FRESH_STARTS_MAX {
            return self.start_afresh();
        }
        if self.widens_margin() {
            return TaskStatus::Go(Motion::Halt);
        }
        if self.assignment.is_whole_home() && self.squeeze.begin(plan) {
            return TaskStatus::Go(Motion::Halt);
        }
        if self.is_cut_off && self.escapes < ESCAPES_CUT_OFF_MAX {
            return self.bounce_out(situation, context);
        }
        let share = self.swept_share(situation.map).map_or(0.0, |swept| swept.share);
        let is_missed = self.is_cut_off && share < WHOLE_SHARE;
        if self.turns_to_next(is_missed, (situation.map, context)) {
            return TaskStatus::Go(Motion::Halt);
        }
        let reason = if self.assignment.is_missed {
            Reason::RestOutOfReach
        } else {
            Reason::Finished
        };
        context.decide("covered", reason, share);
        TaskStatus::Finished(reason)
    }

    /// Follows a plan for what lies behind a gap if that is worth it; what to do instead if it is not.
    fn judge_squeeze(
        &mut self,
        plan: CoveragePlan,
        ended: &CoveragePlan,
        (situation, context): (&Situation<'_>, &mut TaskContext),
    ) -> Option<TaskStatus> {
        self.squeeze.saw(plan.open_m2);
        if plan.lanes > 0 && plan.open_m2 > squeeze::WORTH_M2 {
            context.decide("squeeze", Reason::BoxedIn, plan.open_m2);
            self.follower = Some(PathFollower::new(plan.segments));
            return None;
        }
        self.squeeze.give_up();
        if matches!(self.outline, Some(Outline::Known)) && plan.open_m2 < REST_SHARE * self.floor_m2 {
            // What is cut off now was swept before.
            self.is_cut_off = false;
        }
        Some(self.end(ended, false, (situation, context)))
    }

    /// Counts the share that is swept by this plan, unless it is one of a robot that is cut off: that knows nothing of what was
    /// passed elsewhere. While the home is being found out, floor turns out to be furniture, so that the newest plan knows best
    /// how much there is; in a home that is known, what has got out of reach is floor still.
    fn take_share(&mut self, plan: &CoveragePlan, situation: &Situation<'_>) {
        let known_m2 = match &self.outline {
            // What is hoped for far beyond what is known is no floor yet.
            Some(Outline::Growing(margin)) if margin.is_far() => plan.floor_m2.min(situation.map.free_m2()),
            _ => plan.floor_m2,
        };
        let most_m2 = self.shares.know_floor(known_m2);
        if plan.floor_m2 < WHOLE_SHARE * most_m2 && self.shares.has_plan() {
            return self.shares.pass_over();
        }
        let floor_m2 = match &self.outline {
            Some(Outline::Growing(_)) => known_m2,
            _ => most_m2,
        };
        self.shares.take(plan, floor_m2);
    }

    /// Hopes for floor farther beyond what is known, once, after a lap that ended for want of anything new: it may have missed a
    /// way on.
    fn widens_margin(&mut self) -> bool {
        match &mut self.outline {
            Some(Outline::Growing(margin)) => margin.grow(),
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
    fn start_afresh(&mut self) -> TaskStatus {
        self.interrupted();
        self.fresh_starts += 1;
        self.obstructions.clear();
        TaskStatus::Go(Motion::Halt)
    }

    /// No plan works here: bounces out of the place. That ends after a few times, too.
    fn bounce_out(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.interrupted();
        self.failed_plans = 0;
        self.escapes += 1;
        let most = if self.is_cut_off {
            ESCAPES_CUT_OFF_MAX
        } else {
            ESCAPES_MAX
        };
        if self.escapes > most {
            return TaskStatus::Finished(Reason::RestOutOfReach);
        }
        context.decide("bounce", Reason::BoxedIn, f64::from(self.escapes));
        // What was touched in a narrow place blocks the way out of it on the map sooner than in truth.
        self.obstructions.clear();
        if self.is_cut_off {
            self.squeeze.allow_one(REST_SHARE * self.floor_m2);
        }
        self.escape_bounce = Some(EscapeBounce::from(situation.pose.position()));
        TaskStatus::Go(Motion::Halt)
    }
}
