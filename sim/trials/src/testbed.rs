//! A robot with its real firmware, and a host that only implements the protocol.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::draw::RobotDraw;
use home::{Home, HomeError, ModelError, Noise, Pose, RobotModel, World};
use monitor::Bridges;
use pic32::board::pinout::Pinout;
use pic32::board::{
    Blueprint, BlueprintError, BoardError, CYCLES_PER_MS, CalibrationChoice, EmulatedRobot, EmulatedSettings,
    Particulars,
};
use pic32::image::{Image, ImageError};
use rvac_protocol::PacketBuffer;
use rvac_protocol::frame::SEPARATOR;
use rvac_protocol::message::{
    BinaryKinds, Command, Drive, Inhibits, Motor, MotorCommand, Report, ResetCause, Sequence, State,
};
use rvac_protocol::session::{HostEvent, HostSession, SendError};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};

/// How long boot and handshake may take. The image check of the start is part of it.
const CONNECT_MS: u64 = 8_000;
/// Life of the host's motion commands and how often they are renewed, ms: as vthal does it.
const LEASE_MS: u16 = 120;
const RENEW_MS: u64 = 30;
/// Period of a terminal that repeats what a person typed, ms.
const TYPE_MS: u64 = 100;

/// A wide room with nothing in it but the dock; the robot starts far from it.
const ROOM: &str = r#"
format = "librervac-home"
version = 1
name = "Wide room"

[[room]]
name = "Hall"
polygon = [[0.0, 0.0], [12.0, 0.0], [12.0, 8.0], [0.0, 8.0]]

[dock]
position = [0.0, 0.8]
heading-deg = 0.0
"#;
const START: Pose = Pose {
    x_m: 2.0,
    y_m: 4.0,
    heading_rad: 0.0,
};

