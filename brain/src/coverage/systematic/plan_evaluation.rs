//! What to do with a finished plan: follow it, end the job, or treat the floor as cut off.

use super::parameters::{EVALUATION, SQUEEZE};
use super::{Outline, Systematic, shuts_in};
use crate::coverage::escape_bounce::EscapeBounce;
use crate::coverage::plan::CoveragePlan;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{PathFollower, Situation, Task, TaskContext, TaskStatus};

/// A plan, and how it was made.
pub(super) struct MadePlan {
    pub(super) plan: CoveragePlan,
    /// Obstructions that are not on the map were avoided.
    pub(super) is_blocked: bool,
}

impl Systematic {
    /// Follows a plan if it is worth it; otherwise gives what to do instead.
    pub(super) fn evaluate(
        &mut self,
        made: MadePlan,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> Option<TaskStatus> {
        let plan = &made.plan;
        context.decide(DecisionKind::Plan, Reason::UnsweptFloor, plan.time_s);
        if let Some(ended) = self.squeeze.end() {
            return if self.follows_squeeze(made.plan, context) {
                None
            } else {
                let ended = MadePlan {
                    plan: ended,
                    is_blocked: false,
                };
                Some(self.end(&ended, situation, context))
            };
        }
        let has_failed = (self.open_before_m2 - plan.open_m2).abs() < EVALUATION.nothing_m2;
        self.failed_plans = if has_failed { self.failed_plans + 1 } else { 0 };
        self.open_before_m2 = plan.open_m2;
        let is_elsewhere = self.shares.is_elsewhere(plan);
        if is_elsewhere {
            self.shares.pass_over();
        } else {
            self.floor_m2 = self.floor_m2.max(plan.floor_m2);
            self.take_share(plan, situation);
        }
        self.is_cut_off = is_elsewhere || plan.floor_m2 < EVALUATION.whole_share * self.floor_m2;
        self.misses_a_part = plan.floor_m2 < (1.0 - EVALUATION.rest_share) * self.floor_m2;
        if plan.passed_m2() > self.passed_at_start_m2 + EVALUATION.fresh_won_m2 {
            (self.fresh_starts, self.escapes) = (0, 0);
            self.passed_at_start_m2 = plan.passed_m2();
            self.squeeze.reset_attempts();
        }
        if plan.floor_m2 <= 0.0 {
            if self.turns_to_next(true, situation.map, context) {
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
            return Some(self.end(&made, situation, context));
        }
        if !self.gain.is_worth_it() {
            return Some(self.end_part(situation, context));
        }
        if self.failed_plans > EVALUATION.failed_plans_max {
            return Some(self.bounce_out(situation, context));
        }
        if self.begins_lap(situation, context) {
            return Some(TaskStatus::Go(Motion::Halt));
        }
        self.follower = Some(PathFollower::new(made.plan.segments));
        None
    }

    /// Begins another lap along the walls where the robot has come to a part of the home that no lap went round: lanes over floor
    /// of unknown shape are short, and without walls the place gets lost.
    fn begins_lap(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> bool {
        // A robot that measures no distances bumps its way along walls.
        let proximity = &situation.config.sensors.proximity;
        let measures_distances = !proximity.sensors().is_empty() && proximity.response.near_m.is_none();
        let explores = matches!(self.outline, Some(Outline::Growing(_))) && self.assignment.is_whole_home();
        if !measures_distances || !explores {
            return false;
        }
        let Some(lap) = self.laps.next_from(situation.pose.position()) else {
            return false;
        };
        context.decide(DecisionKind::Lap, Reason::NewFloor, 0.0);
        self.outline = Some(Outline::Lap(lap));
        true
    }

    /// No floor is left to plan: ends the job, unless something may be cut off.
    fn end(&mut self, made: &MadePlan, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let plan = &made.plan;
        self.is_cut_off = self.is_cut_off || self.is_shut_in(plan, situation);
        if made.is_blocked && self.fresh_starts < EVALUATION.fresh_starts_max {
            return self.start_fresh();
        }
        if self.widens_margin() {
            return TaskStatus::Go(Motion::Halt);
        }
        if self.assignment.is_whole_home() && self.squeeze.begin(plan) {
            return TaskStatus::Go(Motion::Halt);
        }
        if self.is_cut_off && self.escapes < EVALUATION.escapes_cut_off_max {
            return self.bounce_out(situation, context);
        }
        self.end_part(situation, context)
    }

    /// Nothing that is worth its time is left of this part: goes on with the next one, or ends the job.
    fn end_part(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let share = self.swept_share(situation.map).map_or(0.0, |swept| swept.share);
        let is_cut_off = self.is_cut_off || situation.map.connected_share() < 1.0;
        let has_lost_a_part = self.is_floor_shut_off() && share < 1.0 - EVALUATION.rest_share;
        let is_missed = (is_cut_off && share < EVALUATION.whole_share) || has_lost_a_part;
        if self.turns_to_next(is_missed, situation.map, context) {
            return TaskStatus::Go(Motion::Halt);
        }
        let reason = if self.assignment.is_missed {
            Reason::RestOutOfReach
        } else if !self.gain.is_worth_it() && share < 1.0 - EVALUATION.rest_share {
            Reason::NotWorthTheTime
        } else {
            Reason::Finished
        };
        context.decide(DecisionKind::Covered, reason, share);
        TaskStatus::Finished(reason)
    }

    /// Follows a plan through a gap if it is worth it; `false` when the robot gives up the gap.
    fn follows_squeeze(&mut self, plan: CoveragePlan, context: &mut TaskContext) -> bool {
        self.squeeze.record(plan.open_m2);
        if plan.lanes > 0 && plan.open_m2 > SQUEEZE.worth_m2 {
            context.decide(DecisionKind::Squeeze, Reason::BoxedIn, plan.open_m2);
            self.follower = Some(PathFollower::new(plan.segments));
            return true;
        }
        self.squeeze.end_checks();
        if matches!(self.outline, Some(Outline::Known))
            && plan.open_m2 < EVALUATION.rest_share * self.floor_m2
        {
            // The part that is cut off now was swept before.
            self.is_cut_off = false;
        }
        false
    }

    /// Updates the swept share from this plan, unless the robot is cut off: such a plan does not know the floor swept
    /// elsewhere. While the robot explores a home, floor turns out to be furniture, so the newest plan has the best figure
    /// for the floor. In a known home, floor that is unreachable now still counts.
    fn take_share(&mut self, plan: &CoveragePlan, situation: &Situation<'_>) {
        let known_m2 = match &self.outline {
            // Floor assumed far beyond the known part does not count yet.
            Some(Outline::Growing(margin)) if margin.is_far() => plan.floor_m2.min(situation.map.free_m2()),
            // Floor that earlier runs reached and that is cut off since before the job counts as not swept.
            Some(Outline::Known) if self.assignment.is_whole_home() => {
                plan.floor_m2
                    / situation
                        .map
                        .connected_share()
                        .max(EVALUATION.connected_share_min)
            }
            _ => plan.floor_m2,
        };
        let most_m2 = self.shares.know_floor(known_m2);
        let (reached_m2, floor_m2) = match &self.outline {
            Some(Outline::Growing(_)) => (plan.floor_m2, known_m2),
            _ => (known_m2, most_m2),
        };
        if reached_m2 < EVALUATION.whole_share * most_m2 && self.shares.has_plan() {
            return self.shares.pass_over();
        }
        self.shares.take(plan, floor_m2);
    }

    /// Widens the optimistic margin once, after a lap that ended because it showed nothing new: it may have missed a
    /// passage.
    fn widens_margin(&mut self) -> bool {
        match &mut self.outline {
            Some(Outline::Growing(margin)) => margin.grow(),
            _ => false,
        }
    }

    /// Whether the whole home is being cleaned while its map is drawn.
    fn is_first_run(&self) -> bool {
        matches!(self.outline, Some(Outline::Growing(_))) && self.assignment.is_whole_home()
    }

    /// Whether a robot that has followed all walls can reach hardly any floor of its own map, which must then be wrong.
    fn is_shut_in(&self, plan: &CoveragePlan, situation: &Situation<'_>) -> bool {
        self.is_first_run() && shuts_in(plan.floor_m2, situation.map.free_m2())
    }

    /// Forgets obstructions: they may be gone, or may never have existed.
    fn start_fresh(&mut self) -> TaskStatus {
        self.interrupted();
        self.fresh_starts += 1;
        self.obstructions.clear();
        TaskStatus::Go(Motion::Halt)
    }

    /// No plan works here: bounces out of the place, a bounded number of times.
    fn bounce_out(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.interrupted();
        self.failed_plans = 0;
        self.escapes += 1;
        let most = if self.is_cut_off {
            EVALUATION.escapes_cut_off_max
        } else {
            EVALUATION.escapes_max
        };
        if self.escapes > most {
            return TaskStatus::Finished(Reason::RestOutOfReach);
        }
        context.decide(DecisionKind::Bounce, Reason::BoxedIn, f64::from(self.escapes));
        // In a narrow place obstructions block the path out on the map more than in reality.
        self.obstructions.clear();
        if self.is_cut_off {
            self.squeeze.allow_one(EVALUATION.rest_share * self.floor_m2);
        }
        self.escape_bounce = Some(EscapeBounce::from(situation.pose.position()));
        TaskStatus::Go(Motion::Halt)
    }
}
