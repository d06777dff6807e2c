//! How the Relax's firmware keeps up: `relax-pace FILE.ihx LOOP [--seconds N]`, LOOP being the hexadecimal address of the
//! function that is one pass of the main loop.
//!
//! With `--corrupted N` the host sends so many damaged packets of motion instead, after it has armed, and none that is sound:
//! each millisecond in which a motor is on is a wrong actuation. A sound one at the end shows that the robot was ready all along.
//!
//! A host connects over the serial line, arms, drives the robot to and fro and lets it clean, for so many simulated seconds.
//! Prints one JSON object: passes a second at rest and while driving, the deepest stack, bytes lost, telemetry.

use home::{Home, Noise, Pose, RobotModel, World};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Motor, MotorCommand, Report, Sequence};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use stc90::board::{EmulatedRelax, Motor as RelaxMotor, RelaxBlueprint, RelaxSettings};
use stc90::image::Image;
use std::sync::Arc;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Milliseconds before anybody speaks.
const REST_MS: u64 = 1_000;
/// A drive and the motors are renewed so often.
const DRIVE_MS: u64 = 50;
const CLEAN_MS: u64 = 300;
/// Ahead and back again.
const LEG_MS: u64 = 1_500;
const SECONDS: u64 = 20;
/// What arming and the first motion take at most.
const ARMING_MS: u64 = 200;
/// And what a full line holds.
const LINE_MS: u64 = 1_200;
/// The driver of the host has room for so many bytes before the next damaged packet: the line stays busy, and answers in time.
const LINE_ROOM: usize = 3_900;
const PLAN: &str = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";

/// A robot and its host.
struct Pair {
    robot: EmulatedRelax,
    host: HostSession,
    is_armed: bool,
    states: u64,
    refused: u64,
    /// Bad packets when the session had just begun: one of before may be among them.
    bad_before: u32,
    is_told: bool,
    /// It is armed, but nothing is commanded.
    is_quiet: bool,
    seed: u64,
}

fn main() -> Outcome<()> {
    let mut words = std::env::args().skip(1);
    let file = words.next().ok_or("name the HEX file of the firmware")?;
    let pass = words.next().ok_or("name the address of the main loop")?;
    let pass = u16::from_str_radix(&pass, 16)?;
    let mut seconds = SECONDS;
    let mut is_told = false;
    let mut corrupted = 0;
    while let Some(word) = words.next() {
        match word.as_str() {
            "--seconds" => seconds = words.next().ok_or("how many seconds?")?.parse()?,
            "--corrupted" => corrupted = words.next().ok_or("how many packets?")?.parse()?,
            "--tell" => is_told = true,
            other => return Err(format!("{other} is unknown").into()),
        }
    }
    let mut pair = Pair::new(&file, is_told)?;
    let idle_hz = pair.rest(pass);
    if corrupted > 0 {
        return pair.corrupt(corrupted);
    }
    let driving_hz = pair.drive(seconds);
    if is_told {
        eprintln!("{:?}", pair.robot.monitor().violations().first());
    }
    let machine = pair.robot.machine();
    println!(
        "{{\"main_loop_idle_hz\": {idle_hz:.0}, \"main_loop_driving_hz\": {driving_hz:.0}, \"stack_to\": {}, \
         \"bytes_overrun\": {}, \"host_bad_packets\": {}, \"states_per_s\": {:.1}, \"refused\": {}, \"resets\": {}, \
         \"violations\": {}, \"bridge_shorts\": {}, \"misuses\": {}, \"is_armed\": {}}}",
        machine.cpu().sp_max(),
        machine.overruns(),
        pair.bad_packets() - pair.bad_before,
        pair.states as f64 / seconds as f64,
        pair.refused,
        pair.robot.resets(),
        pair.robot.monitor().violations().len(),
        pair.robot.short_cycles(),
        machine.misuses().len(),
        pair.is_armed
    );
    Ok(())
}

impl Pair {
    fn new(file: &str, is_told: bool) -> Outcome<Self> {
        let image = Image::from_hex(&std::fs::read_to_string(file)?)?;
        let model = RobotModel::by_name("relax")?;
        let home = Arc::new(Home::from_floorplan("room", PLAN, &model)?);
        let pose = home.file_from_plan().inverse().then(Pose::new(2.0, 1.5, 0.0));
        let world = World::new(home, &model, &Noise::ideal(), 1, Some(pose));
        let robot = EmulatedRelax::new(&RelaxBlueprint::new(image)?, world, &RelaxSettings::default());
        let kinds = BinaryKinds {
            state: true,
            drive: true,
        };
        Ok(Self {
            robot,
            host: HostSession::new(kinds, Tick(0)),
            is_armed: false,
            states: 0,
            refused: 0,
            bad_before: 0,
            is_told,
            is_quiet: false,
            seed: 33,
        })
    }

    /// Packets that the host did not understand.
    fn bad_packets(&self) -> u32 {
        let counters = self.host.counters();
        counters.bad_crc + counters.malformed + counters.framing
    }

    fn now(&self) -> Tick {
        Tick(self.robot.now_ms() as u32)
    }

    /// Passes a second with nobody at the other end.
    fn rest(&mut self, pass: u16) -> f64 {
        let mut heard = Vec::new();
        self.robot.machine_mut().cpu_mut().count_passes(pass);
        for _ in 0..REST_MS {
            self.robot.tick(&mut heard);
        }
        self.robot.machine().cpu().passes() as f64 * 1e3 / REST_MS as f64
    }

