//! Motion of a running job: departure and escapes first, then the task. Watches check the result.

use super::{Behavior, Mode};
use crate::behavior::JobKind;
use crate::behavior::gyro_rest::RestPace;
use crate::behavior::job::{Detour, Job, Purpose};
use crate::behavior::parameters::{ARMING, GYRO_SETTLING};
use crate::coverage;
use crate::mapping::Map;
use crate::model::action::Motion;
use crate::model::advance::Advance;
use crate::model::command::StrategyName;
use crate::model::decision::DecisionKind;
use crate::model::geometry::Point2;
use crate::model::no_go::NoGo;
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;
use crate::navigation::{Situation, TaskContext, TaskStatus};
use crate::recovery::{self, StuckKind, Traction, Whereabouts};

/// Share of the speed while wheels slip (S14).
const SLIP_SHARE: f64 = 0.5;
/// A job on a map that is being drawn waits for a lost gyro for so long, microseconds: by wheels alone the heading is wrong by some
/// degrees then.
const HEADING_PATIENCE_US: u64 = 60_000_000;
/// A place that took so many recovery behaviors to leave is not entered again in this job.
const POCKET_BEHAVIORS: u8 = 3;

impl Behavior {
    /// A contact began.
    pub(crate) fn count_bump(&mut self) {
        if self.mode == Mode::Working
            && let Some(job) = &mut self.job
        {
            job.figures.bumps += 1;
        }
    }

