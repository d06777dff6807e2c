//! What reading a packet costs: time, and instructions counted by callgrind.

use std::hint::black_box;
use std::process::Command as Process;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use rvac_channel::switched_on;
use rvac_protocol::PacketBuffer;
use rvac_protocol::binary::{read_drive, write_drive, write_drive_with_crc};
use rvac_protocol::crc::{Digest, Direction, from_hex};
use rvac_protocol::message::{Command, Drive, Motor, MotorCommand, Sequence};
use rvac_protocol::session::RobotSession;
use rvac_protocol::text::{Form, read_command, write_command, write_command_with_crc};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use serde::{Deserialize, Serialize};

use crate::corruption::open_robot;

/// The motor packet of 2016, 50 bytes.
const MOTOR_2016: &[u8] = br#"{"c":"motor","motor":"wheel left","throttle":0.75}"#;
const NOW: Tick = Tick(81_234);
const SESSION: u16 = 0x2A5C;
/// Packets that are read in turn. Their numbers are this many steps apart on the circle, so each is newer than the last.
const PACKETS: u16 = 64;
const TIMED: u64 = 300_000;
const COUNTED_FEW: u64 = 1_000;
const COUNTED_MANY: u64 = 11_000;

/// What is measured.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MeasuredReader {
    Motor2016,
    Motor2016Serde,
    Motor2016Session,
    MotorText,
    MotorSerde,
    MotorSession,
    DriveText,
    DriveSerde,
    DriveBinary,
    DriveTextSession,
    DriveBinarySession,
}

impl MeasuredReader {
    const ALL: [Self; 11] = [
        Self::Motor2016,
        Self::Motor2016Serde,
        Self::Motor2016Session,
        Self::MotorText,
        Self::MotorSerde,
        Self::MotorSession,
        Self::DriveText,
        Self::DriveSerde,
        Self::DriveBinary,
        Self::DriveTextSession,
        Self::DriveBinarySession,
    ];

    const fn name(self) -> &'static str {
        match self {
            Self::Motor2016 => "motor-2016",
            Self::Motor2016Serde => "motor-2016-serde-json",
            Self::Motor2016Session => "motor-2016-session",
            Self::MotorText => "motor-text",
            Self::MotorSerde => "motor-serde-json",
            Self::MotorSession => "motor-text-session",
            Self::DriveText => "drive-text",
            Self::DriveSerde => "drive-serde-json",
            Self::DriveBinary => "drive-binary",
            Self::DriveTextSession => "drive-text-session",
            Self::DriveBinarySession => "drive-binary-session",
        }
    }

    const fn meaning(self) -> &'static str {
        match self {
            Self::Motor2016 => "50-byte motor packet of 2016 in memory: CRC checked, parsed, ranges checked",
            Self::Motor2016Serde => "the same JSON by serde_json into a struct, no CRC",
            Self::Motor2016Session => "the same byte by byte through a session in hand mode, with its CRC",
            Self::MotorText => {
                "motor packet with ttl, n and t in memory: CRC checked, parsed, ranges checked"
            }
            Self::MotorSerde => "the same JSON by serde_json into a struct, no CRC",
            Self::MotorSession => "the same byte by byte through a robot's session: framing, CRC, freshness",
            Self::DriveText => "drive packet in memory: CRC checked, parsed, ranges checked",
            Self::DriveSerde => "the same JSON by serde_json into a struct, no CRC",
            Self::DriveBinary => "its binary twin in memory: CRC checked, read, ranges checked",
            Self::DriveTextSession => "drive packet byte by byte through a robot's session",
            Self::DriveBinarySession => "its binary twin byte by byte through a robot's session",
        }
    }
}

/// What one packet costs.
#[derive(Debug, Serialize)]
pub(crate) struct Cost {
    reader: &'static str,
    meaning: &'static str,
    bytes: usize,
    ns: f64,
    /// Absent where there is no valgrind.
    instructions: Option<u64>,
}

/// Measures all readers.
pub(crate) fn measure() -> Result<Vec<Cost>> {
    MeasuredReader::ALL.into_iter().map(measure_one).collect()
}

