//! A robot with its real firmware, and a host that only implements the protocol.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, bail};
use home::{Home, Noise, Pose, RobotModel, World};
use pic32::board::serial::HostRate;
use pic32::board::{Blueprint, CYCLES_PER_MS, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::image::Image;
use pic32::machine::Machine;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Info, LinkCounters, Parameter, Report, Sequence};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{AngularSpeed, Speed, Tick};

/// How long the handshake may take.
const CONNECT_MS: u64 = 5_000;
/// Life of a motion command. It is renewed every [`RENEW_MS`].
const LEASE_MS: u16 = 250;
const RENEW_MS: u64 = 50;
/// At full load the host's driver always holds so much, about five milliseconds of the fastest line.
const AHEAD_BYTES: usize = 128;
/// Where a circle is free in the two-room flat.
const START: Pose = Pose {
    x_m: 3.7,
    y_m: 2.0,
    heading_rad: 0.0,
};
/// A circle of 0.3 m. The session puts its own number and tick into it.
const CIRCLE: Drive = Drive {
    speed: Speed(150_000),
    turn: AngularSpeed(500_000),
    lease_ms: LEASE_MS,
    sequence: Sequence(0),
    seen_tick: Tick(0),
};

/// Everything that a robot is made of, read once.
#[derive(Debug)]
pub(crate) struct Shop {
    /// The firmware.
    pub(crate) image: Image,
    blueprint: Blueprint,
    home: Arc<Home>,
    model: RobotModel,
}

impl Shop {
    /// Reads the firmware and the home.
    pub(crate) fn open(firmware: &Path, home: &Path) -> anyhow::Result<Self> {
        let bytes =
            std::fs::read(firmware).with_context(|| format!("the firmware {}", firmware.display()))?;
        let image =
            Image::from_elf(&bytes).with_context(|| format!("the firmware {}", firmware.display()))?;
        let model = RobotModel::by_name("sr8730")?;
        Ok(Self {
            blueprint: Blueprint::sr8730(image.clone(), &CalibrationChoice::Complete)?,
            image,
            home: Arc::new(Home::load(home, &model)?),
            model,
        })
    }

    /// A robot that was just switched on, and a host at this rate.
    pub(crate) fn desk(&self, baud: u32) -> Desk {
        let world = World::new(
            Arc::clone(&self.home),
            &self.model,
            &Noise::ideal(),
            1,
            Some(START),
        );
        let settings = EmulatedSettings {
            rate: HostRate::exact(baud),
            ..EmulatedSettings::default()
        };
        let robot = EmulatedRobot::new(&self.blueprint, world, &settings);
        Desk {
            empty_room: robot.line_room(),
            robot,
            session: HostSession::new(BinaryKinds::NONE, Tick(0)),
            from_robot: Vec::new(),
            packet: PacketBuffer::new(),
            info: None,
            heard_bytes: 0,
            sent_bytes: 0,
        }
    }
}

/// A robot and its host.
#[derive(Debug)]
pub(crate) struct Desk {
    robot: EmulatedRobot,
    session: HostSession,
    from_robot: Vec<u8>,
    packet: PacketBuffer,
    info: Option<Info>,
    heard_bytes: u64,
    sent_bytes: u64,
    /// What the host's driver takes while it holds nothing.
    empty_room: usize,
}

impl Desk {
    /// One millisecond.
    pub(crate) fn tick(&mut self) {
        self.from_robot.clear();
        self.robot.tick(&mut self.from_robot);
        self.heard_bytes += self.from_robot.len() as u64;
        let now = self.now();
        for byte in std::mem::take(&mut self.from_robot) {
            let event = self.session.receive(byte, now);
            self.note(event);
        }
        while let Some(event) = self.session.poll(now) {
            self.note(Some(event));
        }
        while self.session.next_packet(&mut self.packet) {
            self.send_packet();
        }
    }

    fn note(&mut self, event: Option<HostEvent>) {
        if let Some(HostEvent::Report(Report::Info(info))) = event {
            self.info = Some(info);
        }
    }

    fn now(&self) -> Tick {
        Tick(self.robot.now_ms() as u32)
    }

    fn send_packet(&mut self) {
        self.sent_bytes += self.robot.send(self.packet.as_bytes()) as u64;
    }

    /// Sends a command; one that the session does not take now is left out.
    pub(crate) fn send(&mut self, command: Command) {
        let now = self.now();
        if self.session.send(command, now, &mut self.packet).is_ok() {
            self.send_packet();
        }
    }

    /// Lets time pass without asking for anything.
    pub(crate) fn pass_ms(&mut self, ms: u64) {
        for _ in 0..ms {
            self.tick();
        }
    }

    /// Opens a session and has the robot send its state every 20 ms, 50 times a second.
    pub(crate) fn connect(&mut self) -> anyhow::Result<()> {
        let end = self.robot.now_ms() + CONNECT_MS;
        while !self.session.is_open() {
            if self.robot.now_ms() >= end {
                bail!("the robot did not open a session within {CONNECT_MS} ms");
            }
            self.tick();
        }
        for (parameter, value) in [(Parameter::StatePeriod, 20), (Parameter::InfoPeriod, 1_000)] {
            self.send(Command::Set {
                sequence: Sequence(0),
                parameter,
                value,
            });
        }
        self.pass_ms(200);
        self.send(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
        self.pass_ms(200);
        Ok(())
    }

    /// Drives in circles for so long.
    pub(crate) fn circle_ms(&mut self, ms: u64) {
        for _ in 0..ms {
            if self.robot.now_ms().is_multiple_of(RENEW_MS) {
                self.send(Command::Drive(CIRCLE));
            }
            self.tick();
        }
    }

    /// Fills both directions of the line for so long: commands as fast as the line takes them, and state reports asked for
    /// without pause. The session's own packets share the line.
    pub(crate) fn flood_ms(&mut self, ms: u64) {
        for _ in 0..ms {
            while self.robot.line_room() + AHEAD_BYTES > self.empty_room {
                let before = self.sent_bytes;
                self.send(if self.robot.now_ms().is_multiple_of(4) {
                    Command::State
                } else {
                    Command::Drive(CIRCLE)
                });
                if self.sent_bytes == before {
                    break;
                }
            }
            self.tick();
        }
    }

    /// Asks for the robot's slow facts and waits for them.
    pub(crate) fn ask_info(&mut self) -> anyhow::Result<Info> {
        self.info = None;
        self.send(Command::Info);
        for _ in 0..2_000 {
            self.tick();
            if let Some(info) = self.info.take() {
                return Ok(info);
            }
        }
        bail!("the robot did not tell its slow facts within two seconds")
    }

    /// The chip.
    pub(crate) fn machine(&self) -> &Machine {
        self.robot.machine()
    }

    /// Resets the chip's accounting.
    pub(crate) fn restart_accounts(&mut self) {
        self.robot.machine_mut().restart_accounting();
    }

    /// Cycles since power-on.
    pub(crate) fn cycle(&self) -> u64 {
        self.robot.now_ms() * CYCLES_PER_MS
    }

    /// Counts of damaged inbound packets.
    pub(crate) fn counters(&self) -> LinkCounters {
        self.session.counters()
    }

    /// Bytes received and sent.
    pub(crate) fn bytes(&self) -> (u64, u64) {
        (self.heard_bytes, self.sent_bytes)
    }

    /// Whether the wheels are driven, resets, and breaches of the safety rules.
    pub(crate) fn conduct(&self) -> (bool, u32, u32) {
        (
            self.robot.wheels_driven(),
            self.robot.resets(),
            self.robot.monitor().count(),
        )
    }
}
