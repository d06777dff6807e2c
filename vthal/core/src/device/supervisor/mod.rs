//! What holds for every make of robot: commands are checked against the description, drive commands end with their time,
//! an emergency stop latches above all of them, and what the robot lacks in reflexes the host supplies.

mod reports;

use brain::LinkFault;

use super::dead_man::{DeadMan, Setpoint, VALID_FOR_MAX_US, WheelOrder};
use super::latches::HostLatches;
use super::link_judge::{LinkJudge, LinkNews};
use super::reflex::{HostReflexes, fresh_us};
use super::wheel_watch::WheelWatch;
use super::{
    CleanerDrive, CommandError, Description, Device, DeviceCommand, DeviceIo, Drive, LeaveDock, Level,
    LinkQuality, Make, Opening,
};
use crate::Direction;

/// Pause between repetitions of the command to brushes and suction: three fall into their lease on the wire of our own
/// firmware, which the robot ends to the millisecond.
pub(super) const CLEANER_REPEAT_US: u64 = 300_000;

/// Emergency stops with nothing between them are sent this often at most: as often as our own firmware reports.
const STOP_AGAIN_US: u64 = 20_000;

/// A robot that has rested for so long is let go, so that it can sleep and charge, and people may push it by hand. A job starts within less
/// (S24).
const RELEASE_AFTER_US: u64 = 3_000_000;

/// A robot on the link, of whatever make.
#[derive(Debug)]
pub struct Supervisor {
    device: Box<dyn Device>,
    opening: Opening,
    duties: Duties,
    watch: WheelWatch,
    latches: HostLatches,
    judge: LinkJudge,
}

/// What is under way since the line was opened.
#[derive(Debug)]
struct Duties {
    /// When the robot must have described itself if this is its rate; `None` if it has, or has no other rate.
    answer_until_us: Option<u64>,
    /// As the make tells, but no faster than the host reacts.
    description: Option<Description>,
    reflexes: Option<HostReflexes>,
    /// Whether the robot was asked for its wheels and motors, and has not been let go since.
    in_control: bool,
    resting_since_us: Option<u64>,
    dead_man: DeadMan,
    cleaners: CleanerDrive,
    /// When brushes and suction were last told to run; `None` if the present wish was not told yet.
    cleaners_told_us: Option<u64>,
    /// When a stop was last sent; `None` unless an emergency stop latches.
    stop_sent_us: Option<u64>,
    /// When an emergency stop was sent, if nothing else was commanded since.
    only_stopped_us: Option<u64>,
    /// When the wheels were last told to stand after their command had ended.
    stood_us: Option<u64>,
    now_us: u64,
}

impl Duties {
    const fn new(now_us: u64) -> Self {
        Self {
            answer_until_us: None,
            description: None,
            reflexes: None,
            in_control: false,
            resting_since_us: None,
            dead_man: DeadMan::new(),
            cleaners: CleanerDrive::Off,
            cleaners_told_us: None,
            stop_sent_us: None,
            only_stopped_us: None,
            stood_us: None,
            now_us,
        }
    }

    /// The robot does nothing of what it was told before.
    fn forget_commands(&mut self) {
        self.dead_man.forget();
        self.cleaners = CleanerDrive::Off;
        self.cleaners_told_us = None;
        self.only_stopped_us = None;
    }
}

impl Supervisor {
    /// A robot that was never heard.
    #[must_use]
    pub fn new(make: &Make) -> Self {
        Self {
            device: (make.connect)(),
            opening: make.opening,
            duties: Duties::new(0),
            watch: WheelWatch::default(),
            latches: HostLatches::default(),
            judge: LinkJudge::default(),
        }
    }

    /// The line to it has just been opened, for the first time or again. Whatever was commanded before is forgotten, here
    /// and by the robot.
    pub fn open(&mut self, io: &mut DeviceIo<'_>) {
        self.duties = Duties::new(io.now_us);
        let patience_us = 1000 * u64::from(self.opening.answer_within_ms);
        let has_others = self.opening.rates_baud.len() > 1;
        self.duties.answer_until_us = has_others.then_some(io.now_us + patience_us);
        self.watch.rebase();
        self.latches.rebase();
        self.judge.open(io.now_us);
        self.device.open(io);
        self.device.release(io);
    }

    /// What it is and can do, once it has told.
    #[must_use]
    pub const fn description(&self) -> Option<&Description> {
        self.duties.description.as_ref()
    }

    /// Whether it is described and listens: it takes commands.
    #[must_use]
    pub fn is_attached(&self) -> bool {
        self.duties.description.is_some() && self.device.is_attached()
    }

    /// Whether it was told to stop, and not to move again since.
    #[must_use]
    pub const fn is_latched(&self) -> bool {
        self.duties.stop_sent_us.is_some()
    }

    /// Microseconds for which a report tells of the present; nothing while it is not described.
    #[must_use]
    pub fn fresh_us(&self) -> Option<u64> {
        self.description()
            .map(|description| fresh_us(description.reflexes))
    }

