//! The modes, and how a step runs through them.

mod admission;
mod contacts;
mod dock_retry;
mod manual;
mod reaction;
mod recharge;
mod start;
mod work;

use super::contact_watch::ContactWatch;
use super::facts::Facts;
use super::job::Job;
use super::{BehaviorState, JobFigures, JobKind, Status};
use crate::behavior::parameters::ARMING;
use crate::model::action::{Arm, Motion, Tone};
use crate::model::command::{JobCommand, StrategyName};
use crate::model::config::BrainConfig;
use crate::model::energy::EnergyLearner;
use crate::model::geometry::Point2;
use crate::model::gradual::Gradual;
use crate::model::reason::Reason;
use crate::navigation::parameters::CHASSIS;
use crate::navigation::{Situation, TaskContext, free_side, round_wheel_rad_per_s};
use manual::ManualDrive;

/// What the state machine is in. [`BehaviorState`] is derived from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// Link down. With `resume` the job goes on by itself afterwards; `since_us` is `None` when nobody knows how long ago
    /// the link was up.
    Disconnected { since_us: Option<u64>, resume: bool },
    /// No job.
    Idle,
    /// Announcing, then arming.
    Starting { since_us: u64 },
    /// The job drives.
    Working,
    /// On the dock.
    Docked,
    /// On the dock; the job resumes when the pack is charged.
    Recharging,
    /// A person drives.
    Manual(ManualDrive),
    /// The job waits.
    Paused,
    /// The job could not go on.
    Stuck,
    /// A fault stands.
    Error { acknowledged: bool },
}

/// What the shell and the map must do after a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Intent {
    pub(crate) motion: Motion,
    pub(crate) cleaners: bool,
    pub(crate) arm: Option<Arm>,
    pub(crate) tones: Vec<Tone>,
    pub(crate) job_start: JobStart,
    /// A place where the robot was stuck, now that it is free.
    pub(crate) pocket: Option<Point2>,
}

/// Whether a job began in this step that wants an empty map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JobStart {
    /// No.
    None,
    /// Yes.
    FreshMap,
}

/// The state machine.
#[derive(Debug)]
pub(crate) struct Behavior {
    pub(super) config: BrainConfig,
    pub(super) mode: Mode,
    pub(super) reason: Reason,
    pub(super) job: Option<Job>,
    /// A job that was put off because of low charge while the robot drives home.
    pub(super) put_off: Option<Job>,
    pub(super) energy: EnergyLearner,
    /// When the path home was last searched, microseconds.
    pub(super) return_check_us: Option<u64>,
    /// The search for its length, while it runs.
    pub(super) return_search: Option<Gradual<Option<f64>>>,
    /// Length of the path home by the last search, metres.
    pub(super) return_path_m: Option<f64>,
    pub(super) facts: Facts,
    /// When the link was last known to be up, microseconds.
    pub(super) up_until_us: u64,
    pub(super) cliff_sensor_since_us: Option<u64>,
    pub(super) unarmed_since_us: Option<u64>,
    /// A person's stick must come to the centre before it drives again (S23).
    pub(super) centre_first: bool,
    pub(super) last_motion: Motion,
    figures: JobFigures,
    pub(super) armed_us: Option<u64>,
    pub(super) arm: Option<Arm>,
    pub(super) tones: Vec<Tone>,
    pub(super) job_start: JobStart,
    pub(super) pocket: Option<Point2>,
    /// Since when it waits on contacts without current, and how often it has docked again for that.
    pub(super) contacts_us: Option<u64>,
    pub(super) no_current_tries: u32,
    pub(super) contact_watch: ContactWatch,
    /// When it docked, and how often it has slipped off since it was sent.
    pub(super) home_us: Option<u64>,
    pub(super) slips: u32,
    halt_until_us: u64,
    /// A job for the whole home has finished, so all of the home that can be reached is known.
    pub(super) has_covered_home: bool,
}

impl Behavior {
    pub(crate) fn new(config: BrainConfig) -> Self {
        Self {
            config,
            mode: Mode::Disconnected {
                since_us: None,
                resume: false,
            },
            reason: Reason::StartUp,
            job: None,
            put_off: None,
            energy: EnergyLearner::default(),
            return_check_us: None,
            return_search: None,
            return_path_m: None,
            facts: Facts::default(),
            up_until_us: 0,
            cliff_sensor_since_us: None,
            unarmed_since_us: None,
            centre_first: false,
            last_motion: Motion::Rest,
            figures: JobFigures::default(),
            halt_until_us: 0,
            armed_us: None,
            arm: None,
            tones: Vec::new(),
            job_start: JobStart::None,
            pocket: None,
            contacts_us: None,
            no_current_tries: 0,
            contact_watch: ContactWatch::default(),
            home_us: None,
            slips: 0,
            has_covered_home: false,
        }
    }