    /// Passes a second with a host that drives, while telemetry comes.
    fn drive(&mut self, seconds: u64) -> f64 {
        let before = self.robot.machine().cpu().passes();
        let end = self.robot.now_ms() + seconds * 1_000;
        while self.robot.now_ms() < end {
            self.step();
        }
        (self.robot.machine().cpu().passes() - before) as f64 / seconds as f64
    }

    /// Sends damaged packets of motion to an armed robot, and at the end a sound one.
    fn corrupt(&mut self, packets: u64) -> Outcome<()> {
        self.is_quiet = true;
        while !self.is_armed {
            self.step();
        }
        (0..ARMING_MS).for_each(|_| self.step());
        let (mut wrong_ms, mut sent) = (0_u64, 0);
        while sent < packets {
            if self.robot.line_room() > LINE_ROOM {
                let packet = self.damaged();
                self.robot.send(&packet);
                sent += 1;
            }
            self.step();
            wrong_ms += u64::from(self.is_moved());
        }
        (0..LINE_MS).for_each(|_| self.step());
        self.send(ahead(0.1));
        (0..ARMING_MS).for_each(|_| self.step());
        println!(
            "{{\"corrupted\": {packets}, \"wrong_actuation_ms\": {wrong_ms}, \"sound_one_moves\": {}, \"resets\": {}, \
             \"violations\": {}, \"bytes_overrun\": {}}}",
            self.is_moved(),
            self.robot.resets(),
            self.robot.monitor().violations().len(),
            self.robot.machine().overruns()
        );
        Ok(())
    }

    fn is_moved(&self) -> bool {
        [
            RelaxMotor::WheelLeft,
            RelaxMotor::WheelRight,
            RelaxMotor::Brush,
            RelaxMotor::Suction,
        ]
        .into_iter()
        .any(|motor| self.robot.duty(motor) != 0.0)
    }

    /// A sound packet of motion with one to eight bits flipped.
    fn damaged(&mut self) -> Vec<u8> {
        let command = if self.random(2) == 0 {
            ahead(0.15)
        } else {
            clean(Motor::BrushMain)
        };
        let mut buffer = PacketBuffer::new();
        let now = self.now();
        self.host.send(command, now, &mut buffer).ok();
        let sound = buffer.as_bytes().to_vec();
        let mut packet = sound.clone();
        while packet == sound {
            for _ in 0..=self.random(8) {
                let at = self.random(packet.len().max(2) - 1);
                packet[at] ^= 1 << self.random(8);
            }
        }
        packet
    }

    /// Below `bound` (xorshift).
    fn random(&mut self, bound: usize) -> usize {
        self.seed ^= self.seed << 13;
        self.seed ^= self.seed >> 7;
        self.seed ^= self.seed << 17;
        (self.seed % bound.max(1) as u64) as usize
    }

    fn step(&mut self) {
        let mut heard = Vec::new();
        self.robot.tick(&mut heard);
        let now = self.now();
        for byte in heard {
            if let Some(event) = self.host.receive(byte, now) {
                self.take(event);
            }
        }
        if let Some(event) = self.host.poll(now) {
            self.take(event);
        }
        if self.is_armed && !self.is_quiet {
            self.command();
        }
        let mut packet = PacketBuffer::new();
        while self.host.next_packet(&mut packet) {
            self.robot.send(packet.as_bytes());
        }
    }

    fn take(&mut self, event: HostEvent) {
        if self.is_told && !matches!(event, HostEvent::Report(Report::State(_))) {
            eprintln!("{} {event:?}", self.robot.now_ms());
        }
        match event {
            HostEvent::Described(_) => {
                self.send(Command::Arm {
                    sequence: Sequence(0),
                    undock: false,
                });
                self.is_armed = true;
                self.bad_before = self.bad_packets();
            }
            HostEvent::Closed(_) | HostEvent::Silent => self.is_armed = false,
            HostEvent::Report(Report::State(_)) => self.states += 1,
            HostEvent::Answered { refusal: Some(_), .. } => self.refused += 1,
            _ => {}
        }
    }

    fn send(&mut self, command: Command) {
        let mut packet = PacketBuffer::new();
        let now = self.now();
        if self.host.send(command, now, &mut packet).is_ok() {
            self.robot.send(packet.as_bytes());
        }
    }

    fn command(&mut self) {
        let ms = self.robot.now_ms();
        if ms.is_multiple_of(DRIVE_MS) {
            let is_back = ms / LEG_MS % 2 == 1;
            let speed = if is_back { -0.15 } else { 0.15 };
            self.send(ahead(speed));
        }
        if ms.is_multiple_of(CLEAN_MS) {
            for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
                self.send(clean(motor));
            }
        }
    }
}

fn ahead(speed_m_per_s: f64) -> Command {
    Command::Drive(Drive {
        speed: Speed::from_m_per_s(speed_m_per_s),
        turn: AngularSpeed::from_rad_per_s(0.3),
        lease_ms: 250,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}

fn clean(motor: Motor) -> Command {
    Command::Motor(MotorCommand {
        motor,
        throttle: Throttle::FULL,
        lease_ms: 1_000,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}
