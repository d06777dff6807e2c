//! Changes of the mode by observations, the most severe cause first.

use super::{Behavior, Mode};
use crate::behavior::JobKind;
use crate::behavior::job::Job;
use crate::behavior::parameters::ARMING;
use crate::model::decision::DecisionKind;
use crate::model::fault::Fault;
use crate::model::link_fault::LinkFault;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext};

/// A cliff sensor that fails its self-test for this long, microseconds, is a fault. Sunlight or a dark rug cause shorter failures.
const SENSOR_PATIENCE_US: u64 = 2_000_000;

/// A job in a large home may take so many T0 of its known floor: twice what 95 % of it take. Known homes are swept in 1.5, first runs end
/// within 2.5.
const BUDGET_T0: f64 = 3.0;

impl Job {
    /// Whether its time is used up: the budget, or what the floor that is known by then takes, if that is more. Counting the floor visits all
    /// of it, so it is done when a limit is reached and not in each step.
    fn is_past(&mut self, budget_s: f64, situation: &Situation<'_>) -> bool {
        if self.figures.time_s < budget_s.max(self.extended_to_s) {
            return false;
        }
        let (body, speeds) = (situation.config.body, situation.config.speeds);
        let t0_s = situation.map.free_m2() / (body.swath_m * speeds.cruise_m_per_s).max(f64::EPSILON);
        self.extended_to_s = BUDGET_T0 * t0_s;
        self.figures.time_s >= self.extended_to_s
    }
}

impl Behavior {
    /// The fault in this observation, if any.
    pub(super) fn fault(&mut self) -> Option<Fault> {
        if !self.facts.cliff_sensor {
            self.cliff_sensor_since_us = None;
            return self.facts.fault;
        }
        let now_us = self.facts.now_us;
        let since_us = *self.cliff_sensor_since_us.get_or_insert(now_us);
        let lasting = now_us.saturating_sub(since_us) >= SENSOR_PATIENCE_US;
        self.facts.fault.or(lasting.then_some(Fault::CliffSensor))
    }

    /// Changes the mode where the observation demands it.
    pub(super) fn react(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        if !self.facts.link_up {
            self.lose_link(context);
            return;
        }
        if let Mode::Disconnected { since_us, resume } = self.mode {
            self.reconnect(since_us, resume, context);
        }
        if self.react_to_fault(context) {
            return;
        }
        self.react_to_person(context);
        self.react_to_dock(situation, context);
        self.react_to_budgets(situation, context);
    }

    fn lose_link(&mut self, context: &mut TaskContext) {
        let reason = self.facts.link_fault.map_or(Reason::LinkLost, Reason::Link);
        let resume = match self.mode {
            Mode::Disconnected { .. } => {
                if matches!(self.reason, Reason::LinkLost | Reason::Link(_)) {
                    self.reason = reason;
                }
                return;
            }
            Mode::Starting { .. } | Mode::Working => true,
            Mode::Recharging => {
                self.put_off_again();
                true
            }
            Mode::Manual(_) => {
                self.centre_first = true;
                false
            }
            _ => false,
        };
        // Nobody knows how long a clock that has jumped was away.
        let has_jumped = self.facts.link_fault == Some(LinkFault::ClockJumped);
        let since_us = (!has_jumped).then_some(self.up_until_us);
        self.enter(Mode::Disconnected { since_us, resume }, reason, context);
    }

    fn reconnect(&mut self, since_us: Option<u64>, resume: bool, context: &mut TaskContext) {
        let short = since_us
            .is_some_and(|since_us| self.facts.now_us.saturating_sub(since_us) < ARMING.short_outage_us);
        match (&self.job, resume) {
            // It was driving home or is on the dock already.
            (Some(_), true) if self.facts.docked && self.drives_home() => self.arrive(context),
            (Some(_), true) if short && !self.facts.disarmed.not_armed => {
                self.enter(Mode::Working, Reason::LinkRestored, context);
            }
            (Some(_), true) => {
                let restored = self.reason == Reason::Restored;
                let reason = if restored {
                    Reason::Restored
                } else {
                    Reason::Continued
                };
                self.announce(reason, context);
            }
            _ => self.hold(Reason::LinkRestored, context),
        }
    }

