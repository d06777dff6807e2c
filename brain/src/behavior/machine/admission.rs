//! Which job commands are admitted in which mode, and what each does.

use super::manual::ManualDrive;
use super::{Behavior, Mode};
use crate::behavior::JobKind;
use crate::coverage::ReachQuestion;
use crate::mapping::Map;
use crate::model::command::{JobCommand, StrategyName};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::job_refusal::JobRefusal;
use crate::model::order::CleaningOrder;
use crate::model::pose_estimate::PoseEstimate;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

impl Behavior {
    /// Whether `command` may be obeyed now, in the home of this map and from this place.
    pub(crate) fn admit(
        &self,
        command: &JobCommand,
        (map, estimate): (&Map, PoseEstimate),
    ) -> Result<(), JobRefusal> {
        match command {
            JobCommand::Stop | JobCommand::ManualEnd => Ok(()),
            JobCommand::Clean { strategy } => {
                self.admit_job(JobKind::Clean(*strategy), &CleaningOrder::default())
            }
            JobCommand::CleanParts { order } => {
                let kind = JobKind::Clean(StrategyName::Systematic);
                self.admit_parts((kind, order), (map, estimate))
            }
            JobCommand::Spot => self.admit_job(JobKind::Spot, &CleaningOrder::default()),
            JobCommand::GoTo { place } => {
                let order = CleaningOrder::of_place(*place);
                self.admit_parts((JobKind::GoTo, &order), (map, estimate))?;
                if estimate.is_sure() {
                    Ok(())
                } else {
                    Err(JobRefusal::PlaceUnknown)
                }
            }
            JobCommand::Dock => self.admit_dock(),
            JobCommand::Pause => self.admit_pause(),
            JobCommand::Resume => self.admit_resume(),
            JobCommand::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                ..
            } => self.admit_manual(*speed_m_per_s == 0.0 && *turn_rad_per_s == 0.0),
            JobCommand::ClearError => match self.mode {
                Mode::Error { .. } => Ok(()),
                _ => Err(JobRefusal::NoError),
            },
        }
    }

    /// Whether there was a source of heading besides the wheels at the last step.
    pub(crate) const fn knows_heading(&self) -> bool {
        self.facts.knows_heading
    }

    /// What keeps any motion from starting (S25).
    fn startable(&self) -> Result<(), JobRefusal> {
        if !self.facts.link_up {
            return Err(match self.facts.link_fault {
                Some(fault) => JobRefusal::Link(fault),
                None => JobRefusal::LinkLost,
            });
        }
        if self.facts.not_calibrated {
            return Err(JobRefusal::NotCalibrated);
        }
        if let Some(fault) = self.facts.fault {
            return Err(JobRefusal::Fault(fault));
        }
        if self.facts.wheel_drop {
            return Err(JobRefusal::WheelDrop);
        }
        match self.mode {
            Mode::Error { .. } => Err(JobRefusal::ErrorStands),
            _ => Ok(()),
        }
    }

    fn runs(&self, kind: JobKind, order: &CleaningOrder) -> bool {
        let active = matches!(self.mode, Mode::Starting { .. } | Mode::Working);
        let job = self.job.as_ref().filter(|_| active);
        job.is_some_and(|job| job.kind == kind && job.order == *order)
    }

    fn admit_job(&self, kind: JobKind, order: &CleaningOrder) -> Result<(), JobRefusal> {
        if self.runs(kind, order) {
            return Err(JobRefusal::AlreadyRunning);
        }
        self.startable()?;
        let gets_heading = self.facts.knows_heading || self.facts.hears_beacons;
        if kind == JobKind::Clean(StrategyName::Systematic) && !gets_heading {
            return Err(JobRefusal::NoHeading);
        }
        if self.facts.docked && self.facts.touching {
            // The dock ahead touches nothing for long, or the bumper would be taken for stuck (S7).
            return Err(JobRefusal::Bumper);
        }
        if self.facts.battery_low {
            Err(JobRefusal::BatteryLow)
        } else {
            Ok(())
        }
    }

    /// A job for parts of a home that the map must have, and that the robot can reach from its place.
    fn admit_parts(
        &self,
        (kind, order): (JobKind, &CleaningOrder),
        (map, estimate): (&Map, PoseEstimate),
    ) -> Result<(), JobRefusal> {
        let (home, budget) = (&map.home_floor(), &mut StepBudget::unlimited());
        at_once(home.admit_order(order, budget))?;
        self.admit_job(kind, order)?;
        // A robot that does not know its place does not know what it can reach from there.
        if !estimate.is_sure() {
            return Ok(());
        }
        let question = ReachQuestion {
            order,
            home,
            from: estimate.pose.position(),
            radius_m: self.config.body.radius_m,
        };
        at_once(question.admit(budget))
    }

    fn admit_dock(&self) -> Result<(), JobRefusal> {
        if self.ends_at_dock() {
            return Ok(());
        }
        if self.runs(JobKind::Dock, &CleaningOrder::default()) {
            return Err(JobRefusal::AlreadyRunning);
        }
        if self.facts.docked {
            return Err(JobRefusal::Docked);
        }
        self.startable()
    }

    /// Whether a job waits that must not go on once a person has sent the robot to its dock: it is on the way there for charge, or on it.
    fn ends_at_dock(&self) -> bool {
        let is_under_way = matches!(self.mode, Mode::Starting { .. } | Mode::Working);
        let is_held = matches!(self.mode, Mode::Disconnected { .. } | Mode::Error { .. });
        match (&self.put_off, &self.job) {
            (Some(_), _) if is_under_way => true,
            (_, Some(job)) => self.facts.docked && !is_held && !(job.kind == JobKind::Dock && is_under_way),
            (_, None) => false,
        }
    }

    fn admit_pause(&self) -> Result<(), JobRefusal> {
        let pausable = match self.mode {
            Mode::Starting { .. } | Mode::Working | Mode::Recharging => true,
            Mode::Disconnected { resume, .. } => resume,
            _ => false,
        };
        if pausable && self.job.is_some() {
            Ok(())
        } else {
            Err(JobRefusal::NoJob)
        }
    }

    pub(super) fn admit_resume(&self) -> Result<(), JobRefusal> {
        let waits = matches!(
            self.mode,
            Mode::Paused | Mode::Stuck | Mode::Manual(_) | Mode::Recharging
        );
        match self.mode {
            Mode::Starting { .. } | Mode::Working => Err(JobRefusal::AlreadyRunning),
            _ if self.job.is_none() => Err(JobRefusal::NoJob),
            _ => {
                self.startable()?;
                if self.mode == Mode::Recharging && self.facts.battery_low {
                    return Err(JobRefusal::BatteryLow);
                }
                if waits { Ok(()) } else { Err(JobRefusal::NoJob) }
            }
        }
    }

    fn admit_manual(&self, centred: bool) -> Result<(), JobRefusal> {
        self.startable()?;
        if self.centre_first && !centred {
            Err(JobRefusal::CentreFirst)
        } else {
            Ok(())
        }
    }

    /// Does what an admitted command says.
    pub(super) fn obey(&mut self, command: &JobCommand, context: &mut TaskContext) {
        let whole = CleaningOrder::default();
        match *command {
            JobCommand::Clean { strategy } => self.begin(JobKind::Clean(strategy), whole, context),
            JobCommand::CleanParts { ref order } => {
                let kind = JobKind::Clean(StrategyName::Systematic);
                self.begin(kind, order.clone(), context);
            }
            JobCommand::Spot => self.begin(JobKind::Spot, whole, context),
            JobCommand::GoTo { place } => self.begin(JobKind::GoTo, CleaningOrder::of_place(place), context),
            JobCommand::Dock => self.send_home(context),
            JobCommand::Pause => self.pause(context),
            JobCommand::Resume => {
                if let Some(job) = &mut self.job {
                    job.reset_recovery();
                }
                self.announce(Reason::Command, context);
            }
            JobCommand::Stop => self.stop(context),
            JobCommand::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners,
            } => {
                self.take_wheel(
                    ManualDrive {
                        speed_m_per_s,
                        turn_rad_per_s,
                        valid_until_us,
                        cleaners,
                        ready: false,
                    },
                    context,
                );
            }
            JobCommand::ManualEnd => self.release_wheel(context),
            JobCommand::ClearError => self.mode = Mode::Error { acknowledged: true },
        }
    }

    /// A person sends the robot to its dock, where it stays.
    fn send_home(&mut self, context: &mut TaskContext) {
        let drives_home = self.job.as_ref().is_some_and(|job| job.kind == JobKind::Dock);
        let is_under_way = matches!(self.mode, Mode::Starting { .. } | Mode::Working);
        if self.facts.docked && self.job.is_some() && !(drives_home && is_under_way) {
            self.end_job(Reason::Command, context);
        } else if drives_home && is_under_way {
            self.put_off = None;
            self.enter(self.mode, Reason::Command, context);
        } else if self.mode == Mode::Working {
            self.turn_home(Reason::Command, context);
        } else {
            self.begin(JobKind::Dock, CleaningOrder::default(), context);
        }
    }

    fn pause(&mut self, context: &mut TaskContext) {
        self.stays_where_it_is();
        match self.mode {
            Mode::Disconnected { since_us, .. } => {
                self.enter(
                    Mode::Disconnected {
                        since_us,
                        resume: false,
                    },
                    Reason::Command,
                    context,
                );
            }
            _ => self.enter(Mode::Paused, Reason::Command, context),
        }
    }

    fn stop(&mut self, context: &mut TaskContext) {
        self.centre_first = true;
        self.stays_where_it_is();
        match self.mode {
            // A fault or a lost link stays when the job ends.
            Mode::Error { .. } | Mode::Disconnected { .. } => {
                let (mode, reason) = (self.mode, self.reason);
                self.end_job(Reason::Command, context);
                self.enter(without_resumption(mode), reason, context);
            }
            _ => self.end_job(Reason::Command, context),
        }
    }
}

fn without_resumption(mode: Mode) -> Mode {
    match mode {
        Mode::Disconnected { since_us, .. } => Mode::Disconnected {
            since_us,
            resume: false,
        },
        other => other,
    }
}