    /// Quality of the link.
    #[must_use]
    pub fn link_quality(&self) -> LinkQuality {
        self.device.link_quality()
    }

    /// Judges the link as it is now.
    pub fn look_at_link(&mut self, now_us: u64) {
        let fresh_us = self.fresh_us();
        self.judge.look(now_us, self.device.link_quality(), fresh_us);
    }

    /// Why the link cannot be relied upon, unless it is silent.
    #[must_use]
    pub fn link_fault(&self) -> Option<LinkFault> {
        self.judge.fault()
    }

    /// Share of its speed that the robot may drive at over this link.
    #[must_use]
    pub fn speed_share(&self) -> f64 {
        self.fresh_us()
            .map_or(1.0, |fresh_us| self.judge.speed_share(fresh_us))
    }

    /// Faults of the link that began or ended since the last call.
    pub(crate) fn take_link_news(&mut self) -> Vec<LinkNews> {
        self.judge.take_news()
    }

    /// Reports in a row that say that it stands.
    #[must_use]
    pub const fn still_reports(&self) -> u32 {
        self.watch.still_reports()
    }

    /// Only reports from now on count for [`Self::still_reports`].
    pub const fn forget_stillness(&mut self) {
        self.watch.forget_stillness();
    }

    /// Appends the packets that `bytes` on the line complete, as text.
    pub fn tap(&mut self, direction: Direction, bytes: &[u8], packets: &mut Vec<(Direction, String)>) {
        self.device.tap(direction, bytes, packets);
    }

    /// Takes bytes from the robot.
    pub fn receive(&mut self, bytes: &[u8], io: &mut DeviceIo<'_>) {
        self.duties.now_us = io.now_us;
        let before = io.events.len();
        self.device.receive(bytes, io);
        self.note(before, io);
        self.look_at_link(io.now_us);
    }

    /// Lets time pass: the dead man acts, running commands are repeated.
    pub fn poll(&mut self, io: &mut DeviceIo<'_>) {
        self.duties.now_us = io.now_us;
        let before = io.events.len();
        self.device.poll(io);
        self.note(before, io);
        self.renew(io);
    }

    /// Whether the robot does not answer at the rate of the line, and may at another one. Says so once.
    pub fn gives_up_rate(&mut self, now_us: u64) -> bool {
        if self.duties.description.is_some() {
            self.duties.answer_until_us = None;
        }
        let gives_up = self.duties.answer_until_us.is_some_and(|end_us| now_us >= end_us);
        if gives_up {
            self.duties.answer_until_us = None;
        }
        gives_up
    }

    /// When [`Supervisor::poll`] has something to do at the latest.
    #[must_use]
    pub fn next_wake_us(&self) -> u64 {
        let duties = &self.duties;
        let device_us = self.device.next_wake_us(duties.now_us);
        let wheels_us = duties.dead_man.next_wake_us().unwrap_or(u64::MAX);
        let cleaners_us = match (duties.cleaners, duties.cleaners_told_us) {
            (CleanerDrive::On(_), Some(told_us)) => told_us + CLEANER_REPEAT_US,
            (_, None) | (CleanerDrive::Off, Some(_)) => u64::MAX,
        };
        let answer_us = duties.answer_until_us.unwrap_or(u64::MAX);
        device_us.min(wheels_us).min(cleaners_us).min(answer_us)
    }

    /// Carries out a command.
    ///
    /// # Errors
    /// Why not; nothing was sent then.
    pub fn command(&mut self, command: DeviceCommand, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.duties.now_us = io.now_us;
        if command != DeviceCommand::EmergencyStop {
            self.duties.only_stopped_us = None;
        }
        match command {
            DeviceCommand::EmergencyStop => {
                self.emergency_stop(io);
                Ok(())
            }
            DeviceCommand::Drive {
                speed_m_per_s,
                turn_rad_per_s,
                valid_for_us,
            } => {
                let drive = Drive {
                    speed_m_per_s,
                    turn_rad_per_s,
                };
                self.drive(drive, valid_for_us.min(VALID_FOR_MAX_US), io)
            }
            DeviceCommand::Halt => self.drive(Drive::STAND, VALID_FOR_MAX_US / 4, io),
            DeviceCommand::Rest => self.rest(io),
            DeviceCommand::Cleaners(drive) => self.set_cleaners(drive, io),
            DeviceCommand::Arm { leave_dock } => self.arm(leave_dock, io),
            DeviceCommand::Clear(inhibit) if self.latches.holds(inhibit) => self.latches.clear(inhibit),
            DeviceCommand::Clear(inhibit) => self.device.clear(inhibit, io),
            DeviceCommand::Tone(tone) => self.device.tone(tone, io),
            DeviceCommand::Light(light) => self.device.light(light, io),
        }
    }

    /// Sends what an expert typed.
    ///
    /// # Errors
    /// Why not; nothing was sent then.
    pub fn raw(&mut self, text: &str, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.duties.only_stopped_us = None;
        self.device.raw(text, io)
    }

