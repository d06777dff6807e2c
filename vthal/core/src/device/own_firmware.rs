//! Robots that run our own firmware: the device model on the wire protocol.

use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    Beep, BinaryKinds, Capabilities, Command, Drive, Info, Inhibit, Led, LogLevel, LogText, Motor,
    MotorCommand, NumberedEvent, Refusal, Report, RobotHello, Sequence, State,
};
use rvac_protocol::quality::LinkQuality;
use rvac_protocol::session::{HostEvent, HostSession, SendError};
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Tick};

use super::{
    CleanerDrive, CleanerPower, CommandError, DeadManKind, Description, DriveLimits, Identity, LeaveDock,
    Level, Part, ReflexSite, Reflexes, SensorCounts, Shape,
};

/// Lease of motion commands on the wire. Shorter than the firmware's default of 250 ms, so that braking too is over 300 ms
/// after the host's death (S1).
const LEASE_MS: u16 = 120;
/// Lease of brushes and suction on the wire: the longest allowed, because they stand still only 2 s later anyway.
const CLEANER_LEASE_MS: u16 = 1000;

/// What the firmware told.
#[derive(Clone, Debug, PartialEq)]
pub enum FirmwareEvent {
    /// A session is open; the description follows.
    Opened(RobotHello),
    /// The robot has described itself.
    Described(Box<Description>),
    /// Telemetry.
    State(State),
    /// Slow facts.
    Info(Info),
    /// An edge.
    Edge(NumberedEvent),
    /// A line for people.
    Log {
        /// How grave.
        level: LogLevel,
        /// What.
        text: LogText,
    },
    /// A command was refused.
    Refused {
        /// Its number, if the robot could read it.
        sequence: Option<Sequence>,
        /// Why.
        refusal: Refusal,
    },
    /// A command was not answered.
    Unanswered(Sequence),
    /// Edges were lost.
    EdgesLost(u16),
    /// The session is over.
    Closed,
    /// The robot speaks no version of the wire that we do.
    Incompatible {
        /// Its oldest version.
        version_min: u8,
        /// Its newest version.
        version_max: u8,
    },
}

/// The host's end of one robot.
#[derive(Debug)]
pub(crate) struct OwnFirmware {
    session: HostSession,
    hello: Option<RobotHello>,
    buffer: PacketBuffer,
    capabilities: Capabilities,
}

impl OwnFirmware {
    /// A robot that has just been connected.
    #[must_use]
    pub(crate) fn new(now: Tick) -> Self {
        Self {
            session: HostSession::new(BinaryKinds::ALL, now),
            hello: None,
            buffer: PacketBuffer::new(),
            capabilities: Capabilities::default(),
        }
    }

