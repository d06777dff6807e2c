//! Home for charge, and on with the job afterwards.
//!
//! A cleaning job that ends for the pack's sake is *put off*: a job that looks for the dock takes its place, and on the dock
//! it comes back and waits until the pack is charged. A lost dock leaves it with a person. A job that looks again from the dock
//! ([`crate::behavior::second_look`]) is put off in the same way.

use core::task::Poll;

use super::{Behavior, Mode};
use crate::behavior::job::Job;
use crate::behavior::{JobCheckpoint, JobKind};
use crate::docking;
use crate::model::command::StrategyName;
use crate::model::energy::{Activity, EnergyModel, EnergyWatch, Leftover};
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::navigation::{Mind, Situation};

/// Below this charge the way home is looked at, and again after `LOOK_US`: it takes a plan each time.
const LOOK_BELOW: f32 = 0.5;
const LOOK_US: u64 = 20_000_000;
/// Contacts that open so soon after they have closed were met at their edge; and the times that it comes back then.
const SLIPS_OFF_US: u64 = 1_000_000;
const SLIPS_MAX: u32 = 3;

impl Behavior {
    /// What driving and cleaning take, as far as it was learnt.
    pub(crate) fn energy(&self) -> EnergyModel {
        self.energy.model()
    }

    /// Takes up what was learnt earlier.
    pub(crate) fn learn_energy(&mut self, model: EnergyModel) {
        self.energy = EnergyWatch::of(model);
    }

    /// Learns from what the pack lost since the last step.
    pub(super) fn watch_energy(&mut self, situation: &Situation<'_>) {
        let activity = match self.mode {
            Mode::Working if self.runs_cleaners() => Activity::Cleaning,
            Mode::Working => Activity::Driving,
            _ => Activity::Other,
        };
        let charge = situation.observation.battery_charge;
        self.energy.follow(situation.advance.time_s, activity, charge);
    }

    /// The running job ends for the pack's sake: it is put off, unless what is left of it is not worth a charge.
    pub(super) fn turn_home_for_charge(&mut self, situation: &Situation<'_>, mind: &mut Mind) {
        if self.leaves_crumbs(situation) {
            self.finish(Reason::CrumbsLeft, situation, mind);
        } else {
            self.turn_home(Reason::BatteryLow, mind);
        }
    }

    /// Weighs what is left against the charge that its ways would take.
    fn leaves_crumbs(&self, situation: &Situation<'_>) -> bool {
        let (Some(swept), Some(way_m)) = (self.swept_share(situation.map), self.home_way_m) else {
            return false;
        };
        let left = Leftover {
            left_m2: swept.left_m2,
            share: 1.0 - swept.share,
            way_m,
        };
        let budget = (self.config.body.swath_m, self.config.speeds.cruise_m_per_s);
        self.energy.model().are_crumbs(left, budget)
    }

    /// Whether so little charge is left that the way home might become too long.
    pub(super) fn must_go_home(&mut self, situation: &Situation<'_>) -> bool {
        if self.facts.battery_low {
            return true;
        }
        let charge = situation.observation.battery_charge;
        let Some(charge) = charge.filter(|charge| *charge < LOOK_BELOW) else {
            return false;
        };
        let Some(way_m) = self.look_for_home(situation) else {
            return false;
        };
        let cruise_m_per_s = self.config.speeds.cruise_m_per_s;
        f64::from(charge) < self.energy.model().charge_to_return(way_m, cruise_m_per_s)
    }

    /// Looks now and then how long the way home is, some steps long; gives it when it is found.
    fn look_for_home(&mut self, situation: &Situation<'_>) -> Option<f64> {
        if let Some(looking) = &mut self.way_home {
            let Poll::Ready(way_m) = looking.go_on() else {
                return None;
            };
            self.way_home = None;
            self.home_way_m = way_m;
            return way_m;
        }
        let now_us = self.facts.now_us;
        let is_due = self
            .way_home_us
            .is_none_or(|looked_us| now_us >= looked_us + LOOK_US);
        if is_due {
            self.way_home_us = Some(now_us);
            self.way_home = docking::way_home_m(situation);
        }
        None
    }

    /// The running job becomes a search for the dock and keeps its figures. One that ends for the pack's sake is put off.
    pub(super) fn turn_home(&mut self, reason: Reason, mind: &mut Mind) {
        let figures = self.figures();
        let before = self.job.replace(Job::new(JobKind::Dock, figures));
        let goes_on = matches!(reason, Reason::BatteryLow | Reason::LookAgain);
        self.put_off = before.filter(|job| goes_on && job.kind != JobKind::Dock);
        if let Some(job) = &mut self.put_off {
            job.interrupt();
        }
        self.enter(Mode::Working, reason, mind);
    }

