//! A cord with wheels that follow their duty, a host, and a line of 38,400 baud between the two, on a virtual clock.

use cord_c::host::{HostedCord, from_hex, hex};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Command, Drive, Inhibits, Motor, MotorCommand, Refusal, Report, Sequence,
};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use std::collections::VecDeque;

/// Bytes of a millisecond.
const LINE_BYTES: usize = 4;
/// A count of the encoders, and what the motors reach, in metres and metres a second.
const COUNT_M: f64 = 0.005;
const FREE_SPEED_M_PER_S: f64 = 0.38;
const DEAD_BAND: f64 = 0.1;
/// Share of the way to its speed that a rim makes in a millisecond.
const LAG: f64 = 0.02;
const RENEW_MS: u32 = 30;
const CLEANERS_MS: u32 = 300;

/// What a cord senses in a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Senses {
    /// Encoder counts of both wheels, forward positive.
    pub(crate) counts: [i32; 2],
    pub(crate) bumpers: [bool; 2],
    pub(crate) cliff: bool,
    pub(crate) hangs: bool,
}

/// What a cord does in a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Actuation {
    /// Of both wheels, -1..=1.
    pub(crate) duty: [f64; 2],
    /// Brush, and suction with side brush.
    pub(crate) cleaners: [bool; 2],
}

impl Actuation {
    /// Which way each motor turns: left and right wheel, brush, suction.
    pub(crate) fn signs(&self) -> [i8; 4] {
        let sign = |duty: f64| i8::from(duty > 0.0) - i8::from(duty < 0.0);
        let [left, right] = self.duty.map(sign);
        let [brush, suction] = self.cleaners.map(i8::from);
        [left, right, brush, suction]
    }
}

/// A cord, in whichever language.
pub(crate) trait SimulatedCord {
    /// A millisecond; gives the bytes for the host as well.
    fn millisecond(&mut self, senses: &Senses, bytes: &[u8]) -> (Actuation, Vec<u8>);
}

impl SimulatedCord for HostedCord {
    fn millisecond(&mut self, senses: &Senses, bytes: &[u8]) -> (Actuation, Vec<u8>) {
        // Bits of board.h.
        let contacts = u8::from(senses.bumpers[0])
            | u8::from(senses.bumpers[1]) << 1
            | u8::from(senses.cliff) << 3
            | u8::from(senses.hangs) << 5;
        let [left, right] = senses.counts.map(i32::unsigned_abs);
        let line = format!("S {contacts} 0 0 {left} {right} {}", hex(bytes));
        let answer = self.ask(&[line]).expect("no sanitizer complains").remove(0);
        let words: Vec<&str> = answer.split(' ').collect();
        let number = |at: usize| words[at].parse::<i32>().expect("a number");
        let cleaners = number(2);
        let actuation = Actuation {
            duty: [0, 1].map(|side| f64::from(number(side)) / 255.0),
            cleaners: [cleaners & 4 != 0, cleaners & 8 != 0],
        };
        (actuation, from_hex(words[3]))
    }
}

/// The bench.
pub(crate) struct SessionBench<C> {
    cord: C,
    host: HostSession,
    line: VecDeque<u8>,
    rims_m_per_s: [f64; 2],
    distances_m: [f64; 2],
    shown: [i32; 2],
    pub(crate) senses: Senses,
    pub(crate) actuation: Actuation,
    pub(crate) drive: Option<(Speed, AngularSpeed)>,
    pub(crate) cleans: bool,
    pub(crate) is_silent: bool,
    pub(crate) is_described: bool,
    pub(crate) inhibits: Inhibits,
    pub(crate) refusals: Vec<Refusal>,
    now_ms: u32,
}

impl<C: SimulatedCord> SessionBench<C> {
    pub(crate) fn new(cord: C) -> Self {
        let kinds = BinaryKinds {
            state: true,
            drive: true,
        };
        Self {
            cord,
            host: HostSession::new(kinds, Tick(0)),
            line: VecDeque::new(),
            rims_m_per_s: [0.0; 2],
            distances_m: [0.0; 2],
            shown: [0; 2],
            senses: Senses::default(),
            actuation: Actuation::default(),
            drive: None,
            cleans: false,
            is_silent: false,
            is_described: false,
            inhibits: Inhibits::NONE,
            refusals: Vec::new(),
            now_ms: 0,
        }
    }

    pub(crate) fn tick(&mut self) {
        self.now_ms += 1;
        let now = Tick(self.now_ms);
        self.turn_wheels();
        self.renew();
        while let Some(event) = self.host.poll(now) {
            self.take(&event);
        }
        let mut packet = PacketBuffer::new();
        while self.host.next_packet(&mut packet) {
            self.deliver(packet.as_bytes());
        }
        let bytes: Vec<u8> = (0..LINE_BYTES).filter_map(|_| self.line.pop_front()).collect();
        let (actuation, heard) = self.cord.millisecond(&self.senses, &bytes);
        self.actuation = actuation;
        for byte in heard {
            if let Some(event) = self.host.receive(byte, now) {
                self.take(&event);
            }
        }
    }

    fn turn_wheels(&mut self) {
        for side in 0..2 {
            let duty = self.actuation.duty[side];
            let drive = (duty.abs() - DEAD_BAND).max(0.0) / (1.0 - DEAD_BAND) * duty.signum();
            let rim = &mut self.rims_m_per_s[side];
            *rim += (drive * FREE_SPEED_M_PER_S - *rim) * LAG;
            self.distances_m[side] += *rim * 1e-3;
            let total = (self.distances_m[side] / COUNT_M).floor() as i32;
            self.senses.counts[side] = total - self.shown[side];
            self.shown[side] = total;
        }
    }

    fn renew(&mut self) {
        if self.now_ms.is_multiple_of(RENEW_MS)
            && let Some((speed, turn)) = self.drive
        {
            self.say(Command::Drive(Drive {
                speed,
                turn,
                lease_ms: 120,
                sequence: Sequence(0),
                seen_tick: Tick(0),
            }));
        }
        if self.cleans && self.now_ms.is_multiple_of(CLEANERS_MS) {
            for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
                self.say(Command::Motor(MotorCommand {
                    motor,
                    throttle: Throttle::FULL,
                    lease_ms: 1_000,
                    sequence: Sequence(0),
                    seen_tick: Tick(0),
                }));
            }
        }
    }

    pub(crate) fn say(&mut self, command: Command) {
        let mut packet = PacketBuffer::new();
        if self.host.send(command, Tick(self.now_ms), &mut packet).is_ok() {
            self.deliver(packet.as_bytes());
        }
    }

    pub(crate) fn type_in(&mut self, text: &str) {
        self.line.extend(text.bytes().chain([0x1F]));
    }

    fn deliver(&mut self, bytes: &[u8]) {
        if !self.is_silent {
            self.line.extend(bytes);
        }
    }

    fn take(&mut self, event: &HostEvent) {
        match event {
            HostEvent::Described(_) => self.is_described = true,
            HostEvent::Closed(_) | HostEvent::Silent => self.is_described = false,
            HostEvent::Report(Report::State(state)) => self.inhibits = state.inhibits,
            HostEvent::Answered {
                refusal: Some(refusal),
                ..
            } => self.refusals.push(*refusal),
            _ => {}
        }
    }
}
