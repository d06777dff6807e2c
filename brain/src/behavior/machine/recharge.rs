//! Recharging in the middle of a job.
//!
//! A cleaning job that ends because of low charge is *put off*: a docking job replaces it, and on the dock it comes back and waits until the
//! pack is charged. When the dock is not found, it waits for a person. A job that retries from the dock
//! ([`crate::behavior::dock_retry`]) is put off in the same way.

use core::task::Poll;

use super::contacts::is_loss;
use super::{Behavior, Mode};
use crate::behavior::job::Job;
use crate::behavior::parameters::CHARGING;
use crate::behavior::{JobCheckpoint, JobKind};
use crate::coverage;
use crate::docking;
use crate::model::command::StrategyName;
use crate::model::energy::{Activity, EnergyLearner, EnergyModel, RemainingWork};
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext};

impl Behavior {
    /// Whether a job waits on the dock, for charge or for what stands in its way.
    pub(crate) fn waits_on_dock(&self) -> bool {
        self.mode == Mode::Recharging
    }

    /// Learnt energy use of driving and cleaning.
    pub(crate) fn energy(&self) -> EnergyModel {
        self.energy.model()
    }

    /// What the pack holds, 0..=1.
    pub(crate) fn battery_charge(&self) -> Option<f64> {
        self.facts
            .battery_charge
            .map(f64::from)
            .filter(|charge| charge.is_finite())
    }

    /// Starts with what was learnt earlier.
    pub(crate) fn learn_energy(&mut self, model: EnergyModel) {
        self.energy = EnergyLearner::of(model);
    }

    /// Learns from the charge that was used since the last step.
    pub(super) fn watch_energy(&mut self, situation: &Situation<'_>) {
        let activity = match self.mode {
            Mode::Working if self.runs_cleaners() => Activity::Cleaning,
            Mode::Working => Activity::Driving,
            _ => Activity::Other,
        };
        let charge = situation.observation.battery_charge;
        self.energy.update(situation.advance.time_s, activity, charge);
    }

    /// The running job ends because of low charge. It is put off, unless the rest of it is not worth another charge.
    pub(super) fn turn_home_for_charge(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        if self.has_little_left(situation) {
            self.finish(Reason::CrumbsLeft, situation, context);
        } else {
            self.turn_home(Reason::BatteryLow, context);
        }
    }

    /// Whether the rest is not worth the charge for its path.
    fn has_little_left(&self, situation: &Situation<'_>) -> bool {
        let (Some(swept), Some(way_m)) = (self.swept_share(situation.map), self.return_path_m) else {
            return false;
        };
        let left = RemainingWork {
            left_m2: swept.left_m2,
            share: 1.0 - swept.share,
            dock_path_m: way_m,
        };
        self.energy.model().is_negligible(left, &self.config)
    }

    /// Whether the charge might not suffice for the path home any more.
    pub(super) fn must_go_home(&mut self, situation: &Situation<'_>) -> bool {
        if self.facts.battery_low {
            return true;
        }
        let charge = situation.observation.battery_charge;
        let Some(charge) = charge.filter(|charge| *charge < CHARGING.return_check_below) else {
            return false;
        };
        let Some(way_m) = self.search_return_path(situation) else {
            return false;
        };
        let cruise_m_per_s = self.config.speeds.cruise_m_per_s;
        f64::from(charge) < self.energy.model().charge_to_return(way_m, cruise_m_per_s)
    }

    /// Searches the path home from time to time, over several steps. Returns its length in the step in which it is found.
    fn search_return_path(&mut self, situation: &Situation<'_>) -> Option<f64> {
        if let Some(looking) = &mut self.return_search {
            let Poll::Ready(way_m) = looking.go_on() else {
                return None;
            };
            self.return_search = None;
            self.return_path_m = way_m;
            return way_m;
        }
        let now_us = self.facts.now_us;
        let is_due = self
            .return_check_us
            .is_none_or(|looked_us| now_us >= looked_us + CHARGING.return_check_us);
        if is_due {
            self.return_check_us = Some(now_us);
            self.return_search = docking::path_home_m(situation);
        }
        None
    }

    /// A docking job replaces the running job and takes over its figures. A job that ends because of low charge is put off.
    pub(super) fn turn_home(&mut self, reason: Reason, context: &mut TaskContext) {
        let figures = self.figures();
        let before = self.job.replace(Job::new(JobKind::Dock, figures));
        let goes_on = matches!(reason, Reason::BatteryLow | Reason::LookAgain);
        // Nobody waits any more where it was sent hours ago.
        self.put_off = before.filter(|job| goes_on && job.kind.cleans());
        if let Some(job) = &mut self.put_off {
            job.interrupt();
        }
        self.enter(Mode::Working, reason, context);
    }

    /// The running job has finished. A cleaning job drives home if the map has a dock, or if beams of the dock were received during
    /// the job: a robot that started elsewhere has never been on it.
    pub(super) fn finish(&mut self, reason: Reason, situation: &Situation<'_>, context: &mut TaskContext) {
        let has_cleaned = matches!(self.job_kind(), Some(JobKind::Clean(_)))
            && (reason.ends_plans() || matches!(reason, Reason::ByStatistics | Reason::CrumbsLeft));
        if has_cleaned && self.retries_from_dock(reason, situation) {
            return self.turn_home(Reason::LookAgain, context);
        }
        let reason = if has_cleaned {
            self.honest(reason, situation)
        } else {
            reason
        };
        let is_whole_home = self.order().is_some_and(CleaningOrder::is_for_whole_home);
        self.has_covered_home |=
            has_cleaned && is_whole_home && self.job_kind() == Some(JobKind::Clean(StrategyName::Systematic));
        let has_home = situation.map.dock().is_some() || situation.beams.has_received_dock();
        if has_cleaned && has_home {
            self.turn_home(reason, context);
        } else {
            self.give_up_home(reason, context);
        }
    }

