//! A robot with its image, and a host that only implements the protocol: what measurements of the firmware begin with.

use crate::board::{BoardError, EmulatedRelax, RelaxBlueprint, RelaxSettings};
use crate::image::{Image, ImageError};
use home::{Home, HomeError, ModelError, Noise, Pose, RobotModel, World};
use rvac_protocol::PacketBuffer;
use rvac_protocol::frame::SEPARATOR;
use rvac_protocol::message::{
    BinaryKinds, Command, Inhibits, LinkCounters, Refusal, Report, Sequence, State,
};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::Tick;
use std::sync::Arc;

/// A room with nothing in it; the robot stands in its middle.
const ROOM: &str = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0]]\n";
const MIDDLE: (f64, f64) = (4.0, 3.0);
/// The start, with the check of the flash, and the handshake take no longer.
const CONNECT_MS: u64 = 4_000;
/// What arming takes at most.
const ARMING_MS: u64 = 200;

/// Why a robot cannot be hosted.
#[derive(Debug, thiserror::Error)]
pub enum HostedError {
    /// The image is none for this chip.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The description of the board is wrong.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The description of the robot is wrong.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The room of this module is wrong.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// The robot does not answer.
    #[error("the robot does not describe itself within {CONNECT_MS} ms of power-on")]
    Mute,
    /// It does not let itself be armed.
    #[error("the robot is not armed; it says: {0}")]
    NotArmed(String),
}

/// Robots of one image.
#[derive(Clone, Debug)]
pub struct HostedBlueprint {
    board: RelaxBlueprint,
    home: Arc<Home>,
    model: RobotModel,
}

impl HostedBlueprint {
    /// From the text of an Intel HEX file.
    ///
    /// # Errors
    /// See [`HostedError`].
    pub fn from_hex(text: &str) -> Result<Self, HostedError> {
        Self::new(Image::from_hex(text)?)
    }

    /// From an image.
    ///
    /// # Errors
    /// See [`HostedError`].
    pub fn new(image: Image) -> Result<Self, HostedError> {
        let model = RobotModel::by_name("relax")?;
        Ok(Self {
            board: RelaxBlueprint::new(image)?,
            home: Arc::new(Home::from_floorplan("room", ROOM, &model)?),
            model,
        })
    }

    /// A robot that was just switched on, with sensors without noise, and a host that uses these binary kinds.
    #[must_use]
    pub fn robot(&self, kinds: BinaryKinds) -> HostedRelax {
        let (x_m, y_m) = MIDDLE;
        let pose = self
            .home
            .file_from_plan()
            .inverse()
            .then(Pose::new(x_m, y_m, 0.0));
        let world = World::new(
            Arc::clone(&self.home),
            &self.model,
            &Noise::ideal(),
            1,
            Some(pose),
        );
        HostedRelax {
            robot: EmulatedRelax::new(&self.board, world, &RelaxSettings::default()),
            session: HostSession::new(kinds, Tick(0)),
            to_robot: Vec::new(),
            is_speaking: true,
            is_described: false,
            state: None,
            states: 0,
            refusals: Vec::new(),
            link_first: None,
            link_last: None,
            bad_before: 0,
        }
    }
}

/// The pair.
#[derive(Clone, Debug)]
pub struct HostedRelax {
    robot: EmulatedRelax,
    session: HostSession,
    to_robot: Vec<u8>,
    is_speaking: bool,
    is_described: bool,
    state: Option<State>,
    states: u64,
    refusals: Vec<Refusal>,
    /// What the robot told of its end of the line, when the session had just begun and last.
    link_first: Option<LinkCounters>,
    link_last: Option<LinkCounters>,
    /// Bad packets when the session had just begun: one of before may be among them.
    bad_before: u32,
}

impl HostedRelax {
    /// A millisecond of both.
    pub fn tick(&mut self) {
        let now = self.now();
        if self.is_speaking {
            while let Some(event) = self.session.poll(now) {
                self.take(&event);
            }
            let mut packet = PacketBuffer::new();
            while self.session.next_packet(&mut packet) {
                self.to_robot.extend_from_slice(packet.as_bytes());
            }
        }
        let taken = self.robot.send(&self.to_robot);
        self.to_robot.drain(..taken);
        let mut heard = Vec::new();
        self.robot.tick(&mut heard);
        let now = self.now();
        for byte in heard {
            if let Some(event) = self.session.receive(byte, now) {
                self.take(&event);
            }
        }
    }

    /// So many milliseconds.
    pub fn run(&mut self, ms: u64) {
        (0..ms).for_each(|_| self.tick());
    }

