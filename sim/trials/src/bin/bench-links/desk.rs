//! A robot with its real firmware at one end of a link, and a host that only implements the protocol at the other.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, bail};
use home::{Home, Noise, Pose, RobotModel, World};
use pic32::board::serial::HostRate;
use pic32::board::{Blueprint, BoardLink, CYCLES_PER_MS, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::image::Image;
use rvac_channel::Pcg32;
use rvac_protocol::PacketBuffer;
use rvac_protocol::frame::{SEPARATOR, SEPARATOR_2016};
use rvac_protocol::message::{BinaryKinds, Command, Drive, Info, Parameter, Report, Sequence};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{AngularSpeed, Speed, Tick};

use crate::bus::ClockedBus;
use crate::measured::{LEASE_MS, Measured, STATE_MS};
use crate::wire::{BAUD, LinkKind, NOISE, Wire};

const SEED: u64 = 41;
/// How often the host looks at the attention line: a tenth of a millisecond.
const LOOK_CYCLES: u64 = CYCLES_PER_MS / 10;
/// How long the handshake may take.
const CONNECT_MS: u64 = 5_000;
/// Time for the first reports, and for what is under way to arrive.
const SETTLE_MS: u64 = 500;
/// Between two reports of slow facts; setting it is the question whose answer is timed.
const INFO_MS: i32 = 1_000;
/// How often a motion command is renewed.
const RENEW_MS: u64 = 50;
/// A question whose answer is timed.
const QUESTION_MS: u64 = 100;
/// The cable stays out for longer than that.
const CUT_MS: u32 = 1_500;
/// How long the host asks for states as fast as they come, how many it has asked for at once, and how long it waits for them.
const ASKED_MS: u64 = 2_000;
const ASKED_AT_ONCE: u64 = 3;
const PATIENCE_MS: u64 = 100;
/// Packets of the robot that may still be under way.
const RECENT_PACKETS: usize = 400;
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
pub(crate) struct Trial {
    blueprint: Blueprint,
    home: Arc<Home>,
    model: RobotModel,
}

impl Trial {
    /// Reads the firmware and the home.
    pub(crate) fn open(firmware: &Path, link: BoardLink, home: &Path) -> anyhow::Result<Self> {
        let named = || format!("the firmware {}", firmware.display());
        let image = Image::from_elf(&std::fs::read(firmware).with_context(named)?).with_context(named)?;
        let model = RobotModel::by_name("sr8730")?;
        Ok(Self {
            blueprint: Blueprint::sr8730(image, &CalibrationChoice::Complete)?.linked_by(link)?,
            home: Arc::new(Home::load(home, &model)?),
            model,
        })
    }

    /// Measures one link.
    pub(crate) fn measure(&self, kind: LinkKind, seconds: u64, cuts: u32) -> anyhow::Result<Measured> {
        let world = World::new(
            Arc::clone(&self.home),
            &self.model,
            &Noise::ideal(),
            1,
            Some(START),
        );
        let settings = EmulatedSettings {
            rate: HostRate::exact(BAUD),
            ..EmulatedSettings::default()
        };
        let mut desk = Desk::new(EmulatedRobot::new(&self.blueprint, world, &settings), kind);
        desk.connect()?;
        let half_ms = seconds * 500;
        let mut measured = Measured {
            kind: kind.name(),
            seconds,
            cuts,
            ..Measured::default()
        };
        desk.measure_quiet(half_ms, &mut measured)?;
        measured.telemetry_max_hz = desk.ask_for_states();
        desk.make_noisy();
        desk.circle_ms(half_ms);
        measured.wrong_packets = desk.wrong + u64::from(desk.robot.monitor().count());
        desk.make_quiet(kind);
        desk.pass_ms(SETTLE_MS);
        measured.stands_ms = desk.cut(cuts)?;
        Ok(measured)
    }
}

/// A robot, a link, a host.
#[derive(Debug)]
struct Desk {
    robot: EmulatedRobot,
    wire: Wire,
    /// In place of the wire, where the host clocks.
    bus: Option<ClockedBus>,
    session: HostSession,
    packet: PacketBuffer,
    from_robot: Vec<u8>,
    to_send: Vec<u8>,
    info: Option<Info>,
    states: u64,
    /// When the motion is to be renewed, and when the next question is due.
    renew_ms: u64,
    ask_ms: u64,
    asked: Vec<(Sequence, u64)>,
    answered_ms: Vec<u64>,
    /// Packets as the robot sent them, newest last, and the one that it is sending.
    sent: VecDeque<Vec<u8>>,
    sending: Vec<u8>,
    /// The packet that the host is hearing.
    hearing: Vec<u8>,
    wrong: u64,
}

impl Desk {
    fn new(mut robot: EmulatedRobot, kind: LinkKind) -> Self {
        Self {
            bus: ClockedBus::open(kind, &mut robot),
            robot,
            wire: Wire::new(kind, SEED),
            session: HostSession::new(BinaryKinds::ALL, Tick(0)),
            packet: PacketBuffer::new(),
            from_robot: Vec::new(),
            to_send: Vec::new(),
            info: None,
            states: 0,
            renew_ms: 0,
            ask_ms: RENEW_MS / 2,
            asked: Vec::new(),
            answered_ms: Vec::new(),
            sent: VecDeque::new(),
            sending: Vec::new(),
            hearing: Vec::new(),
            wrong: 0,
        }
    }

    fn make_noisy(&mut self) {
        self.wire.make_noisy(SEED);
        if let Some(bus) = &mut self.bus {
            bus.make_noisy(SEED, NOISE);
        }
    }

    fn make_quiet(&mut self, kind: LinkKind) {
        self.wire = Wire::new(kind, SEED);
        if let Some(bus) = &mut self.bus {
            bus.make_quiet();
        }
    }

    fn now_ms(&self) -> u64 {
        self.robot.machine().cycle() / CYCLES_PER_MS
    }

    fn now(&self) -> Tick {
        Tick(self.now_ms() as u32)
    }

    /// One millisecond; where the host clocks, as many as the transfer takes that ends last.
    fn tick(&mut self) {
        match self.bus.take() {
            None => self.tick_of_wire(),
            Some(mut bus) => {
                self.tick_of_bus(&mut bus);
                self.bus = Some(bus);
            }
        }
    }

    fn tick_of_bus(&mut self, bus: &mut ClockedBus) {
        let end = (self.now_ms() + 1) * CYCLES_PER_MS;
        while self.robot.machine().cycle() < end {
            while let Some(event) = self.session.poll(self.now()) {
                self.note(event);
            }
            while self.session.next_packet(&mut self.packet) {
                self.to_send.extend_from_slice(self.packet.as_bytes());
            }
            bus.send(&self.to_send);
            self.to_send.clear();
            let cycle = self.robot.machine().cycle();
            let due = bus.due(&self.robot);
            if due > cycle {
                // The attention line may rise meanwhile.
                let next = due.min(end).min(cycle + LOOK_CYCLES);
                self.robot.advance_to(next, &mut Vec::new());
                continue;
            }
            let mut heard = Vec::new();
            bus.turn(&mut self.robot, &mut heard);
            self.remember(&bus.take_said());
            for byte in heard {
                self.hear(byte);
            }
        }
    }

    fn tick_of_wire(&mut self) {
        let mut from_robot = std::mem::take(&mut self.from_robot);
        from_robot.clear();
        self.robot.tick(&mut from_robot);
        let now_ms = self.now_ms();
        self.remember(&from_robot);
        let heard = self.wire.carry_up(now_ms, &from_robot);
        self.from_robot = from_robot;
        for byte in heard {
            self.hear(byte);
        }
        while let Some(event) = self.session.poll(self.now()) {
            self.note(event);
        }
        while self.session.next_packet(&mut self.packet) {
            self.to_send.extend_from_slice(self.packet.as_bytes());
        }
        let to_send = std::mem::take(&mut self.to_send);
        let arrived = self.wire.carry_down(now_ms, &to_send);
        self.robot.send(&arrived);
    }

    /// Keeps what the robot really sent, packet by packet.
    fn remember(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if *byte != SEPARATOR {
                push_unless_empty(&mut self.sending, *byte);
                continue;
            }
            self.sent.push_back(std::mem::take(&mut self.sending));
            if self.sent.len() > RECENT_PACKETS {
                self.sent.pop_front();
            }
        }
    }

    fn hear(&mut self, byte: u8) {
        let event = self.session.receive(byte, self.now());
        if let Some(event) = event {
            let is_true = self.sent.iter().any(|packet| *packet == self.hearing);
            if matches!(event, HostEvent::Report(_)) && !is_true {
                self.wrong += 1;
            }
            self.note(event);
        }
        if byte == SEPARATOR || byte == SEPARATOR_2016 {
            self.hearing.clear();
        } else {
            push_unless_empty(&mut self.hearing, byte);
        }
    }

    fn note(&mut self, event: HostEvent) {
        match event {
            HostEvent::Report(Report::Info(info)) => self.info = Some(info),
            HostEvent::Report(Report::State(_)) => self.states += 1,
            HostEvent::Answered {
                sequence: Some(number),
                ..
            } => {
                if let Some(place) = self.asked.iter().position(|(asked, _)| *asked == number) {
                    let (_, asked_ms) = self.asked.swap_remove(place);
                    self.answered_ms.push(self.now_ms() - asked_ms);
                }
            }
            _ => {}
        }
    }

    /// Sends a command; one that the session does not take now is left out.
    fn send(&mut self, command: Command) -> Option<Sequence> {
        let sent = self.session.send(command, self.now(), &mut self.packet);
        self.to_send.extend_from_slice(self.packet.as_bytes());
        sent.ok().flatten()
    }

    fn pass_ms(&mut self, ms: u64) {
        let end = self.now_ms() + ms;
        while self.now_ms() < end {
            self.tick();
        }
    }

    fn connect(&mut self) -> anyhow::Result<()> {
        let end = self.now_ms() + CONNECT_MS;
        while !self.session.is_open() {
            if self.now_ms() >= end {
                bail!("the robot did not open a session within {CONNECT_MS} ms");
            }
            self.tick();
        }
        self.send(Command::Set {
            sequence: Sequence(0),
            parameter: Parameter::StatePeriod,
            value: STATE_MS,
        });
        self.pass_ms(SETTLE_MS);
        self.arm();
        Ok(())
    }

    fn arm(&mut self) {
        self.send(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
        self.pass_ms(SETTLE_MS);
    }

    /// Drives in circles for so long, and asks something now and then.
    fn circle_ms(&mut self, ms: u64) {
        let end = self.now_ms() + ms;
        while self.now_ms() < end {
            let now_ms = self.now_ms();
            if now_ms >= self.renew_ms {
                self.renew_ms = now_ms + RENEW_MS;
                self.send(Command::Drive(CIRCLE));
            }
            if now_ms >= self.ask_ms {
                self.ask_ms = now_ms + QUESTION_MS;
                let asked = self.send(Command::Set {
                    sequence: Sequence(0),
                    parameter: Parameter::InfoPeriod,
                    value: INFO_MS,
                });
                self.asked.extend(asked.map(|number| (number, now_ms)));
            }
            self.tick();
        }
    }

    /// What is lost and late on a link without damage.
    fn measure_quiet(&mut self, ms: u64, measured: &mut Measured) -> anyhow::Result<()> {
        let robot_before = self.ask_info()?.link;
        let host_before = self.session.counters();
        let states_before = self.states;
        self.robot.machine_mut().restart_accounting();
        self.circle_ms(ms);
        let cycle = self.robot.machine().cycle();
        measured.cpu_percent = 100.0 * (1.0 - self.robot.machine().accounting().idle_share(cycle));
        measured.telemetry_hz = (self.states - states_before) as f64 * 1e3 / ms as f64;
        if !self.robot.wheels_driven() {
            bail!("{}: the robot should drive", measured.kind);
        }
        self.pass_ms(SETTLE_MS);
        let lost = |link: rvac_protocol::message::LinkCounters| {
            u64::from(link.bad_crc + link.overrun + link.framing + link.malformed)
        };
        let robot_after = self.ask_info()?.link;
        measured.lost_bytes = lost(robot_after) - lost(robot_before) + lost(self.session.counters())
            - lost(host_before)
            + self.asked.len() as u64;
        self.answered_ms.sort_unstable();
        let place = self.answered_ms.len() * 99 / 100;
        measured.p99_ms = self.answered_ms.get(place).copied().unwrap_or(u64::MAX);
        Ok(())
    }

    /// States a second that come when they are asked for.
    fn ask_for_states(&mut self) -> f64 {
        let begin_ms = self.now_ms();
        let before = self.states;
        let (mut asked, mut last) = (before, (before, begin_ms));
        while self.now_ms() < begin_ms + ASKED_MS {
            if self.states != last.0 {
                last = (self.states, self.now_ms());
            } else if self.now_ms() > last.1 + PATIENCE_MS {
                asked = self.states;
                last.1 = self.now_ms();
            }
            // States that come by themselves count as well.
            asked = asked.max(self.states);
            if asked < self.states + ASKED_AT_ONCE {
                self.send(Command::State);
                asked += 1;
            }
            self.tick();
        }
        let states = (self.states - before) as f64 * 1e3 / (self.now_ms() - begin_ms) as f64;
        self.pass_ms(SETTLE_MS);
        states
    }

    fn ask_info(&mut self) -> anyhow::Result<Info> {
        self.info = None;
        self.send(Command::Info);
        let end = self.now_ms() + 2_000;
        while self.now_ms() < end {
            self.tick();
            if let Some(info) = self.info.take() {
                return Ok(info);
            }
        }
        bail!("the robot did not tell its slow facts within two seconds")
    }

    /// The cable comes out at moments drawn from a seed; gives the longest time until the wheels were not driven.
    fn cut(&mut self, cuts: u32) -> anyhow::Result<u64> {
        let mut random = Pcg32::new(SEED);
        let mut longest_ms = 0;
        for _ in 0..cuts {
            self.arm();
            self.circle_ms(500 + u64::from(random.below(200)));
            if !self.robot.wheels_driven() {
                bail!("the robot should drive before the cable comes out");
            }
            self.robot.cut_line(CUT_MS);
            let begin_ms = self.now_ms();
            if let Some(bus) = &mut self.bus {
                // At any bit of a transfer.
                let from = begin_ms * CYCLES_PER_MS + u64::from(random.below(CYCLES_PER_MS as u32));
                bus.cut(from, from + u64::from(CUT_MS) * CYCLES_PER_MS);
            }
            let mut driven_ms = begin_ms;
            while self.now_ms() < begin_ms + u64::from(CUT_MS) {
                // A host that does not know goes on.
                self.circle_ms(1);
                if self.robot.wheels_driven() {
                    driven_ms = self.now_ms();
                }
            }
            longest_ms = longest_ms.max(driven_ms - begin_ms);
            self.pass_ms(4 * SETTLE_MS);
        }
        Ok(longest_ms)
    }
}

/// A robot on I2C that is asked for more than waits, because noise was on the number, answers so. No packet begins with it.
const EMPTY: u8 = 0;

fn push_unless_empty(packet: &mut Vec<u8>, byte: u8) {
    if byte != EMPTY || !packet.is_empty() {
        packet.push(byte);
    }
}