    /// The reason for the end of a cleaning job, which is another one when less than half of what was asked is swept.
    fn honest(&self, reason: Reason, situation: &Situation<'_>) -> Reason {
        let plans = self.job_kind() == Some(JobKind::Clean(StrategyName::Systematic));
        let order = self.order().filter(|_| reason.ends_plans() && plans);
        let from = situation.pose.position();
        let radius_m = self.config.body.radius_m;
        order
            .and_then(|order| coverage::left_most(order, situation.map, from, radius_m))
            .unwrap_or(reason)
    }

    /// It has docked at the end of the path home.
    pub(super) fn arrive(&mut self, context: &mut TaskContext) {
        let figures = self.figures();
        self.home_us = Some(self.facts.now_us);
        match self.put_off.take() {
            None => self.end_job(Reason::Docked, context),
            Some(job) => {
                self.job = Some(Job { figures, ..job });
                self.arrive_for_charge(context);
            }
        }
    }

    /// The job waits on the dock, for charge or for what stands in its way.
    pub(super) fn arrive_for_charge(&mut self, context: &mut TaskContext) {
        self.enter(Mode::Recharging, self.waits_for(), context);
    }

    /// Why the job waits on the dock, while nothing is wrong there.
    fn waits_for(&self) -> Reason {
        if self.is_retry_due() {
            Reason::LookAgain
        } else {
            Reason::Recharging
        }
    }

    /// Whether the robot, which has lost the contacts in this way, has slipped off by itself and should dock again.
    pub(super) fn slips_off(&mut self, loss: Reason) -> bool {
        let opened_us = self.contact_watch.opened_us().unwrap_or(self.facts.now_us);
        let held_us = self
            .home_us
            .take()
            .map(|home_us| opened_us.saturating_sub(home_us));
        let slipped = match loss {
            Reason::PushedOff => held_us.is_some_and(|held_us| held_us < CHARGING.slips_off_us),
            Reason::DockContactLost => held_us.is_some_and(|held_us| held_us < CHARGING.settles_off_us),
            _ => false,
        };
        slipped && self.slips_left()
    }

    /// A person stopped it: it does not return to the contacts by itself.
    pub(super) fn stays_where_it_is(&mut self) {
        self.home_us = None;
    }

    /// Counts a slip and returns whether another attempt is allowed.
    pub(super) fn slips_left(&mut self) -> bool {
        let left = self.slips < CHARGING.slips_max;
        self.slips += u32::from(left);
        left
    }

    /// The link is lost on the dock: the job is put off as on the path home.
    pub(super) fn put_off_again(&mut self) {
        let figures = self.figures();
        self.put_off = self.job.replace(Job::new(JobKind::Dock, figures));
    }

    /// The path home has ended elsewhere: the job that was put off waits for a person.
    pub(super) fn give_up_home(&mut self, reason: Reason, context: &mut TaskContext) {
        let figures = self.figures();
        match self.put_off.take() {
            None => self.end_job(reason, context),
            Some(job) => {
                self.job = Some(Job { figures, ..job });
                self.enter(Mode::Paused, reason, context);
            }
        }
    }

    /// Resumes when the pack is charged; waits for a person when somebody took the robot off its dock. Without power or contact it goes on
    /// waiting where it is.
    pub(super) fn watch_charge(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        let loss = self.contact_watch.loss(self.facts.now_us);
        if let Some(loss) = loss
            && self.leaves_contacts(loss, context)
        {
            return;
        }
        self.tell_of_charger(loss, context);
        let may_start = !self.facts.battery_low && !self.facts.wheel_drop;
        let charge = situation.observation.battery_charge;
        let charged = charge.is_some_and(|charge| charge >= self.config.battery_charged);
        if may_start && self.may_retry(situation) {
            self.announce(Reason::LookAgain, context);
        } else if may_start && charged && !self.is_retry_due() {
            self.announce(Reason::Charged, context);
        }
    }

    /// Whether the robot, which has lost the contacts in this way, docks again or waits for a person. A dock that sends beams has power,
    /// so the contacts may close better the next time.
    fn leaves_contacts(&mut self, loss: Reason, context: &mut TaskContext) -> bool {
        let has_power = self.contact_watch.receives();
        let docks_again =
            self.slips_off(loss) || (loss == Reason::DockContactLost && has_power && self.slips_left());
        if docks_again {
            self.put_off_again();
            self.announce(Reason::DockMissed, context);
        } else if matches!(loss, Reason::PushedOff | Reason::LiftedOff) {
            self.hold(loss, context);
        } else {
            return false;
        }
        true
    }

    /// Reports when the dock lost its power or its contact, or the charger has stopped because of a fault. The job keeps waiting, because
    /// current flows again once a person has removed the cause.
    fn tell_of_charger(&mut self, loss: Option<Reason>, context: &mut TaskContext) {
        let reason = match (loss, self.facts.charger_fault) {
            (Some(loss), _) => loss,
            // The contacts flicker.
            (None, _) if is_loss(self.reason) && !self.is_back_on_contacts() => return,
            (None, true) => Reason::ChargerFault,
            (None, false) => self.waits_for(),
        };
        if self.reason != reason {
            self.enter(Mode::Recharging, reason, context);
        }
    }

    /// The part of the job that must survive a restart. A job that waits for charge is saved as one that drives home; after the restart
    /// it detects the dock.
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

    /// Restores a job after a restart.
    pub(crate) fn restore(&mut self, checkpoint: JobCheckpoint) {
        let job = |kind| Job::with_order(kind, checkpoint.order.clone(), checkpoint.figures);
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
