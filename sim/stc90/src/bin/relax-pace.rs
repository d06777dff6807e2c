//! How the Relax's firmware keeps up: `relax-pace FILE.ihx LOOP [--seconds N]`, LOOP being the hexadecimal address of the
//! function that is one pass of the main loop.
//!
//! A host connects over the serial line, arms, drives the robot to and fro and lets it clean, for so many simulated seconds.
//! Prints one JSON object: passes a second at rest and while driving, the deepest stack, bytes lost, telemetry.

use home::{Home, Noise, Pose, RobotModel, World};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Motor, MotorCommand, Report, Sequence};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use stc90::board::{EmulatedRelax, RelaxBlueprint, RelaxSettings};
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
}

fn main() -> Outcome<()> {
    let mut words = std::env::args().skip(1);
    let file = words.next().ok_or("name the HEX file of the firmware")?;
    let pass = words.next().ok_or("name the address of the main loop")?;
    let pass = u16::from_str_radix(&pass, 16)?;
    let mut seconds = SECONDS;
    let mut is_told = false;
    while let Some(word) = words.next() {
        match word.as_str() {
            "--seconds" => seconds = words.next().ok_or("how many seconds?")?.parse()?,
            "--tell" => is_told = true,
            other => return Err(format!("{other} is unknown").into()),
        }
    }
    let mut pair = Pair::new(&file, is_told)?;
    let idle_hz = pair.rest(pass);
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
        if self.is_armed {
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
            self.send(Command::Drive(Drive {
                speed: Speed::from_m_per_s(speed),
                turn: AngularSpeed::from_rad_per_s(0.3),
                lease_ms: 250,
                sequence: Sequence(0),
                seen_tick: Tick(0),
            }));
        }
        if ms.is_multiple_of(CLEAN_MS) {
            for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
                self.send(Command::Motor(MotorCommand {
                    motor,
                    throttle: Throttle::FULL,
                    lease_ms: 1_000,
                    sequence: Sequence(0),
                    seen_tick: Tick(0),
                }));
            }
        }
    }
}
