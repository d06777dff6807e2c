//! What holds for every make of robot: commands are checked against the description, drive commands end with their time,
//! and an emergency stop latches above all of them.

use rvac_protocol::message::{Command, Inhibit, Led};
use rvac_protocol::quality::LinkQuality;
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Tick};

use super::dead_man::{DeadMan, Setpoint, VALID_FOR_MAX_US, WheelOrder};
use super::own_firmware::{FirmwareEvent, FirmwareIo, OwnFirmware, WireOut};
use super::{CleanerDrive, CommandError, Description, DeviceCommand};

/// Pause between repetitions of the command to brushes and suction: three fall into their lease on the wire.
const CLEANER_REPEAT_US: u64 = 300_000;

/// Telemetry has had the time to know of a `stop` after this long.
const STOP_REPEAT_US: u64 = 200_000;

/// A robot on the link.
#[derive(Debug)]
pub struct Device {
    firmware: OwnFirmware,
    description: Option<Description>,
    dead_man: DeadMan,
    cleaners: CleanerDrive,
    /// When brushes and suction were last told to run; `None` if the present wish was not told yet.
    cleaners_told_us: Option<u64>,
    /// When `stop` was last sent; `None` unless an emergency stop latches.
    stop_sent_us: Option<u64>,
    now_us: u64,
}

/// Where a device's bytes and events go, and when.
#[derive(Debug)]
pub struct DeviceIo<'a> {
    /// Host time in microseconds.
    pub now_us: u64,
    /// Bytes for the robot.
    pub link: &'a mut Vec<u8>,
    /// What the robot told.
    pub events: &'a mut Vec<FirmwareEvent>,
}

fn tick(now_us: u64) -> Tick {
    // Truncation is the wrap of the millisecond clock.
    Tick((now_us / 1000) as u32)
}

impl DeviceIo<'_> {
    fn wire(&mut self) -> WireOut<'_> {
        WireOut {
            now: tick(self.now_us),
            link: self.link,
        }
    }

    fn firmware(&mut self) -> FirmwareIo<'_> {
        FirmwareIo {
            link: self.link,
            events: self.events,
        }
    }
}

impl Device {
    /// A robot whose link has just been opened.
    #[must_use]
    pub fn new(now_us: u64) -> Self {
        Self {
            firmware: OwnFirmware::new(tick(now_us)),
            description: None,
            dead_man: DeadMan::default(),
            cleaners: CleanerDrive::Off,
            cleaners_told_us: None,
            stop_sent_us: None,
            now_us,
        }
    }

    /// What it is and can do, once it has told.
    #[must_use]
    pub fn description(&self) -> Option<&Description> {
        self.description.as_ref()
    }

    /// Whether it is described and a session is open: it takes commands.
    #[must_use]
    pub fn is_attached(&self) -> bool {
        self.description.is_some() && self.firmware.is_open()
    }

    /// Whether it was told to stop, and not to move again since.
    #[must_use]
    pub const fn is_latched(&self) -> bool {
        self.stop_sent_us.is_some()
    }

    /// Quality of the link.
    #[must_use]
    pub fn quality(&self) -> LinkQuality {
        self.firmware.quality()
    }

    /// Number of the wire's session, for seals.
    #[must_use]
    pub fn session_number(&self) -> u16 {
        self.firmware.session_number()
    }

    /// Whether telemetry comes in binary form.
    #[must_use]
    pub fn is_binary(&self) -> bool {
        self.firmware.is_binary()
    }

    /// Takes bytes from the robot.
    pub fn receive(&mut self, bytes: &[u8], io: &mut DeviceIo<'_>) {
        self.now_us = io.now_us;
        self.firmware.receive(bytes, tick(io.now_us), &mut io.firmware());
        self.note(io.events);
        self.repeat_lost_stop(io);
    }

    /// Lets time pass: the dead man acts, running commands are repeated.
    pub fn poll(&mut self, io: &mut DeviceIo<'_>) {
        self.now_us = io.now_us;
        self.firmware.poll(tick(io.now_us), &mut io.firmware());
        self.note(io.events);
        self.renew(io);
    }

    /// When [`Device::poll`] has something to do at the latest.
    #[must_use]
    pub fn next_wake_us(&self) -> u64 {
        let now = tick(self.now_us);
        let next = self.firmware.next_poll();
        let pause_ms = if now.reached(next) { 0 } else { next.since(now) };
        let session_us = self.now_us + u64::from(pause_ms.max(1)) * 1000;
        let wheels_us = self.dead_man.next_wake_us().unwrap_or(u64::MAX);
        let cleaners_us = match (self.cleaners, self.cleaners_told_us) {
            (CleanerDrive::On(_), Some(told_us)) => told_us + CLEANER_REPEAT_US,
            (_, None) | (CleanerDrive::Off, Some(_)) => u64::MAX,
        };
        session_us.min(wheels_us).min(cleaners_us)
    }