    /// True while there is a fault or it waits to be acknowledged.
    fn react_to_fault(&mut self, context: &mut TaskContext) -> bool {
        match (self.mode, self.facts.fault) {
            (Mode::Error { .. }, Some(fault)) => self.reason = Reason::Fault(fault),
            (_, Some(fault)) => {
                self.centre_first |= matches!(self.mode, Mode::Manual(_));
                self.enter(Mode::Error { acknowledged: false }, Reason::Fault(fault), context);
            }
            (Mode::Error { acknowledged: true }, None) => {
                let reason = self.reason;
                self.hold(reason, context);
                return false;
            }
            (Mode::Error { acknowledged: false }, None) => {}
            _ => return false,
        }
        true
    }

    /// Lifted, stopped at the button, stopped by somebody else's `stop`, or the lease of a person who drives is over.
    fn react_to_person(&mut self, context: &mut TaskContext) {
        let disarmed = self.facts.disarmed;
        let ready = match self.mode {
            Mode::Working => true,
            Mode::Manual(drive) => drive.ready,
            _ => false,
        };
        let moving = matches!(self.mode, Mode::Working | Mode::Manual(_));
        let active = moving || matches!(self.mode, Mode::Starting { .. } | Mode::Stuck);
        let reason = if active && self.facts.wheel_drop {
            Reason::WheelDrop
        } else if ready && disarmed.button_stop {
            Reason::ButtonStop
        } else if matches!(self.mode, Mode::Manual(drive) if drive.valid_until_us <= self.facts.now_us) {
            Reason::LeaseEnded
        } else if ready && disarmed.stopped {
            Reason::Stopped
        } else {
            return;
        };
        self.centre_first |= matches!(self.mode, Mode::Manual(_));
        self.hold(reason, context);
    }

    fn react_to_dock(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        match self.mode {
            Mode::Idle if self.facts.docked && self.is_back_on_contacts() => {
                self.enter(Mode::Docked, Reason::Docked, context);
            }
            Mode::Docked if !self.facts.docked => self.come_off(context),
            Mode::Docked => self.watch_dry_dock(context),
            Mode::Working if !self.facts.docked && self.waits_for_current() => self.lose_contacts(context),
            Mode::Recharging => self.watch_charge(situation, context),
            Mode::Paused if self.put_off.is_none() && self.gets_charge_at_last() => {
                self.arrive_for_charge(context);
            }
            Mode::Paused if self.put_off.is_none() && self.hears_dock_again() => {
                self.put_off_again();
                self.announce(Reason::DockBeam, context);
            }
            // A person carried it to the dock.
            Mode::Paused if self.facts.docked && self.put_off.is_some() && self.drives_home() => {
                self.arrive(context);
            }
            Mode::Starting { .. } | Mode::Working if self.facts.docked => {
                if self.drives_home() {
                    self.meet_contacts(context);
                } else if self.mode == Mode::Working && self.facts.disarmed.docked {
                    self.leave_dock(context);
                }
            }
            _ => {}
        }
    }

    /// The contacts opened without a command.
    fn come_off(&mut self, context: &mut TaskContext) {
        let Some(loss) = self.contact_watch.loss(self.facts.now_us) else {
            return;
        };
        if self.slips_off(loss) {
            self.job = Some(Job::new(JobKind::Dock, self.figures()));
            self.announce(Reason::DockMissed, context);
        } else {
            self.enter(Mode::Idle, loss, context);
        }
    }

    fn drives_home(&self) -> bool {
        self.job.as_ref().is_some_and(|job| job.kind == JobKind::Dock)
    }

    /// It drove onto the dock while cleaning, and leaves it.
    fn leave_dock(&mut self, context: &mut TaskContext) {
        if let Some(job) = &mut self.job
            && !job.is_departing()
        {
            job.depart(&mut context.random);
            context.decide(DecisionKind::Depart, Reason::Docked, 0.0);
        }
    }

    fn react_to_budgets(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        if self.mode != Mode::Working || self.waits_for_current() {
            return;
        }
        let Some(job) = &mut self.job else { return };
        if self.facts.disarmed.not_armed && !job.is_departing() {
            self.announce(Reason::NotArmed, context);
        } else if job.kind == JobKind::Dock {
            // Docking has its own budget.
        } else if job.is_past(self.config.task_budget_s, situation) {
            self.turn_home(Reason::TaskBudget, context);
        } else if self.must_go_home(situation) {
            self.turn_home_for_charge(situation, context);
        }
    }
}