    /// Lets go of the robot: its wheels stand, it may sleep and charge.
    pub fn release(&mut self, io: &mut DeviceIo<'_>) {
        self.duties.forget_commands();
        self.duties.in_control = false;
        self.duties.resting_since_us = None;
        self.device.release(io);
    }

    /// Whoever presses Stop without end must not fill the line: everything else would wait behind it. A stop that is lost is repeated
    /// as soon as telemetry does not know of it.
    fn emergency_stop(&mut self, io: &mut DeviceIo<'_>) {
        let sent_us = self.duties.only_stopped_us;
        if sent_us.is_some_and(|sent_us| io.now_us < sent_us + STOP_AGAIN_US) {
            return;
        }
        self.duties.stop_sent_us = Some(io.now_us);
        self.duties.forget_commands();
        self.duties.only_stopped_us = Some(io.now_us);
        self.device.stop(io);
    }

    fn arm(&mut self, leave_dock: LeaveDock, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.device.arm(leave_dock, io)?;
        self.duties.resting_since_us = None;
        self.duties.stop_sent_us = None;
        Ok(())
    }

    fn rest(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let moving = self
            .duties
            .dead_man
            .setpoint()
            .is_some_and(|setpoint| !setpoint.is_zero());
        self.duties.dead_man.forget();
        let since_us = *self.duties.resting_since_us.get_or_insert(io.now_us);
        if moving {
            return self.stand(io);
        }
        let is_due = self.duties.in_control && self.duties.cleaners == CleanerDrive::Off;
        if is_due && io.now_us >= since_us + RELEASE_AFTER_US {
            self.release(io);
        }
        Ok(())
    }

    fn drive(&mut self, drive: Drive, valid_for_us: u64, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let limits = self.description().ok_or(CommandError::NotAttached)?.drive;
        if self.is_latched() {
            return Err(CommandError::Latched);
        }
        // Written so that NaN is refused too.
        let in_range = drive.speed_m_per_s.abs() <= limits.speed_max_m_per_s
            && drive.turn_rad_per_s.abs() <= limits.turn_max_rad_per_s;
        if !in_range {
            return Err(CommandError::Range);
        }
        self.take_control(io)?;
        self.duties.dead_man.set(Setpoint {
            drive,
            valid_until_us: io.now_us + valid_for_us,
        });
        self.renew_wheels(io)
    }

    /// Asks the robot for its wheels and motors, unless it has given them already.
    fn take_control(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.duties.resting_since_us = None;
        if self.duties.in_control {
            return Ok(());
        }
        let description = self.description().ok_or(CommandError::NotAttached)?;
        if !description.offers(Level::Motion) {
            return Err(CommandError::NotOffered);
        }
        self.device.acquire(Level::Motion, io)?;
        self.duties.in_control = true;
        Ok(())
    }

    fn renew(&mut self, io: &mut DeviceIo<'_>) {
        // A robot that does not listen is no news here: its end was an event, and its own dead man acts.
        self.renew_wheels(io).ok();
        let due = self
            .duties
            .cleaners_told_us
            .is_some_and(|told_us| io.now_us >= told_us + CLEANER_REPEAT_US);
        if self.duties.cleaners != CleanerDrive::Off && due {
            self.tell_cleaners(io).ok();
        }
    }

    fn renew_wheels(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        match self.duties.dead_man.poll(io.now_us) {
            WheelOrder::Keep => Ok(()),
            WheelOrder::Stand => self.stand(io),
            WheelOrder::Send(setpoint) => {
                let permitted = match &self.duties.reflexes {
                    _ if self.latches.any() => Drive::STAND,
                    Some(reflexes) => reflexes.permit(io.now_us, setpoint.drive),
                    None => setpoint.drive,
                };
                self.turn_wheels(permitted, io)
            }
        }
    }

    fn stand(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.duties.stood_us = Some(io.now_us);
        self.turn_wheels(Drive::STAND, io)
    }

    fn turn_wheels(&mut self, drive: Drive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        if let Some(description) = &self.duties.description {
            self.watch.commanded(drive, description.drive.track_m);
        }
        self.device.drive(drive, io)
    }

    fn set_cleaners(&mut self, drive: CleanerDrive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        if drive == self.duties.cleaners {
            return Ok(());
        }
        if drive != CleanerDrive::Off {
            if self.is_latched() {
                return Err(CommandError::Latched);
            }
            if self.is_lifted() || self.latches.any() {
                return Err(CommandError::Held);
            }
            self.take_control(io)?;
        }
        self.duties.cleaners = drive;
        self.tell_cleaners(io)
    }

    fn tell_cleaners(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.duties.cleaners_told_us = Some(io.now_us);
        self.device.cleaners(self.duties.cleaners, io)
    }

    fn is_lifted(&self) -> bool {
        let duties = &self.duties;
        let reflexes = duties.reflexes.as_ref();
        reflexes.is_some_and(|reflexes| reflexes.is_lifted(duties.now_us))
    }
}