    pub(crate) fn status(&self) -> Status {
        let strategy = match self.job.as_ref().map(|job| job.kind) {
            Some(JobKind::Clean(strategy)) => Some(strategy),
            _ => None,
        };
        let resumable = self.admit_resume().is_ok();
        Status {
            state: self.state(),
            reason: self.reason,
            strategy,
            resumable,
        }
    }

    pub(super) fn state(&self) -> BehaviorState {
        match self.mode {
            Mode::Disconnected { .. } => BehaviorState::Disconnected,
            Mode::Idle => BehaviorState::Idle,
            Mode::Starting { .. } => BehaviorState::Starting,
            Mode::Working => match self.job.as_ref().map(|job| job.kind) {
                Some(JobKind::Spot) => BehaviorState::Spot,
                Some(JobKind::GoTo) => BehaviorState::Going,
                Some(JobKind::Dock) => BehaviorState::Docking,
                Some(JobKind::Clean(_)) | None => BehaviorState::Cleaning,
            },
            Mode::Docked | Mode::Recharging => BehaviorState::Docked,
            Mode::Manual(_) => BehaviorState::Manual,
            Mode::Paused => BehaviorState::Paused,
            Mode::Stuck => BehaviorState::Stuck,
            Mode::Error { .. } => BehaviorState::Error,
        }
    }

    /// Figures of the running or last job, without the swept area, which the map has.
    pub(crate) fn figures(&self) -> JobFigures {
        self.job.as_ref().map_or(self.figures, |job| job.figures)
    }

    /// Floor is forbidden that paths may lead over: the job plans again, and so does the one that waits for its return.
    pub(crate) fn discard_plans(&mut self) {
        for job in self.job.iter_mut().chain(&mut self.put_off) {
            job.discard_plans();
        }
    }

    /// Whether it cleans the whole home at this moment.
    pub(crate) fn cleans_whole_home(&self) -> bool {
        self.mode == Mode::Working
            && self.job.as_ref().is_some_and(|job| {
                let cleans = matches!(job.kind, JobKind::Clean(_));
                cleans && job.order.is_for_whole_home() && job.avoided().is_empty()
            })
    }

    /// The map begins anew: nothing that the job has planned or counted on the one before holds. Other strategies than the systematic one
    /// count time and turns, which stay.
    pub(crate) fn begin_in_new_map(&mut self) {
        let by_map = JobKind::Clean(StrategyName::Systematic);
        if let Some(job) = self.job.as_mut().filter(|job| job.kind == by_map) {
            job.begin_task_anew();
        }
    }

    /// Whether a planned job for the whole home has finished by itself.
    pub(crate) const fn has_covered_home(&self) -> bool {
        self.has_covered_home
    }

    /// One step: commands, observation, motion.
    pub(crate) fn step(
        &mut self,
        situation: &Situation<'_>,
        commands: &[&JobCommand],
        context: &mut TaskContext,
    ) -> Intent {
        if self.facts.link_up {
            self.up_until_us = self.facts.now_us;
        }
        self.facts = Facts::read(situation.observation, self.config.battery_low);
        self.facts.knows_heading = situation.knows_heading;
        self.facts.fault = self.fault();
        let receives_dock = situation.beams.current().is_any();
        self.contact_watch
            .follow(&self.facts, &situation.advance, receives_dock);
        for command in commands {
            match self.admit(command, (situation.map, situation.estimate)) {
                Ok(()) => self.obey(command, context),
                Err(refusal) => context.refuse_job(refusal),
            }
        }
        self.watch_energy(situation);
        self.react(situation, context);
        let wish = self.act(situation, context);
        let motion = self.permitted(wish, situation);
        self.last_motion = motion;
        Intent {
            motion,
            cleaners: self.runs_cleaners(),
            arm: self.arm.take(),
            tones: core::mem::take(&mut self.tones),
            job_start: core::mem::replace(&mut self.job_start, JobStart::None),
            pocket: self.pocket.take(),
        }
    }