    /// Until the robot has described itself.
    ///
    /// # Errors
    /// When it does not.
    pub fn connect(&mut self) -> Result<(), HostedError> {
        for _ in 0..CONNECT_MS {
            if self.is_connected() {
                return Ok(());
            }
            self.tick();
        }
        Err(HostedError::Mute)
    }

    /// The host allows motion.
    ///
    /// # Errors
    /// When the robot does not let it.
    pub fn arm(&mut self) -> Result<(), HostedError> {
        self.say(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
        for _ in 0..ARMING_MS {
            self.tick();
            if self.state.is_some() && self.inhibits() == Inhibits::NONE {
                return Ok(());
            }
        }
        let names: Vec<&str> = self
            .inhibits()
            .iter()
            .map(rvac_protocol::message::Inhibit::name)
            .collect();
        Err(HostedError::NotArmed(names.join(", ")))
    }

    /// The host says one thing now; says whether its session let it.
    pub fn say(&mut self, command: Command) -> bool {
        let mut packet = PacketBuffer::new();
        let now = self.now();
        let is_said = self.session.send(command, now, &mut packet).is_ok();
        if is_said && self.is_speaking {
            self.to_robot.extend_from_slice(packet.as_bytes());
        }
        is_said
    }

    /// The packet of a command, as the host would send it now.
    pub fn packet(&mut self, command: Command) -> Vec<u8> {
        let mut packet = PacketBuffer::new();
        let now = self.now();
        self.session.send(command, now, &mut packet).ok();
        packet.as_bytes().to_vec()
    }

    /// Bytes go to the robot, whatever they are.
    pub fn send(&mut self, bytes: &[u8]) {
        self.to_robot.extend_from_slice(bytes);
    }

    /// A person types a packet without a CRC.
    pub fn type_in(&mut self, text: &str) {
        self.to_robot.extend(text.bytes().chain([SEPARATOR]));
    }

    /// The host falls silent, or speaks again.
    pub const fn set_speaking(&mut self, is_speaking: bool) {
        self.is_speaking = is_speaking;
    }

    fn take(&mut self, event: &HostEvent) {
        match event {
            HostEvent::Described(_) => {
                self.is_described = true;
                self.bad_before = self.all_bad_packets();
            }
            HostEvent::Closed(_) | HostEvent::Silent => self.is_described = false,
            HostEvent::Report(Report::Info(info)) if self.is_described => {
                self.link_last = Some(info.link);
                self.link_first = self.link_first.or(Some(info.link));
            }
            HostEvent::Report(Report::State(state)) => {
                self.states += 1;
                self.state = Some(*state);
            }
            HostEvent::Answered {
                refusal: Some(refusal),
                ..
            } => self.refusals.push(*refusal),
            _ => {}
        }
    }

    /// Whether a session is open and the robot known.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.is_described && self.session.is_open() && self.session.robot_tick().is_some()
    }

    /// What keeps the robot from moving, by its newest report.
    #[must_use]
    pub fn inhibits(&self) -> Inhibits {
        self.state.map_or(Inhibits::NONE, |state| state.inhibits)
    }

    /// `state` reports so far.
    #[must_use]
    pub const fn states(&self) -> u64 {
        self.states
    }

    /// What was refused so far.
    #[must_use]
    pub fn refusals(&self) -> &[Refusal] {
        &self.refusals
    }

    /// Packets that the host has not understood since the session began.
    #[must_use]
    pub fn bad_packets(&self) -> u32 {
        self.all_bad_packets() - self.bad_before
    }

    /// Bytes and packets that the robot has lost since its first `info` of the session, by its newest.
    #[must_use]
    pub fn lost_by_robot(&self) -> u32 {
        let lost =
            |link: LinkCounters| link.bad_crc + link.overrun + link.framing + link.malformed + link.resync;
        let (first, last) = (self.link_first.map(lost), self.link_last.map(lost));
        last.unwrap_or_default() - first.unwrap_or_default()
    }

    fn all_bad_packets(&self) -> u32 {
        let counters = self.session.counters();
        counters.bad_crc + counters.malformed + counters.framing
    }

    /// Bytes that wait for the line.
    #[must_use]
    pub const fn waiting(&self) -> usize {
        self.to_robot.len()
    }

    /// The host's clock.
    #[must_use]
    pub fn now(&self) -> Tick {
        Tick(self.robot.now_ms() as u32)
    }

    /// The robot.
    #[must_use]
    pub const fn robot(&self) -> &EmulatedRelax {
        &self.robot
    }

    /// The robot, to do something to it.
    pub const fn robot_mut(&mut self) -> &mut EmulatedRelax {
        &mut self.robot
    }
}
