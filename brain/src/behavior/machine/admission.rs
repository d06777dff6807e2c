//! Which commands are obeyed in which situation, and what obeying them means.

use super::manual::ManualDrive;
use super::{Behavior, Mode};
use crate::behavior::JobKind;
use crate::mapping::Map;
use crate::model::command::{Command, StrategyName};
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

impl Behavior {
    /// Whether `command` may be obeyed now, in a home that is as the map says.
    pub(crate) fn admit(&self, command: &Command, map: &Map) -> Result<(), Reason> {
        match command {
            Command::Stop | Command::ManualEnd => Ok(()),
            Command::AddNoGo { no_go } => map.admit_no_go(no_go),
            Command::RemoveNoGo { number } => map.admit_no_go_removal(*number),
            Command::NameNoGo { number, name } => map.admit_no_go_name(*number, name.as_ref()),
            Command::ReshapeNoGo { number, no_go } => map.admit_no_go_shape(*number, no_go),
            Command::KeepPlace { place, number } => map.admit_place(place, *number),
            Command::NamePlace { number, name } => map.admit_place_name(*number, name),
            Command::ReshapePlace { number, shape } => map.admit_place_shape(*number, shape),
            Command::ForgetPlace { number } => map.admit_place_removal(*number),
            Command::NameRoom { room, name } => map.admit_room_name(*room, name.as_ref()),
            Command::SetRoom { room, .. } => map.admit_room_settings(*room),
            Command::SplitRoom { room, line } => map.admit_room_split(*room, line),
            Command::JoinRooms { rooms } => map.admit_room_join(*rooms),
            Command::UndoRoomChange { number } => map.admit_room_change_undo(*number),
            Command::MoveDock { pose } => map.admit_dock_move(*pose),
            Command::Clean { strategy } => {
                self.admit_job(JobKind::Clean(*strategy), &CleaningOrder::default())
            }
            Command::CleanParts { order } => {
                map.admit_order(order)?;
                self.admit_job(JobKind::Clean(StrategyName::Systematic), order)
            }
            Command::Spot => self.admit_job(JobKind::Spot, &CleaningOrder::default()),
            Command::Dock => self.admit_dock(),
            Command::Pause => self.admit_pause(),
            Command::Resume => self.admit_resume(),
            Command::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                ..
            } => self.admit_manual(*speed_m_per_s == 0.0 && *turn_rad_per_s == 0.0),
            Command::ClearError => match self.mode {
                Mode::Error { .. } => Ok(()),
                _ => Err(Reason::NoError),
            },
        }
    }

    /// Whether something besides the wheels told the heading at the last step.
    pub(crate) const fn knows_heading(&self) -> bool {
        self.facts.knows_heading
    }

    /// What keeps any motion from starting (S25).
    fn startable(&self) -> Result<(), Reason> {
        if !self.facts.link_up {
            return Err(Reason::LinkLost);
        }
        if let Some(fault) = self.facts.fault {
            return Err(fault);
        }
        if self.facts.wheel_drop {
            return Err(Reason::WheelDrop);
        }
        match self.mode {
            Mode::Error { .. } => Err(Reason::ErrorStands),
            _ => Ok(()),
        }
    }

    fn runs(&self, kind: JobKind, order: &CleaningOrder) -> bool {
        let active = matches!(self.mode, Mode::Starting { .. } | Mode::Working);
        let job = self.job.as_ref().filter(|_| active);
        job.is_some_and(|job| job.kind == kind && job.order == *order)
    }

    fn admit_job(&self, kind: JobKind, order: &CleaningOrder) -> Result<(), Reason> {
        if self.runs(kind, order) {
            return Err(Reason::AlreadyRunning);
        }
        self.startable()?;
        if kind == JobKind::Clean(StrategyName::Systematic) && !self.facts.knows_heading {
            return Err(Reason::NoHeading);
        }
        if self.facts.battery_low {
            Err(Reason::BatteryLow)
        } else {
            Ok(())
        }
    }

    fn admit_dock(&self) -> Result<(), Reason> {
        if self.runs(JobKind::Dock, &CleaningOrder::default()) {
            return Err(Reason::AlreadyRunning);
        }
        if self.facts.docked {
            return Err(Reason::Docked);
        }
        self.startable()
    }

    fn admit_pause(&self) -> Result<(), Reason> {
        let pausable = match self.mode {
            Mode::Starting { .. } | Mode::Working | Mode::Recharging => true,
            Mode::Disconnected { resume, .. } => resume,
            _ => false,
        };
        if pausable && self.job.is_some() {
            Ok(())
        } else {
            Err(Reason::NoJob)
        }
    }

    pub(super) fn admit_resume(&self) -> Result<(), Reason> {
        let waits = matches!(
            self.mode,
            Mode::Paused | Mode::Stuck | Mode::Manual(_) | Mode::Recharging
        );
        match self.mode {
            Mode::Starting { .. } | Mode::Working => Err(Reason::AlreadyRunning),
            _ if self.job.is_none() => Err(Reason::NoJob),
            _ => {
                self.startable()?;
                if self.mode == Mode::Recharging && self.facts.battery_low {
                    return Err(Reason::BatteryLow);
                }
                if waits { Ok(()) } else { Err(Reason::NoJob) }
            }
        }
    }

    fn admit_manual(&self, centred: bool) -> Result<(), Reason> {
        self.startable()?;
        if self.centre_first && !centred {
            Err(Reason::CentreFirst)
        } else {
            Ok(())
        }
    }

    /// Does what an admitted command says.
    pub(super) fn obey(&mut self, command: &Command, mind: &mut TaskContext) {
        let whole = CleaningOrder::default();
        match *command {
            Command::Clean { strategy } => self.begin((JobKind::Clean(strategy), whole), mind),
            Command::CleanParts { ref order } => {
                let kind = JobKind::Clean(StrategyName::Systematic);
                self.begin((kind, order.clone()), mind);
            }
            // The map's business.
            Command::AddNoGo { .. }
            | Command::RemoveNoGo { .. }
            | Command::NameNoGo { .. }
            | Command::ReshapeNoGo { .. }
            | Command::KeepPlace { .. }
            | Command::NamePlace { .. }
            | Command::ReshapePlace { .. }
            | Command::ForgetPlace { .. }
            | Command::NameRoom { .. }
            | Command::SetRoom { .. }
            | Command::SplitRoom { .. }
            | Command::JoinRooms { .. }
            | Command::UndoRoomChange { .. }
            | Command::MoveDock { .. } => {}
            Command::Spot => self.begin((JobKind::Spot, whole), mind),
            Command::Dock if self.mode == Mode::Working => self.turn_home(Reason::Command, mind),
            Command::Dock => self.begin((JobKind::Dock, whole), mind),
            Command::Pause => self.pause(mind),
            Command::Resume => {
                if let Some(job) = &mut self.job {
                    job.encourage();
                }
                self.announce(Reason::Command, mind);
            }
            Command::Stop => self.stop(mind),
            Command::Manual {
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
                    mind,
                );
            }
            Command::ManualEnd => self.release_wheel(mind),
            Command::ClearError => self.mode = Mode::Error { acknowledged: true },
        }
    }

    fn pause(&mut self, mind: &mut TaskContext) {
        self.stays_where_it_is();
        match self.mode {
            Mode::Disconnected { since_us, .. } => {
                self.enter(
                    Mode::Disconnected {
                        since_us,
                        resume: false,
                    },
                    Reason::Command,
                    mind,
                );
            }
            _ => self.enter(Mode::Paused, Reason::Command, mind),
        }
    }

    fn stop(&mut self, mind: &mut TaskContext) {
        self.centre_first = true;
        self.stays_where_it_is();
        match self.mode {
            // A fault or a lost link outlives the job.
            Mode::Error { .. } | Mode::Disconnected { .. } => {
                let (mode, reason) = (self.mode, self.reason);
                self.end_job(Reason::Command, mind);
                self.enter(without_resumption(mode), reason, mind);
            }
            _ => self.end_job(Reason::Command, mind),
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