    /// The running job is at its end. One that has cleaned goes home if the map tells where that is, or the dock's beams were heard
    /// on the way: who began somewhere else has never stood on it.
    pub(super) fn finish(&mut self, reason: Reason, situation: &Situation<'_>, mind: &mut Mind) {
        let has_cleaned = matches!(self.job_kind(), Some(JobKind::Clean(_)))
            && matches!(
                reason,
                Reason::Finished | Reason::RestOutOfReach | Reason::ByStatistics | Reason::CrumbsLeft
            );
        if has_cleaned && self.takes_second_look(reason, situation) {
            return self.turn_home(Reason::LookAgain, mind);
        }
        let is_whole_home = self.order().is_some_and(CleaningOrder::is_for_whole_home);
        self.has_covered_home |=
            has_cleaned && is_whole_home && self.job_kind() == Some(JobKind::Clean(StrategyName::Systematic));
        let has_home = situation.map.dock().is_some() || situation.beams.knows_a_dock();
        if has_cleaned && has_home {
            self.turn_home(reason, mind);
        } else {
            self.give_up_home(reason, mind);
        }
    }

    /// On the dock at the end of the way home.
    pub(super) fn arrive(&mut self, mind: &mut Mind) {
        let figures = self.figures();
        self.home_us = Some(self.facts.now_us);
        match self.put_off.take() {
            None => self.end_job(Reason::Docked, mind),
            Some(job) => {
                self.job = Some(Job { figures, ..job });
                self.enter(Mode::Recharging, Reason::Recharging, mind);
            }
        }
    }

    /// Whether the robot, which is not on the dock any more, has slipped off by itself and should try again.
    pub(super) fn slips_off(&mut self) -> bool {
        let since_us = self.home_us.take().map(|home_us| self.facts.now_us - home_us);
        since_us.is_some_and(|since_us| since_us < SLIPS_OFF_US)
            && !self.facts.wheel_drop
            && self.slips_left()
    }

    /// A person wants it to stand: it does not come back to its contacts by itself.
    pub(super) fn stays_where_it_is(&mut self) {
        self.home_us = None;
    }

    /// Counts a slip, and tells whether there may be one more try.
    pub(super) fn slips_left(&mut self) -> bool {
        let left = self.slips < SLIPS_MAX;
        self.slips += u32::from(left);
        left
    }

    /// Nobody can see the dock: the job waits as it did on the way home.
    pub(super) fn put_off_again(&mut self) {
        let figures = self.figures();
        self.put_off = self.job.replace(Job::new(JobKind::Dock, figures));
    }

    /// The way home has ended elsewhere: what was put off waits for a person.
    pub(super) fn give_up_home(&mut self, reason: Reason, mind: &mut Mind) {
        let figures = self.figures();
        match self.put_off.take() {
            None => self.end_job(reason, mind),
            Some(job) => {
                self.job = Some(Job { figures, ..job });
                self.enter(Mode::Paused, reason, mind);
            }
        }
    }

    /// Goes on when the pack is charged; waits for a person when somebody took the robot off its dock.
    pub(super) fn watch_charge(&mut self, situation: &Situation<'_>, mind: &mut Mind) {
        self.tell_of_charger(mind);
        let may_start = !self.facts.battery_low && !self.facts.wheel_drop;
        let charge = situation.observation.battery_charge;
        let charged = charge.is_some_and(|charge| charge >= self.config.battery_charged);
        if !self.facts.docked && self.slips_off() {
            self.put_off_again();
            self.announce(Reason::DockMissed, mind);
        } else if !self.facts.docked {
            self.hold(Reason::Released, mind);
        } else if may_start && self.may_look_again(charge) {
            self.announce(Reason::LookAgain, mind);
        } else if may_start && charged {
            self.announce(Reason::Charged, mind);
        }
    }

    /// A job that waits for charge says so when the charger has stopped for a fault, and goes on waiting: once a person has seen
    /// to it, current flows again.
    fn tell_of_charger(&mut self, mind: &mut Mind) {
        let reason = match self.facts.charger_fault {
            true => Reason::ChargerFault,
            false => Reason::Recharging,
        };
        if self.reason != reason {
            self.enter(Mode::Recharging, reason, mind);
        }
    }

    /// What must survive a restart of the job. One that waits for charge is told as one that drives home: its successor finds
    /// itself on the dock.
    pub(crate) fn checkpoint(&self) -> Option<JobCheckpoint> {
        let running = match self.mode {
            Mode::Starting { .. } | Mode::Working | Mode::Recharging => true,
            Mode::Disconnected { resume, .. } => resume,
            _ => false,
        };
        self.job.as_ref().map(|job| {
            let goes_on = self.put_off.as_ref().map(|put_off| put_off.kind);
            let cleaning = self.put_off.as_ref().unwrap_or(job);
            let plain = JobCheckpoint {
                kind: job.kind,
                order: cleaning.order.clone(),
                figures: job.figures,
                running,
                goes_on,
            };
            if self.mode == Mode::Recharging {
                JobCheckpoint {
                    kind: JobKind::Dock,
                    goes_on: Some(job.kind),
                    ..plain
                }
            } else {
                plain
            }
        })
    }

    /// Takes up a job after a restart.
    pub(crate) fn restore(&mut self, checkpoint: JobCheckpoint) {
        let job = |kind| Job::with_order((kind, checkpoint.order.clone()), checkpoint.figures);
        self.job = Some(job(checkpoint.kind));
        self.put_off = checkpoint.goes_on.map(|kind| Job {
            returns: true,
            ..job(kind)
        });
        self.mode = Mode::Disconnected {
            since_us: None,
            resume: checkpoint.running,
        };
        self.reason = Reason::Restored;
    }
}