    fn act(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Motion {
        match self.mode {
            Mode::Disconnected { .. } => Motion::Rest,
            Mode::Idle
            | Mode::Docked
            | Mode::Recharging
            | Mode::Paused
            | Mode::Stuck
            | Mode::Error { .. } => self.rest(),
            Mode::Starting { since_us } => self.start(since_us, context),
            // The charger starts only while no motor turns.
            Mode::Working if self.waits_for_current() => self.rest(),
            Mode::Working => self.work(situation, context),
            Mode::Manual(drive) => self.drive_manually(drive),
        }
    }

    fn rest(&self) -> Motion {
        if self.facts.now_us < self.halt_until_us {
            Motion::Halt
        } else {
            Motion::Rest
        }
    }

    /// Changes the mode. Every change of mode is made here, so each has a decision and a reason.
    pub(super) fn enter(&mut self, mode: Mode, reason: Reason, context: &mut TaskContext) {
        let moved = self.state().moves();
        self.mode = mode;
        self.reason = reason;
        self.armed_us = None;
        self.unarmed_since_us = None;
        self.contacts_us = None;
        let state = self.state();
        if moved && !state.moves() {
            self.halt_until_us = self.facts.now_us + ARMING.halt_us;
            if let Some(job) = &mut self.job {
                job.interrupt();
            }
        }
        context.decide(state.decision(), reason, 0.0);
    }

    /// Ends the job and keeps its figures.
    pub(super) fn end_job(&mut self, reason: Reason, context: &mut TaskContext) {
        if let Some(job) = self.job.take() {
            self.figures = job.figures;
        }
        self.put_off = None;
        self.enter(self.mode_without_job(), reason, context);
    }

    pub(super) fn mode_without_job(&self) -> Mode {
        if self.facts.docked {
            Mode::Docked
        } else {
            Mode::Idle
        }
    }

    /// Interrupts: the job waits, if there is one.
    pub(super) fn hold(&mut self, reason: Reason, context: &mut TaskContext) {
        let mode = if self.job.is_some() {
            Mode::Paused
        } else {
            self.mode_without_job()
        };
        self.enter(mode, reason, context);
    }

    /// Whether brushes and suction run.
    pub(super) fn runs_cleaners(&self) -> bool {
        match self.mode {
            Mode::Working => self.job.as_ref().is_some_and(|job| {
                job.kind.cleans() && job.brushes && !job.returns && !job.crosses && !job.is_departing()
            }),
            Mode::Manual(drive) => drive.cleaners,
            _ => false,
        }
    }

    /// The last check. It removes motion that the firmware would have to refuse and reverse travel over unknown ground, and slows the
    /// robot on a poor link.
    fn permitted(&self, wish: Motion, situation: &Situation<'_>) -> Motion {
        let Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s,
        } = wish
        else {
            return wish;
        };
        let facts = &self.facts;
        if !facts.link_up
            || facts.wheel_drop
            || facts.fault.is_some()
            || facts.disarmed.any()
            || facts.not_moving
        {
            return Motion::Rest;
        }
        let share = situation.observation.speed_share.clamp(0.0, 1.0);
        let speed_m_per_s = if self.may_back(situation) {
            speed_m_per_s
        } else {
            speed_m_per_s.max(0.0)
        };
        if share.is_nan() || share <= 0.0 {
            return Motion::Halt;
        }
        let at_cliff = facts.at_cliff || facts.cliff_sensor;
        if facts.touching || at_cliff {
            let slowest_m_per_s = if at_cliff {
                -CHASSIS.back_at_cliff_m_per_s
            } else {
                f64::NEG_INFINITY
            };
            return away_from_hazard(
                (share * speed_m_per_s).max(slowest_m_per_s),
                turn_rad_per_s,
                situation,
            );
        }
        Motion::Drive {
            speed_m_per_s: share * speed_m_per_s,
            turn_rad_per_s: share * turn_rad_per_s,
        }
    }

    /// A person who drives sees behind the robot; the brain does not.
    fn may_back(&self, situation: &Situation<'_>) -> bool {
        matches!(self.mode, Mode::Manual(_)) || situation.reverse_budget_m > 0.0
    }
}

/// The part of a motion that leads away from what is touched (S6) or from an edge (S8): straight back, and the turns of
/// [`crate::navigation::TurnFree`].
fn away_from_hazard(speed_m_per_s: f64, turn_rad_per_s: f64, situation: &Situation<'_>) -> Motion {
    let is_away = free_side(situation).is_some_and(|side| side.sign() * turn_rad_per_s > 0.0);
    let fastest_rad_per_s = match (is_away, situation.at_cliff) {
        (false, _) => 0.0,
        (true, true) => round_wheel_rad_per_s(speed_m_per_s, situation),
        (true, false) if speed_m_per_s == 0.0 => CHASSIS.turn_min_rad_per_s,
        (true, false) => 0.0,
    };
    if speed_m_per_s > 0.0 || (speed_m_per_s == 0.0 && fastest_rad_per_s == 0.0) {
        return Motion::Halt;
    }
    Motion::Drive {
        speed_m_per_s,
        turn_rad_per_s: turn_rad_per_s.clamp(-fastest_rad_per_s, fastest_rad_per_s),
    }
}