/// Why a testbed cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum TestbedError {
    /// The firmware cannot be read.
    #[error("cannot read the firmware {}: {error}; `cargo xtask firmware sr8730` makes it", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// The file is no firmware for this chip.
    #[error("{}: {error}", .path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: ImageError,
    },
    /// The board cannot be built.
    #[error(transparent)]
    Blueprint(#[from] BlueprintError),
    /// The board's description is wrong.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The description of the robot is wrong.
    #[error("robot.toml: {0}")]
    Robot(String),
    /// The calibration record does not fit into the image.
    #[error("calibration record: {0}")]
    Record(#[source] ImageError),
    /// The robot's description is wrong.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The room of this program is wrong.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// The robot does not answer.
    #[error("the robot does not answer within {CONNECT_MS} ms of power-on")]
    Mute,
    /// The robot does not reach the trial's operating state.
    #[error("the robot does not get into the scene: {0}")]
    OperatingState(&'static str),
    /// The monitor saw a breach on the way there.
    #[error("the monitor: {0}")]
    Breach(String),
}

/// Everything that all testbeds share, read once.
#[derive(Clone, Debug)]
pub struct Fixture {
    image: Image,
    blueprint: Blueprint,
    home: Arc<Home>,
    model: RobotModel,
    drawn: bool,
}

impl Fixture {
    /// Reads the firmware.
    ///
    /// # Errors
    /// See [`TestbedError`].
    pub fn open(firmware: &Path) -> Result<Self, TestbedError> {
        let path = || firmware.to_owned();
        let bytes =
            std::fs::read(firmware).map_err(|error| TestbedError::Unreadable { path: path(), error })?;
        let image = Image::from_elf(&bytes).map_err(|error| TestbedError::Image { path: path(), error })?;
        let model = RobotModel::by_name("sr8730")?;
        Ok(Self {
            blueprint: Blueprint::sr8730(image.clone(), &CalibrationChoice::Complete)?,
            home: Arc::new(Home::from_floorplan("room", ROOM, &model)?),
            image,
            model,
            drawn: false,
        })
    }

    /// From now on each robot is one of its own: miscalibrated, noisy, with contacts that bounce, as its seed says.
    #[must_use]
    pub fn with_drawn_robots(self) -> Self {
        Self { drawn: true, ..self }
    }

    /// The same in another board. The robots of this fixture are not drawn.
    ///
    /// # Errors
    /// When the board lacks something that the robot needs.
    pub fn in_board(self, pinout: &Pinout, particulars: Particulars) -> Result<Self, TestbedError> {
        Ok(Self {
            blueprint: self.blueprint.in_board(pinout, particulars)?,
            drawn: false,
            ..self
        })
    }

    /// The image with its symbols.
    #[must_use]
    pub const fn image(&self) -> &Image {
        &self.image
    }

    /// A robot that was just switched on. Its core begins `late_cycles` (below a millisecond) after its surroundings'
    /// first millisecond, so that the two run at different phases.
    ///
    /// # Errors
    /// When the robot of the seed cannot be drawn.
    pub fn testbed(&self, seed: u64, bridges: Bridges, late_cycles: u64) -> Result<Testbed, TestbedError> {
        let mut settings = EmulatedSettings {
            seed,
            bridges,
            ..EmulatedSettings::default()
        };
        let mut robot = if self.drawn {
            let draw = RobotDraw::new(self.image.clone(), seed)?;
            settings.bounce_us = draw.bounce_us;
            settings.miscalibration = draw.deviation;
            let model = draw
                .deviation
                .map_or_else(|| self.model.clone(), |number| self.model.deviating(number));
            let blueprint = Blueprint::sr8730(draw.image, &CalibrationChoice::Complete)?;
            EmulatedRobot::new(&blueprint, self.world(&model, (&draw.noise, seed)), &settings)
        } else {
            EmulatedRobot::new(
                &self.blueprint,
                self.world(&self.model, (&Noise::ideal(), seed)),
                &settings,
            )
        };
        robot
            .machine_mut()
            .cpu_mut()
            .stall_until(late_cycles % CYCLES_PER_MS);
        Ok(Testbed {
            robot,
            session: HostSession::new(BinaryKinds::NONE, Tick(0)),
            from_robot: Vec::new(),
            to_robot: Vec::new(),
            state: None,
            described: false,
            reset_cause: None,
            drive: None,
            cleaners: Throttle::ZERO,
            speaks: true,
            said: Vec::new(),
            steps_hz: None,
            typed: None,
        })
    }

    fn world(&self, model: &RobotModel, (noise, seed): (&Noise, u64)) -> World {
        World::new(Arc::clone(&self.home), model, noise, seed, Some(START))
    }
}

/// A robot and its host. Clones continue from the same moment.
#[derive(Clone, Debug)]
pub struct Testbed {
    robot: EmulatedRobot,
    session: HostSession,
    from_robot: Vec<u8>,
    to_robot: Vec<u8>,
    state: Option<State>,
    described: bool,
    reset_cause: Option<ResetCause>,
    drive: Option<(Speed, AngularSpeed)>,
    cleaners: Throttle,
    speaks: bool,
    /// The packet that the robot is sending.
    said: Vec<u8>,
    steps_hz: Option<u32>,
    /// What a person types again and again.
    typed: Option<&'static str>,
}

impl Testbed {
    /// Waits for the handshake.
    ///
    /// # Errors
    /// [`TestbedError::Mute`].
    pub fn connect(&mut self) -> Result<(), TestbedError> {
        for _ in 0..CONNECT_MS {
            self.tick();
            if self.described && self.state.is_some() {
                return Ok(());
            }
        }
        Err(TestbedError::Mute)
    }

    /// One millisecond of everything.
    pub fn tick(&mut self) {
        // Truncation is the wrap of the millisecond clock.
        let now = Tick(self.robot.now_ms() as u32);
        if self.speaks {
            self.renew(now);
            self.speak(now);
        }
        if let Some(text) = self.typed.filter(|_| self.robot.now_ms().is_multiple_of(TYPE_MS)) {
            self.type_in(text);
        }
        let taken = self.robot.send(&self.to_robot);
        self.to_robot.drain(..taken);
        self.from_robot.clear();
        let mut heard = std::mem::take(&mut self.from_robot);
        self.robot.tick(&mut heard);
        for byte in &heard {
            self.read_steps(*byte);
            if let Some(event) = self.session.receive(*byte, now) {
                self.take(&event);
            }
        }
        self.from_robot = heard;
    }

    /// Reads the loop's frequency off the line: a robot that went back to hand mode reports it to nobody in particular.
    fn read_steps(&mut self, byte: u8) {
        const KEY: &str = r#""main-steps":"#;
        if byte != 0x1F {
            self.said.push(byte);
            return;
        }
        let packet = String::from_utf8_lossy(&self.said);
        let figure = packet.split_once(KEY).map(|(_, rest)| rest);
        let digits = figure.map(|rest| rest.split(|letter: char| !letter.is_ascii_digit()).next());
        self.steps_hz = digits
            .flatten()
            .and_then(|digits| digits.parse().ok())
            .or(self.steps_hz);
        self.said.clear();
    }

    /// So many milliseconds.
    pub fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.tick();
        }
    }

    fn speak(&mut self, now: Tick) {
        while let Some(event) = self.session.poll(now) {
            self.take(&event);
        }
        let mut packet = PacketBuffer::new();
        while self.session.next_packet(&mut packet) {
            self.to_robot.extend_from_slice(packet.as_bytes());
        }
    }

    /// Renews the host's motion.
    fn renew(&mut self, now: Tick) {
        if !self.robot.now_ms().is_multiple_of(RENEW_MS) {
            return;
        }
        if let Some((speed, turn)) = self.drive {
            self.send(
                Command::Drive(Drive {
                    speed,
                    turn,
                    lease_ms: LEASE_MS,
                    sequence: Sequence(0),
                    seen_tick: now,
                }),
                now,
            );
        }
        if self.cleaners != Throttle::ZERO {
            for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
                let command = MotorCommand {
                    motor,
                    throttle: self.cleaners,
                    lease_ms: LEASE_MS,
                    sequence: Sequence(0),
                    seen_tick: now,
                };
                self.send(Command::Motor(command), now);
            }
        }
    }

    fn send(&mut self, command: Command, now: Tick) {
        let mut packet = PacketBuffer::new();
        match self.session.send(command, now, &mut packet) {
            Ok(_) => self.to_robot.extend_from_slice(packet.as_bytes()),
            // While the session is closed or busy a host has nothing to say; the next renewal comes.
            Err(SendError::NotOpen | SendError::Busy | SendError::Range | SendError::Reserved) => {}
        }
    }

    fn take(&mut self, event: &HostEvent) {
        match event {
            HostEvent::Opened(hello) => self.reset_cause = Some(hello.reset_cause),
            HostEvent::Described(_) => self.described = true,
            HostEvent::Report(Report::State(state)) => self.state = Some(*state),
            _ => {}
        }
    }

    /// The host says one thing now.
    pub fn say(&mut self, command: Command) {
        let now = Tick(self.robot.now_ms() as u32);
        self.send(command, now);
    }

    /// The host allows motion.
    pub fn arm(&mut self) {
        self.say(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
    }

    /// The host allows motion off the dock.
    pub fn arm_to_leave(&mut self) {
        self.say(Command::Arm {
            sequence: Sequence(0),
            undock: true,
        });
    }

    /// A person types a packet without a CRC, whatever has become of the host.
    pub fn type_in(&mut self, text: &str) {
        self.to_robot.extend(text.bytes().chain([SEPARATOR]));
    }

    /// A person types this again and again from now on, in hand mode.
    pub const fn keep_typing(&mut self, text: Option<&'static str>) {
        self.typed = text;
    }

    /// Sets the host's motion from now on; `None` = it stops renewing.
    pub fn drive(&mut self, drive: Option<(Speed, AngularSpeed)>) {
        self.drive = drive;
    }

    /// Sets the host's duty of brushes and suction from now on.
    pub fn clean(&mut self, duty: Throttle) {
        self.cleaners = duty;
    }

    /// The host falls silent, or speaks again.
    pub fn set_speaking(&mut self, speaks: bool) {
        self.speaks = speaks;
    }

    /// Passes of the robot's main loop in a second, by its newest report.
    #[must_use]
    pub const fn steps_hz(&self) -> Option<u32> {
        self.steps_hz
    }

    /// Whether a session is open.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.session.is_open() && self.session.robot_tick().is_some()
    }

    /// The robot.
    #[must_use]
    pub const fn robot(&self) -> &EmulatedRobot {
        &self.robot
    }

    /// The robot, to do something to it.
    pub const fn robot_mut(&mut self) -> &mut EmulatedRobot {
        &mut self.robot
    }

    /// What keeps the robot from moving, by its newest report.
    #[must_use]
    pub fn inhibits(&self) -> Inhibits {
        self.state.map_or(Inhibits::NONE, |state| state.inhibits)
    }

    /// Why the chip last started, by its greeting.
    #[must_use]
    pub const fn reset_cause(&self) -> Option<ResetCause> {
        self.reset_cause
    }
}