    /// Takes bytes from the robot; appends answers to `link` and events to `events`.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Tick, io: &mut FirmwareIo<'_>) {
        for byte in bytes {
            if let Some(event) = self.session.receive(*byte, now) {
                self.take(event, io.events);
            }
        }
        self.pump(io.link);
    }

    /// Lets time pass.
    pub(crate) fn poll(&mut self, now: Tick, io: &mut FirmwareIo<'_>) {
        while let Some(event) = self.session.poll(now) {
            self.take(event, io.events);
        }
        self.pump(io.link);
    }

    /// When [`OwnFirmware::poll`] has something to do at the latest.
    #[must_use]
    pub(crate) fn next_poll(&self) -> Tick {
        self.session.next_poll()
    }

    /// Whether a session is open.
    #[must_use]
    pub(crate) fn is_open(&self) -> bool {
        self.session.is_open()
    }

    /// Quality of the link.
    #[must_use]
    pub(crate) fn quality(&self) -> LinkQuality {
        self.session.quality()
    }

    /// Number of the session for the seal; 0 while none is open.
    #[must_use]
    pub(crate) fn session_number(&self) -> u16 {
        self.hello.as_ref().map_or(0, |hello| hello.session)
    }

    /// Whether telemetry comes in binary form.
    #[must_use]
    pub(crate) fn is_binary(&self) -> bool {
        self.hello.as_ref().is_some_and(|hello| hello.binary.state)
    }

    /// Drives under the firmware's lease.
    ///
    /// # Errors
    /// Why nothing was sent.
    pub(crate) fn drive(
        &mut self,
        speed: Speed,
        turn: AngularSpeed,
        out: &mut WireOut<'_>,
    ) -> Result<(), CommandError> {
        let drive = Drive {
            speed,
            turn,
            lease_ms: LEASE_MS,
            sequence: Sequence(0),
            seen_tick: Tick(0),
        };
        self.send(Command::Drive(drive), out)
    }

    /// Runs or stops brushes and suction, as far as the robot has them.
    ///
    /// # Errors
    /// Why nothing was sent.
    pub(crate) fn cleaners(
        &mut self,
        drive: CleanerDrive,
        out: &mut WireOut<'_>,
    ) -> Result<(), CommandError> {
        let power = match drive {
            CleanerDrive::On(power) => power,
            CleanerDrive::Off => CleanerPower::NONE,
        };
        let parts = [
            (Motor::BrushMain, self.capabilities.brush_main, power.brush_main),
            (
                Motor::BrushSides,
                self.capabilities.brush_sides,
                power.brush_sides,
            ),
            (Motor::Vacuum, self.capabilities.vacuum, power.vacuum),
        ];
        for (motor, present, throttle) in parts {
            if present {
                let command = MotorCommand {
                    motor,
                    throttle,
                    lease_ms: CLEANER_LEASE_MS,
                    sequence: Sequence(0),
                    seen_tick: Tick(0),
                };
                self.send(Command::Motor(command), out)?;
            }
        }
        Ok(())
    }

    /// Stops everything; also without a session.
    pub(crate) fn stop(&mut self, out: &mut WireOut<'_>) {
        // Cannot fail: `stop` needs no session and has no numbers.
        self.send(Command::Stop, out).ok();
    }

    /// Allows motion.
    ///
    /// # Errors
    /// Why nothing was sent.
    pub(crate) fn arm(&mut self, leave_dock: LeaveDock, out: &mut WireOut<'_>) -> Result<(), CommandError> {
        self.send(
            Command::Arm {
                sequence: Sequence(0),
                undock: leave_dock == LeaveDock::Leave,
            },
            out,
        )
    }

    /// Clears a latched inhibit.
    ///
    /// # Errors
    /// Why nothing was sent.
    pub(crate) fn clear(&mut self, inhibit: Inhibit, out: &mut WireOut<'_>) -> Result<(), CommandError> {
        self.send(
            Command::Clear {
                sequence: Sequence(0),
                inhibit,
            },
            out,
        )
    }

    /// Plays a tone at half volume.
    ///
    /// # Errors
    /// [`CommandError::Absent`] without a beeper, else why nothing was sent.
    pub(crate) fn tone(
        &mut self,
        pitch: Frequency,
        duration_ms: u16,
        out: &mut WireOut<'_>,
    ) -> Result<(), CommandError> {
        if !self.capabilities.beeper {
            return Err(CommandError::Absent);
        }
        let volume = Ratio::from_millionths(500_000).unwrap_or_default();
        self.send(
            Command::Beep(Beep {
                pitch,
                duration_ms,
                volume,
            }),
            out,
        )
    }

    /// Sets a light.
    ///
    /// # Errors
    /// [`CommandError::Absent`] without that light, else why nothing was sent.
    pub(crate) fn light(&mut self, led: Led, out: &mut WireOut<'_>) -> Result<(), CommandError> {
        if led.led >= self.capabilities.leds {
            return Err(CommandError::Absent);
        }
        self.send(Command::Led(led), out)
    }

    /// Sends a command of the wire as it is, numbered by the session.
    ///
    /// # Errors
    /// Why nothing was sent.
    pub(crate) fn send(&mut self, command: Command, out: &mut WireOut<'_>) -> Result<(), CommandError> {
        match self.session.send(command, out.now, &mut self.buffer) {
            Ok(_) => {
                out.link.extend_from_slice(self.buffer.as_bytes());
                self.pump(out.link);
                Ok(())
            }
            Err(SendError::NotOpen) => Err(CommandError::NotAttached),
            Err(SendError::Busy) => Err(CommandError::Busy),
            Err(SendError::Range | SendError::Reserved) => Err(CommandError::Range),
        }
    }

    fn pump(&mut self, link: &mut Vec<u8>) {
        while self.session.next_packet(&mut self.buffer) {
            link.extend_from_slice(self.buffer.as_bytes());
        }
    }

    fn take(&mut self, event: HostEvent, events: &mut Vec<FirmwareEvent>) {
        let told = match event {
            HostEvent::Opened(hello) => {
                self.hello = Some(hello.clone());
                FirmwareEvent::Opened(hello)
            }
            HostEvent::Described(table) => {
                self.capabilities = table.capabilities;
                FirmwareEvent::Described(Box::new(describe(self.hello.as_ref(), &table)))
            }
            HostEvent::Report(Report::State(state)) => FirmwareEvent::State(state),
            HostEvent::Report(Report::Info(info)) => FirmwareEvent::Info(info),
            HostEvent::Report(Report::Event(edge)) => FirmwareEvent::Edge(edge),
            HostEvent::Report(Report::Log { level, text }) => FirmwareEvent::Log { level, text },
            // The session keeps these to itself.
            HostEvent::Report(Report::Hello(_) | Report::Describe(_) | Report::Acknowledgement(_)) => return,
            // Raw readings are for tools that speak to a robot directly.
            HostEvent::Report(Report::Probed(_)) => return,
            HostEvent::Answered { refusal: None, .. } => return,
            HostEvent::Answered {
                sequence,
                refusal: Some(refusal),
            } => FirmwareEvent::Refused { sequence, refusal },
            HostEvent::Unanswered(sequence) => FirmwareEvent::Unanswered(sequence),
            HostEvent::EventsLost { count } => FirmwareEvent::EdgesLost(count),
            HostEvent::Closed(_) | HostEvent::Silent => FirmwareEvent::Closed,
            HostEvent::Incompatible {
                version_min,
                version_max,
            } => FirmwareEvent::Incompatible {
                version_min: version_min.0,
                version_max: version_max.0,
            },
        };
        events.push(told);
    }
}