    /// Carries out a command.
    ///
    /// # Errors
    /// Why not; nothing was sent then.
    pub fn command(&mut self, command: DeviceCommand, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.now_us = io.now_us;
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
                let valid_until_us = io.now_us + valid_for_us.min(VALID_FOR_MAX_US);
                self.drive(
                    Setpoint {
                        speed_m_per_s,
                        turn_rad_per_s,
                        valid_until_us,
                    },
                    io,
                )
            }
            DeviceCommand::Halt => {
                let valid_until_us = io.now_us + VALID_FOR_MAX_US / 4;
                self.drive(
                    Setpoint {
                        speed_m_per_s: 0.0,
                        turn_rad_per_s: 0.0,
                        valid_until_us,
                    },
                    io,
                )
            }
            DeviceCommand::Rest => {
                let moving = self
                    .dead_man
                    .setpoint()
                    .is_some_and(|setpoint| !setpoint.is_zero());
                self.dead_man.forget();
                if moving {
                    self.firmware
                        .drive(Speed::ZERO, AngularSpeed::ZERO, &mut io.wire())
                } else {
                    Ok(())
                }
            }
            DeviceCommand::Cleaners(drive) => self.set_cleaners(drive, io),
            DeviceCommand::Arm { leave_dock } => {
                self.firmware.arm(leave_dock, &mut io.wire())?;
                self.stop_sent_us = None;
                Ok(())
            }
            DeviceCommand::Clear(inhibit) => self.firmware.clear(inhibit, &mut io.wire()),
            DeviceCommand::Tone {
                pitch_hz,
                duration_ms,
            } => {
                let pitch = Frequency(i32::try_from(pitch_hz).map_err(|_| CommandError::Range)?);
                self.firmware.tone(pitch, duration_ms, &mut io.wire())
            }
            DeviceCommand::Light { led, pattern } => self.firmware.light(
                Led {
                    led,
                    pattern,
                    brightness: Ratio::ONE,
                },
                &mut io.wire(),
            ),
        }
    }

    /// Sends a command of the wire as it is. For experts.
    ///
    /// # Errors
    /// Why not; nothing was sent then.
    pub fn send_raw(&mut self, command: Command, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.firmware.send(command, &mut io.wire())
    }

    fn emergency_stop(&mut self, io: &mut DeviceIo<'_>) {
        self.stop_sent_us = Some(io.now_us);
        self.dead_man.forget();
        self.cleaners = CleanerDrive::Off;
        self.cleaners_told_us = None;
        self.firmware.stop(&mut io.wire());
    }

    /// `stop` is not acknowledged: telemetry that does not know of it means that it was lost on the wire.
    fn repeat_lost_stop(&mut self, io: &mut DeviceIo<'_>) {
        let lost = io.events.iter().any(|event| {
            matches!(event, FirmwareEvent::State(state) if !state.inhibits.contains(Inhibit::Stopped))
        });
        let due = self
            .stop_sent_us
            .is_some_and(|sent_us| io.now_us >= sent_us + STOP_REPEAT_US);
        if lost && due {
            self.stop_sent_us = Some(io.now_us);
            self.firmware.stop(&mut io.wire());
        }
    }

    fn drive(&mut self, setpoint: Setpoint, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let limits = self.description.as_ref().ok_or(CommandError::NotAttached)?.drive;
        if self.stop_sent_us.is_some() {
            return Err(CommandError::Latched);
        }
        // Written so that NaN is refused too.
        let in_range = setpoint.speed_m_per_s.abs() <= limits.speed_max_m_per_s
            && setpoint.turn_rad_per_s.abs() <= limits.turn_max_rad_per_s;
        if !in_range {
            return Err(CommandError::Range);
        }
        self.dead_man.set(setpoint);
        self.renew_wheels(io)
    }

    fn renew(&mut self, io: &mut DeviceIo<'_>) {
        // A session that is not open is no news here: its end was an event, and the firmware's leases end with it.
        self.renew_wheels(io).ok();
        let due = self
            .cleaners_told_us
            .is_some_and(|told_us| io.now_us >= told_us + CLEANER_REPEAT_US);
        if self.cleaners != CleanerDrive::Off && due {
            self.tell_cleaners(io).ok();
        }
    }

    fn renew_wheels(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        match self.dead_man.poll(io.now_us) {
            WheelOrder::Keep => Ok(()),
            WheelOrder::Stand => self
                .firmware
                .drive(Speed::ZERO, AngularSpeed::ZERO, &mut io.wire()),
            WheelOrder::Send(setpoint) => self.firmware.drive(
                Speed::from_m_per_s(setpoint.speed_m_per_s),
                AngularSpeed::from_rad_per_s(setpoint.turn_rad_per_s),
                &mut io.wire(),
            ),
        }
    }

    fn set_cleaners(&mut self, drive: CleanerDrive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        if drive == self.cleaners {
            return Ok(());
        }
        if drive != CleanerDrive::Off && self.stop_sent_us.is_some() {
            return Err(CommandError::Latched);
        }
        self.cleaners = drive;
        self.tell_cleaners(io)
    }

    fn tell_cleaners(&mut self, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.cleaners_told_us = Some(io.now_us);
        self.firmware.cleaners(self.cleaners, &mut io.wire())
    }

    /// What of the events concerns the device layer itself.
    fn note(&mut self, events: &[FirmwareEvent]) {
        for event in events {
            match event {
                FirmwareEvent::Described(description) => self.description = Some((**description).clone()),
                FirmwareEvent::Opened(_) | FirmwareEvent::Closed => {
                    self.dead_man.forget();
                    self.cleaners = CleanerDrive::Off;
                    self.cleaners_told_us = None;
                }
                _ => {}
            }
        }
    }
}