    pub(super) fn work(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Motion {
        let commanded = self.last_motion;
        let Some(job) = &mut self.job else {
            self.hold(Reason::NoJob, context);
            return Motion::Halt;
        };
        job.figures.time_s += situation.advance.time_s;
        job.figures.path_m += situation.advance.distance_m.abs();
        job.brushes |= !self.facts.touching;
        if let Some(crosses) = coverage::is_off_order(&job.order, situation) {
            job.crosses = crosses;
        }
        job.returns &= situation.map.is_swept(situation.pose.position());
        if situation.advance.onsets.is_held_by_cliff {
            job.edges.note_cliff(self.facts.now_us);
        }
        if self.facts.disarmed.any() {
            return self.wait_for_arm(context);
        }
        self.unarmed_since_us = None;
        let plans_on_map = job.kind == JobKind::Clean(StrategyName::Systematic);
        if plans_on_map && self.gives_up_without_heading(situation, context) {
            return Motion::Halt;
        }
        if plans_on_map && self.settles_gyro(situation) {
            return rest_for_gyro(commanded, context);
        }
        self.watch_pen(situation, context);
        let plan = self.watched_plan(commanded, situation, context);
        let motion = self.follow(plan, situation, context);
        if !self.rests_for_gyro(motion, situation) {
            return motion;
        }
        rest_for_gyro(commanded, context)
    }

    /// Ends a job that needs a map and has no heading to draw it by. A gyro that was lost is waited for: until then the wheels are
    /// counted, and nothing is drawn. Then the robot drives home if it knows where that is. A job that has heard beacons goes on without a
    /// heading.
    fn gives_up_without_heading(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> bool {
        let now_us = self.facts.now_us;
        let Some(job) = &mut self.job else { return false };
        job.has_heard_beacons |= situation.hears_beacons;
        if situation.knows_heading {
            job.without_heading_us = None;
            return false;
        }
        let Some(fault) = situation.gyro_fault else {
            if job.has_heard_beacons {
                return false;
            }
            self.end_job(Reason::NoHeading, context);
            return true;
        };
        let since_us = *job.without_heading_us.get_or_insert(now_us);
        if now_us.saturating_sub(since_us) < HEADING_PATIENCE_US {
            return false;
        }
        let has_home = situation.map.dock().is_some() || situation.beams.has_received_dock();
        if has_home {
            self.turn_home(Reason::Gyro(fault), context);
        } else {
            self.end_job(Reason::Gyro(fault), context);
        }
        true
    }

    /// Watches whether the robot is unstuck.
    fn watch_pen(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        let Some(job) = &mut self.job else { return };
        match job
            .pen
            .follow(situation.pose.position(), situation.advance.time_s)
        {
            Whereabouts::Inside => {}
            Whereabouts::MovedOff => job.recovery.move_off(),
            Whereabouts::Left(troubled_at) => {
                let behaviors = job.recovery.leave();
                if behaviors == 0 {
                    return;
                }
                context.decide(DecisionKind::Free, Reason::CameFree, f64::from(behaviors));
                if behaviors >= POCKET_BEHAVIORS {
                    self.pocket = troubled_at;
                }
            }
        }
    }

    /// Whether the robot must rest before its first motion, because it was just switched on and the gyro's bias is not measured yet. Where it
    /// was put down against something it backs off first: a bumper that stays pressed meanwhile would be taken for stuck (S7).
    fn settles_gyro(&mut self, situation: &Situation<'_>) -> bool {
        let settled_rad_per_s = if situation.is_tracked {
            GYRO_SETTLING.tracked_sigma_rad_per_s
        } else {
            GYRO_SETTLING.mapping_sigma_rad_per_s
        };
        let Some(job) = &mut self.job else { return false };
        if situation.touching && !self.facts.docked {
            if job.figures.path_m == 0.0 {
                job.moves_before_rest_m = GYRO_SETTLING.backed_max_m;
            }
            return false;
        }
        job.figures.path_m <= job.moves_before_rest_m
            && job.figures.time_s < GYRO_SETTLING.wait_max_s
            && situation
                .gyro_bias_sigma_rad_per_s
                .is_some_and(|sigma| sigma > settled_rad_per_s)
    }

    /// Whether to rest for the gyro's bias: only during forward travel, which a rest does not disturb.
    fn rests_for_gyro(&mut self, motion: Motion, situation: &Situation<'_>) -> bool {
        let is_ahead = matches!(motion, Motion::Drive { speed_m_per_s, .. } if speed_m_per_s > 0.0);
        let Some(job) = &mut self.job else { return false };
        if situation.observation.gyro_heading_rad.is_none() || situation.gyro_fault.is_some() {
            return false;
        }
        let budget = RestPace::of(situation.is_tracked);
        job.gyro_rest.follow(self.facts.now_us, is_ahead, budget)
    }

    fn wait_for_arm(&mut self, context: &mut TaskContext) -> Motion {
        let since_us = *self.unarmed_since_us.get_or_insert(self.facts.now_us);
        if self.facts.now_us.saturating_sub(since_us) > ARMING.unarmed_max_us {
            let reason = if self.facts.disarmed.link_lost {
                Reason::LinkLost
            } else {
                Reason::ArmRefused
            };
            self.hold(reason, context);
        } else {
            self.ask_to_arm();
        }
        Motion::Rest
    }

    /// The plan of the task or a detour, unless a watch reports trouble first.
    fn watched_plan(
        &mut self,
        commanded: Motion,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        let Some(job) = &mut self.job else {
            return TaskStatus::Go(Motion::Halt);
        };
        let traction = job.slip.judge(situation.advance);
        let is_careful = situation.gyro_fault.is_some() && matches!(job.kind, JobKind::Clean(_));
        if traction == Traction::Lost {
            return TaskStatus::Finished(Reason::Slip);
        }
        let stands_still = job.progress.is_stuck(commanded, situation.advance);
        // The firmware asks the gyro whether the robot turns. One that is known to be wrong only makes it rest.
        let is_believed = situation.gyro_fault.is_none();
        let first_report = is_believed && self.facts.not_moving && commanded != Motion::Rest;
        if stands_still || first_report {
            job.progress = recovery::ProgressWatch::default();
            return TaskStatus::Trouble(Reason::NotMoving);
        }
        if self.facts.not_moving {
            // The firmware rests for a second after it saw no progress; the escape starts after that.
            return TaskStatus::Go(Motion::Rest);
        }
        if job
            .edges
            .must_wait(situation.at_cliff, self.facts.now_us, context)
        {
            return TaskStatus::Go(Motion::Halt);
        }
        if job.detour.is_none() && job.pen.is_due() {
            return TaskStatus::Trouble(Reason::ShutIn);
        }
        let plan = self.plan(situation, context);
        match plan {
            TaskStatus::Finished(reason) if reason.ends_plans() && self.ends_in_pen(situation) => {
                TaskStatus::Trouble(Reason::ShutIn)
            }
            TaskStatus::Finished(reason) => self.end_untouched(reason, situation),
            TaskStatus::Go(motion) if traction == Traction::Slipping || is_careful => {
                TaskStatus::Go(slowed(motion))
            }
            other => other,
        }
    }

    /// The task has ended. Where the robot touches something it backs off before the job ends.
    fn end_untouched(&mut self, reason: Reason, situation: &Situation<'_>) -> TaskStatus {
        match &mut self.job {
            Some(job) if situation.touching && situation.reverse_budget_m > 0.0 && job.ending.is_none() => {
                job.back_off_at_the_end(reason);
                TaskStatus::Go(Motion::Halt)
            }
            _ => TaskStatus::Finished(reason),
        }
    }

    fn plan(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let Some(job) = &mut self.job else {
            return TaskStatus::Go(Motion::Halt);
        };
        if let Some(detour) = &mut job.detour {
            if let Some(motion) = detour.sequence.step(situation) {
                return TaskStatus::Go(motion);
            }
            job.detour = None;
            if let Some(reason) = job.ending {
                return TaskStatus::Finished(reason);
            }
            job.pen.try_again();
            job.task.interrupted();
            // Motion since the last step belongs to the detour.
            let still = Situation {
                advance: Advance {
                    time_s: 0.0,
                    ..Advance::default()
                },
                ..*situation
            };
            return job.task.step(&still, context);
        }
        job.task.step(situation, context)
    }

    fn follow(&mut self, plan: TaskStatus, situation: &Situation<'_>, context: &mut TaskContext) -> Motion {
        match plan {
            TaskStatus::Go(motion) => return motion,
            TaskStatus::Trouble(reason) => self.escape(reason, situation, context),
            TaskStatus::Finished(Reason::Slip) => self.enter(Mode::Stuck, Reason::Slip, context),
            TaskStatus::Finished(reason) => self.finish(reason, situation, context),
        }
        Motion::Halt
    }

    fn escape(&mut self, reason: Reason, situation: &Situation<'_>, context: &mut TaskContext) {
        let Some(job) = &mut self.job else { return };
        job.task.interrupted();
        let stuck_kind = recovery::stuck_kind(reason);
        let Some(behavior) = job.recovery.trouble(stuck_kind) else {
            self.enter(Mode::Stuck, reason, context);
            return;
        };
        match stuck_kind {
            StuckKind::Held => job.pen.hold(situation.pose.position()),
            StuckKind::Penned => job.pen.begin_recovery(situation.pose.position()),
        }
        context.decide(behavior.decision(), reason, 0.0);
        let sequence = recovery::escape(behavior, &mut context.random);
        job.detour = Some(Detour {
            sequence,
            purpose: Purpose::Escape,
        });
    }

    /// Whether a job for the whole home ends only because the robot is enclosed: it has swept less than half of the known floor.
    fn ends_in_pen(&self, situation: &Situation<'_>) -> bool {
        let is_cleaning = |job: &&Job| {
            let is_whole_home = job.order.is_for_whole_home();
            matches!(job.kind, JobKind::Clean(_)) && is_whole_home && job.pen.holds_the_end()
        };
        self.job.as_ref().filter(is_cleaning).is_some()
            && situation.map.swept_m2() < 0.5 * situation.map.free_m2()
    }

    /// Corners of the planned path of the running or waiting job.
    pub(crate) fn planned_path(&self) -> Vec<Point2> {
        self.job
            .as_ref()
            .map_or_else(Vec::new, |job| job.task.planned_path())
    }

    /// Share of its target floor that the running or waiting job has swept.
    pub(crate) fn swept_share(&self, map: &Map) -> Option<SweptShare> {
        self.job.as_ref()?.task.swept_share(map)
    }

    /// Floor that the running or waiting job keeps out of.
    pub(crate) fn avoided(&self) -> &[NoGo] {
        self.job.as_ref().map_or(&[], Job::avoided)
    }

    /// What the running or waiting job is to clean.
    pub(crate) fn order(&self) -> Option<&CleaningOrder> {
        self.job.as_ref().map(|job| &job.order)
    }

    /// The job is put off until the pack is charged.
    pub(crate) fn awaits_charge(&self) -> bool {
        self.mode == Mode::Recharging || self.put_off.is_some()
    }

    /// Kind of the running or waiting job.
    pub(crate) fn job_kind(&self) -> Option<JobKind> {
        self.job.as_ref().map(|job| job.kind)
    }
}

/// Rests, and records the reason when the rest begins.
fn rest_for_gyro(commanded: Motion, context: &mut TaskContext) -> Motion {
    if commanded != Motion::Halt {
        context.decide(DecisionKind::Rest, Reason::GyroDrift, 0.0);
    }
    Motion::Halt
}

fn slowed(motion: Motion) -> Motion {
    match motion {
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s,
        } => Motion::Drive {
            speed_m_per_s: SLIP_SHARE * speed_m_per_s,
            turn_rad_per_s: SLIP_SHARE * turn_rad_per_s,
        },
        other => other,
    }
}