fn measure_one(reader: MeasuredReader) -> Result<Cost> {
    let mut work = MeasuredWork::new(reader);
    work.repeat(TIMED / 10);
    // The best of several runs: on a shared machine the others measure the neighbours.
    let mut best_ns = f64::INFINITY;
    for _ in 0..5 {
        let begin = Instant::now();
        work.repeat(TIMED);
        best_ns = best_ns.min(begin.elapsed().as_secs_f64() * 1e9 / TIMED as f64);
    }
    Ok(Cost {
        reader: reader.name(),
        meaning: reader.meaning(),
        bytes: work.packets[0].len(),
        ns: (best_ns * 10.0).round() / 10.0,
        instructions: count_instructions(reader)?,
    })
}

/// Reads a packet `count` times.
pub(crate) fn repeat(reader: &str, count: u64) -> Result<()> {
    let Some(reader) = MeasuredReader::ALL
        .into_iter()
        .find(|known| known.name() == reader)
    else {
        bail!("{reader}: no such reader; the table of costs lists them");
    };
    MeasuredWork::new(reader).repeat(count);
    Ok(())
}

/// Two runs of different length: what is before and after the loop cancels out.
fn count_instructions(reader: MeasuredReader) -> Result<Option<u64>> {
    let (Some(few), Some(many)) = (collected(reader, COUNTED_FEW)?, collected(reader, COUNTED_MANY)?) else {
        return Ok(None);
    };
    Ok(Some((many - few) / (COUNTED_MANY - COUNTED_FEW)))
}

fn collected(reader: MeasuredReader, count: u64) -> Result<Option<u64>> {
    let program = std::env::current_exe().context("cannot find this program to run it under valgrind")?;
    let run = Process::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["repeat", reader.name(), &count.to_string()])
        .output();
    let Ok(output) = run else {
        return Ok(None);
    };
    let text = String::from_utf8_lossy(&output.stderr);
    let collected = text
        .lines()
        .find_map(|line| line.split_once("Collected : "))
        .and_then(|(_, count)| count.trim().parse().ok());
    collected
        .map(Some)
        .with_context(|| format!("valgrind says nothing about collected instructions:\n{text}"))
}

/// Prints the table of costs.
pub(crate) fn print(costs: &[Cost]) {
    println!(
        "{:<24} {:>5} {:>8} {:>12}",
        "reader", "bytes", "ns", "instructions"
    );
    for cost in costs {
        let instructions = cost
            .instructions
            .map_or("no valgrind".to_owned(), |count| count.to_string());
        println!(
            "{:<24} {:>5} {:>8.1} {:>12}  {}",
            cost.reader, cost.bytes, cost.ns, instructions, cost.meaning
        );
    }
}

#[derive(Deserialize)]
struct MotorSerde<'a> {
    c: &'a str,
    motor: &'a str,
    throttle: f64,
    #[serde(default)]
    ttl: u16,
    #[serde(default)]
    n: u16,
    #[serde(default)]
    t: u32,
}

#[derive(Deserialize)]
struct DriveSerde<'a> {
    c: &'a str,
    v: f64,
    w: f64,
    ttl: u16,
    n: u16,
    t: u32,
}

/// Packets and what reads them.
struct MeasuredWork {
    reader: MeasuredReader,
    packets: Vec<Vec<u8>>,
    robot: RobotSession,
    start: Digest,
    next: usize,
}

impl MeasuredWork {
    fn new(reader: MeasuredReader) -> Self {
        let robot = if reader == MeasuredReader::Motor2016Session {
            switched_on(NOW)
        } else {
            open_robot(NOW)
        };
        let packets = (0..PACKETS).map(|index| {
            packet(
                reader,
                Sequence(index * (u16::MAX / PACKETS + 1)),
                robot.session(),
            )
        });
        Self {
            packets: packets.collect(),
            start: Digest::start(Direction::HostToRobot, SESSION),
            reader,
            robot,
            next: 0,
        }
    }

    fn repeat(&mut self, count: u64) {
        for _ in 0..count {
            let packet = &self.packets[self.next];
            self.next = (self.next + 1) % self.packets.len();
            match self.reader {
                MeasuredReader::Motor2016 => read_checked(packet, self.start, Form::Hand { now: NOW }),
                MeasuredReader::MotorText | MeasuredReader::DriveText => {
                    read_checked(packet, self.start, Form::Checked)
                }
                MeasuredReader::Motor2016Serde | MeasuredReader::MotorSerde => read_motor_serde(packet),
                MeasuredReader::DriveSerde => read_drive_serde(packet),
                MeasuredReader::DriveBinary => read_drive_binary(packet, self.start),
                MeasuredReader::Motor2016Session
                | MeasuredReader::MotorSession
                | MeasuredReader::DriveTextSession
                | MeasuredReader::DriveBinarySession => {
                    let mut events = 0;
                    for byte in packet {
                        events += u32::from(self.robot.receive(black_box(*byte), NOW).is_some());
                    }
                    assert_eq!(events, 1, "every packet is carried out");
                }
            }
        }
    }
}