/// Where bytes for the robot and events go.
#[derive(Debug)]
pub(crate) struct FirmwareIo<'a> {
    /// Bytes for the robot.
    pub link: &'a mut Vec<u8>,
    /// What happened.
    pub events: &'a mut Vec<FirmwareEvent>,
}

/// Where the bytes of a command go, and when.
#[derive(Debug)]
pub(crate) struct WireOut<'a> {
    /// The host's millisecond clock.
    pub now: Tick,
    /// Bytes for the robot.
    pub link: &'a mut Vec<u8>,
}

fn describe(hello: Option<&RobotHello>, table: &rvac_protocol::message::Description) -> Description {
    let has = table.capabilities;
    let limits = table.limits;
    Description {
        identity: identity(hello),
        levels: &[Level::Motion],
        shape: Shape::Circle {
            radius_m: limits.radius.as_m(),
        },
        swath_m: limits.swath.as_m(),
        drive: DriveLimits {
            track_m: limits.track.as_m(),
            speed_max_m_per_s: limits.speed_max.as_m_per_s(),
            turn_max_rad_per_s: limits.turn_max.as_rad_per_s(),
            dead_man: DeadManKind::PerCommand,
        },
        count_m: f64::from(limits.count_nm) * 1e-9,
        reflexes: Reflexes {
            bump: reflex(has.bumpers),
            cliff: reflex(has.cliffs),
            lift: reflex(has.wheel_drops),
        },
        sensors: SensorCounts {
            bumpers: has.bumpers,
            cliffs: has.cliffs,
            wheel_drops: has.wheel_drops,
            proximity: has.proximity,
            dock_receivers: has.dock_receivers,
            buttons: has.buttons,
            leds: has.leds,
        },
        parts: parts(has),
    }
}

fn identity(hello: Option<&RobotHello>) -> Identity {
    let Some(hello) = hello else {
        return Identity::default();
    };
    let newest = rvac_protocol::message::ProtocolVersion::CURRENT.min(hello.version_max);
    Identity {
        device: hello.device.as_str().to_owned(),
        firmware: hello.firmware.as_str().to_owned(),
        protocol: newest.0,
    }
}

fn reflex(sensors: u8) -> ReflexSite {
    if sensors == 0 {
        ReflexSite::Absent
    } else {
        ReflexSite::Device
    }
}

fn parts(has: Capabilities) -> Vec<Part> {
    [
        (Part::Gyro, has.gyro),
        (Part::BrushMain, has.brush_main),
        (Part::BrushSides, has.brush_sides),
        (Part::Vacuum, has.vacuum),
        (Part::Beeper, has.beeper),
        (Part::Battery, has.battery),
        (Part::Currents, has.currents),
        (Part::Charger, has.charger),
    ]
    .into_iter()
    .filter_map(|(part, present)| present.then_some(part))
    .collect()
}
