//! Both ends joined in memory on a virtual clock.

use std::collections::VecDeque;

use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Capabilities, Command, Description, Limits, MotorGaps, MotorSet, Name, Report, ResetCause,
    Sequence, State,
};
use rvac_protocol::session::{HostEvent, HostSession, RobotEvent, RobotIdentity, RobotSession, SendError};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

/// Who the robot of the tests is.
pub(crate) fn identity() -> RobotIdentity {
    RobotIdentity {
        device: Name::try_from("sr8730").expect("a short name"),
        firmware: Name::try_from("0.1.0").expect("a short name"),
        boot_count: 17,
        reset_cause: ResetCause::PowerOn,
        session_seed: 17,
        binary: BinaryKinds::ALL,
        description: Description {
            capabilities: Capabilities {
                encoders: true,
                bumpers: 2,
                ..Capabilities::default()
            },
            limits: Limits {
                speed_max: Speed(350_000),
                turn_max: AngularSpeed(1_500_000),
                track: Length(230_000),
                count_nm: 123_456,
                radius: Length(175_000),
                swath: Length(300_000),
            },
            motors: MotorGaps {
                unguarded: MotorSet {
                    brush_sides: true,
                    vacuum: true,
                    ..MotorSet::default()
                },
                unmeasured: MotorSet {
                    brush_main: true,
                    ..MotorSet::default()
                },
            },
        },
    }
}

/// What happens to a chunk of bytes on its way; it may change, drop or add bytes.
pub(crate) type Wire = Box<dyn FnMut(&mut Vec<u8>)>;

/// Two ends and the lines between them, one millisecond a step.
pub(crate) struct Pair {
    pub(crate) robot: RobotSession,
    pub(crate) host: HostSession,
    pub(crate) now: Tick,
    pub(crate) to_robot: Wire,
    pub(crate) to_host: Wire,
    pub(crate) robot_events: Vec<RobotEvent>,
    pub(crate) host_events: Vec<HostEvent>,
    /// Everything the robot sent.
    pub(crate) said_by_robot: Vec<u8>,
    /// The robot answers commands that must arrive; off to test what happens when it does not.
    pub(crate) answering: bool,
    /// The robot sends `state` every so many ms; 0 = never.
    pub(crate) state_ms: u32,
    pending: VecDeque<Vec<u8>>,
}

impl Pair {
    pub(crate) fn new(binary: BinaryKinds) -> Self {
        let now = Tick(1_000);
        Self {
            robot: RobotSession::new(identity(), now),
            host: HostSession::new(binary, now),
            now,
            to_robot: Box::new(|_| {}),
            to_host: Box::new(|_| {}),
            robot_events: Vec::new(),
            host_events: Vec::new(),
            said_by_robot: Vec::new(),
            answering: true,
            state_ms: 20,
            pending: VecDeque::new(),
        }
    }

    /// A pair whose session is open and described.
    pub(crate) fn open(binary: BinaryKinds) -> Self {
        let mut pair = Self::new(binary);
        pair.run_ms(300);
        assert!(pair.host.is_open(), "{:?}", pair.host_events);
        pair
    }

    pub(crate) fn run_ms(&mut self, duration_ms: u32) {
        for _ in 0..duration_ms {
            self.step();
        }
    }

    pub(crate) fn send(&mut self, command: Command) -> Result<Option<Sequence>, SendError> {
        let mut buffer = PacketBuffer::new();
        let sequence = self.host.send(command, self.now, &mut buffer)?;
        self.pending.push_back(buffer.as_bytes().to_vec());
        Ok(sequence)
    }

    /// Puts bytes on the line to the robot as they are.
    pub(crate) fn inject(&mut self, bytes: &[u8]) {
        self.pending.push_back(bytes.to_vec());
    }

    pub(crate) fn commands(&self) -> Vec<Command> {
        self.robot_events
            .iter()
            .filter_map(|event| match event {
                RobotEvent::Command(command) => Some(*command),
                RobotEvent::SessionOpened | RobotEvent::SessionClosed(_) => None,
            })
            .collect()
    }

    pub(crate) fn reset_robot(&mut self) {
        let mut identity = identity();
        identity.reset_cause = ResetCause::Watchdog;
        identity.session_seed = 18;
        self.robot = RobotSession::new(identity, self.now);
    }

    fn step(&mut self) {
        self.now = self.now.after(1);
        let mut buffer = PacketBuffer::new();
        self.host_events
            .extend(std::iter::from_fn(|| self.host.poll(self.now)));
        while self.host.next_packet(&mut buffer) {
            self.pending.push_back(buffer.as_bytes().to_vec());
        }
        while let Some(mut bytes) = self.pending.pop_front() {
            (self.to_robot)(&mut bytes);
            for byte in bytes {
                let event = self.robot.receive(byte, self.now);
                self.note(event);
            }
        }
        let event = self.robot.poll(self.now);
        self.note(event);
        if self.state_ms > 0 && self.now.0.is_multiple_of(self.state_ms) {
            let state = State {
                tick: self.now,
                ..State::default()
            };
            self.report(&Report::State(state));
        }
        while self.robot.next_packet(&mut buffer) {
            self.carry_to_host(buffer.as_bytes());
        }
    }

    pub(crate) fn report(&mut self, report: &Report) {
        let mut buffer = PacketBuffer::new();
        self.robot.encode(report, &mut buffer).expect("reports fit");
        self.carry_to_host(buffer.as_bytes());
    }

    fn carry_to_host(&mut self, bytes: &[u8]) {
        self.said_by_robot.extend_from_slice(bytes);
        let mut bytes = bytes.to_vec();
        (self.to_host)(&mut bytes);
        for byte in bytes {
            self.host_events.extend(self.host.receive(byte, self.now));
        }
    }

    fn note(&mut self, event: Option<RobotEvent>) {
        let Some(event) = event else { return };
        if let RobotEvent::Command(command) = event
            && self.answering
            && command.must_arrive()
            && let Some(sequence) = command.sequence()
        {
            self.robot.answer(sequence, None);
        }
        self.robot_events.push(event);
    }
}