fn packet(reader: MeasuredReader, sequence: Sequence, session: u16) -> Vec<u8> {
    let motor = Command::Motor(MotorCommand {
        motor: Motor::WheelLeft,
        throttle: Throttle::saturating_from_millionths(750_000),
        lease_ms: 250,
        sequence,
        seen_tick: NOW,
    });
    let drive = Drive {
        speed: Speed(250_000),
        turn: AngularSpeed(-125_000),
        lease_ms: 250,
        sequence,
        seen_tick: NOW,
    };
    let mut buffer = PacketBuffer::new();
    let written = match reader {
        MeasuredReader::Motor2016 => return with_text_crc(MOTOR_2016, SESSION),
        MeasuredReader::Motor2016Session => {
            return [with_text_crc(MOTOR_2016, 0).as_slice(), &[0x1F]].concat();
        }
        MeasuredReader::Motor2016Serde => return MOTOR_2016.to_vec(),
        MeasuredReader::DriveBinary => return with_binary_crc(&drive),
        MeasuredReader::MotorText => return with_text_crc(&text(&motor), SESSION),
        MeasuredReader::DriveText => return with_text_crc(&text(&Command::Drive(drive)), SESSION),
        MeasuredReader::MotorSerde => return text(&motor),
        MeasuredReader::DriveSerde => return text(&Command::Drive(drive)),
        MeasuredReader::MotorSession => write_command_with_crc(&motor, session, &mut buffer),
        MeasuredReader::DriveTextSession => {
            write_command_with_crc(&Command::Drive(drive), session, &mut buffer)
        }
        MeasuredReader::DriveBinarySession => write_drive_with_crc(&drive, session, &mut buffer),
    };
    written.expect("the packets of the benchmark are within their ranges");
    buffer.as_bytes().to_vec()
}

fn text(command: &Command) -> Vec<u8> {
    let mut buffer = PacketBuffer::new();
    write_command(command, &mut buffer).expect("the packets of the benchmark are within their ranges");
    buffer.as_bytes().to_vec()
}

fn with_text_crc(text: &[u8], session: u16) -> Vec<u8> {
    let crc = rvac_protocol::crc::packet_crc(Direction::HostToRobot, session, text);
    [text, b"*", &rvac_protocol::crc::to_hex(crc)].concat()
}

fn with_binary_crc(drive: &Drive) -> Vec<u8> {
    let packet = write_drive(drive).expect("the packets of the benchmark are within their ranges");
    let crc = rvac_protocol::crc::packet_crc(Direction::HostToRobot, SESSION, &packet);
    [packet.as_slice(), &crc.to_le_bytes()].concat()
}

fn read_checked(packet: &[u8], start: Digest, form: Form) {
    let (text, digits) = black_box(packet)
        .split_last_chunk::<8>()
        .expect("the packet has a CRC");
    let text = &text[..text.len() - 1];
    let mut digest = start;
    digest.extend(text);
    assert_eq!(from_hex(*digits), Some(digest.crc()), "the CRC is right");
    black_box(read_command(text, form)).expect("the packet is right");
}

fn read_drive_binary(packet: &[u8], start: Digest) {
    let (packet, crc) = black_box(packet)
        .split_last_chunk::<4>()
        .expect("the packet has a CRC");
    let mut digest = start;
    digest.extend(packet);
    assert_eq!(u32::from_le_bytes(*crc), digest.crc(), "the CRC is right");
    black_box(read_drive(&packet[1..])).expect("the packet is right");
}

fn read_motor_serde(packet: &[u8]) {
    let read: MotorSerde<'_> = serde_json::from_slice(black_box(packet)).expect("the packet is right");
    black_box((read.c, read.motor, read.throttle, read.ttl, read.n, read.t));
}

fn read_drive_serde(packet: &[u8]) {
    let read: DriveSerde<'_> = serde_json::from_slice(black_box(packet)).expect("the packet is right");
    black_box((read.c, read.v, read.w, read.ttl, read.n, read.t));
}
