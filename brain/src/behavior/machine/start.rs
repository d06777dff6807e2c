//! How a job begins: announcement, arming, and the firmware's confirmation (S24).

use super::{Behavior, JobStart, Mode};
use crate::behavior::job::Job;
use crate::behavior::parameters::ARMING;
use crate::behavior::{JobFigures, JobKind};
use crate::model::action::{Arm, Motion, Tone};
use crate::model::decision::DecisionKind;
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

/// Tones of the announcement (S24): three beeps.
const BEEP: Tone = Tone {
    pitch_hz: 880,
    duration_ms: 150,
};
const GAP: Tone = Tone {
    pitch_hz: 0,
    duration_ms: 150,
};

impl Behavior {
    /// Waits for the end of the announcement, arms, and waits for the firmware's confirmation.
    pub(super) fn start(&mut self, since_us: u64, context: &mut TaskContext) -> Motion {
        let waited_us = self.facts.now_us.saturating_sub(since_us);
        if waited_us < ARMING.announcement_us {
            return Motion::Rest;
        }
        let asked_yet = self.armed_us.is_some();
        if asked_yet && !self.facts.disarmed.any() {
            let reason = self.reason;
            if self.is_on_dock()
                && let Some(job) = &mut self.job
            {
                job.depart(&mut context.random);
            }
            self.enter(Mode::Working, reason, context);
            return Motion::Halt;
        }
        if waited_us > ARMING.announcement_us + ARMING.confirmed_within_us {
            self.enter(Mode::Paused, Reason::ArmRefused, context);
            return Motion::Rest;
        }
        self.ask_to_arm();
        Motion::Rest
    }

    /// Arms, but not more often than answers can arrive.
    pub(super) fn ask_to_arm(&mut self) {
        let due = self
            .armed_us
            .is_none_or(|armed_us| self.facts.now_us >= armed_us + ARMING.again_us);
        if due {
            self.armed_us = Some(self.facts.now_us);
            self.arm = Some(Arm {
                undock: self.facts.docked || self.facts.disarmed.docked,
            });
        }
    }

    /// Announces and starts the present job (S24).
    pub(super) fn announce(&mut self, reason: Reason, context: &mut TaskContext) {
        if let (Mode::Recharging, Some(job)) = (self.mode, &mut self.job) {
            job.returns = true;
            if job.dock_retry.begins() {
                job.task.looks_again();
            }
        }
        self.enter(
            Mode::Starting {
                since_us: self.facts.now_us,
            },
            reason,
            context,
        );
        self.tones.extend([BEEP, GAP, BEEP, GAP, BEEP]);
    }

    /// Begins a new job and discards the old one.
    pub(super) fn begin(&mut self, kind: JobKind, order: CleaningOrder, context: &mut TaskContext) {
        self.job = Some(Job::with_order(kind, order, JobFigures::default()));
        self.put_off = None;
        self.slips = 0;
        self.no_current_tries = 0;
        if kind.cleans() {
            self.job_start = JobStart::FreshMap;
            if !self.facts.knows_heading && !self.facts.hears_beacons {
                context.decide(DecisionKind::KeepNoMap, Reason::NoHeading, 0.0);
            }
        }
        self.announce(Reason::Command, context);
    }
}
