//! What stands between robot and host and changes what they say to each other.

use std::collections::VecDeque;

use home::Pcg;
use rvac_protocol::crc::Direction;
use rvac_protocol::frame::SEPARATOR;
use rvac_protocol::message::{Command, State};
use rvac_units::Tick;

use super::fault::{JUMP_PAUSE_MS, LineFault};
use super::packets::{Content, Packet, PacketReader};

const STREAM: u64 = 0x11F4;

/// Passes all bytes of both directions on, and does to them what the present fault says.
#[derive(Debug)]
pub struct Tamper {
    from_robot: PacketReader,
    to_robot: PacketReader,
    fault: LineFault,
    begun_ms: u64,
    now_ms: u64,
    /// Reports and commands since the fault began.
    reports: u32,
    commands: u32,
    /// The clock of the robot, as it tells it, is off by so much for good.
    shift_ms: u32,
    jumps: u32,
    /// The last report from before the fault.
    before: Option<State>,
    /// Reports that wait, each until its time.
    waiting: VecDeque<(u64, Vec<u8>)>,
    /// Thousandths of a piece of garbage that are due.
    garbage: u32,
    random: Pcg,
}

impl Tamper {
    /// Changes nothing yet; what it makes up later follows from `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            from_robot: PacketReader::new(Direction::RobotToHost),
            to_robot: PacketReader::new(Direction::HostToRobot),
            fault: LineFault::None,
            begun_ms: 0,
            now_ms: 0,
            reports: 0,
            commands: 0,
            shift_ms: 0,
            jumps: 0,
            before: None,
            waiting: VecDeque::new(),
            garbage: 0,
            random: Pcg::new(seed, STREAM),
        }
    }

    /// From now on this is wrong with the line, instead of what was.
    pub fn begin(&mut self, fault: LineFault) {
        self.fault = fault;
        self.begun_ms = self.now_ms;
        (self.reports, self.commands, self.jumps) = (0, 0, 0);
    }

    /// Takes what came from the robot in this millisecond and puts in its place what the host gets.
    pub fn pass_to_host(&mut self, now_ms: u64, bytes: &mut Vec<u8>) {
        self.now_ms = now_ms;
        let mut out = Vec::new();
        self.add_garbage(&mut out);
        for byte in core::mem::take(bytes) {
            if let Some(packet) = self.from_robot.push(byte) {
                self.pass_report(packet, &mut out);
            }
        }
        while let Some((_, late)) = self.waiting.pop_front_if(|(due_ms, _)| *due_ms <= now_ms) {
            out.extend(late);
        }
        *bytes = out;
    }

    /// Takes all complete packets for the robot out of `bytes` and gives what the robot gets.
    pub fn pass_to_robot(&mut self, bytes: &mut Vec<u8>) -> Vec<u8> {
        let mut out = Vec::new();
        for byte in bytes.drain(..) {
            if let Some(packet) = self.to_robot.push(byte) {
                self.pass_command(packet, &mut out);
            }
        }
        out
    }

    fn since_ms(&self) -> u64 {
        self.now_ms - self.begun_ms
    }

    fn add_garbage(&mut self, out: &mut Vec<u8>) {
        let (per_s, is_open) = match self.fault {
            LineFault::Garbage { per_s } => (per_s, false),
            LineFault::OpenGarbage { per_s } => (per_s, true),
            _ => return,
        };
        self.garbage += per_s;
        while self.garbage >= 1_000 {
            self.garbage -= 1_000;
            let length = 1 + self.random.below(8);
            out.extend((0..length).map(|_| 0x20 + self.random.below(0x5F) as u8));
            if !is_open {
                out.push(SEPARATOR);
            }
        }
    }

    fn pass_report(&mut self, packet: Packet, out: &mut Vec<u8>) {
        match packet.content {
            Content::Session(session) => {
                self.from_robot.set_session(session);
                self.to_robot.set_session(session);
                out.extend(packet.bytes);
            }
            Content::State { ref state, .. } => {
                let told = self.told(**state);
                let mut bytes = packet.bytes;
                if told != **state {
                    let Content::State { form, .. } = packet.content else {
                        return;
                    };
                    let state = Box::new(told);
                    bytes = self.from_robot.write(&Content::State { state, form });
                }
                self.reports += 1;
                self.deliver(bytes, out);
            }
            Content::Command { .. } | Content::Other => out.extend(packet.bytes),
        }
    }

    /// What the host is told of a state.
    fn told(&mut self, state: State) -> State {
        let mut told = state;
        match self.fault {
            LineFault::StrayTick { by_ms } if self.reports == 0 => told.tick = shifted(told.tick, by_ms),
            LineFault::ShiftedTicks { by_ms } => told.tick = shifted(told.tick, by_ms),
            LineFault::ClockJump { by_ms, times } => {
                let due = 1 + (self.since_ms() / JUMP_PAUSE_MS).min(u64::from(times) - 1) as u32;
                while self.jumps < due {
                    self.jumps += 1;
                    self.shift_ms = self.shift_ms.wrapping_add_signed(by_ms);
                }
            }
            LineFault::FrozenTick { for_ms } if self.since_ms() < for_ms => {
                told.tick = self.before.map_or(told.tick, |before| before.tick);
                return told;
            }
            LineFault::FrozenCounts => {
                if let Some(before) = self.before {
                    (told.count_left, told.count_right) = (before.count_left, before.count_right);
                }
                return told;
            }
            _ => {}
        }
        self.before = Some(told);
        told.tick = told.tick.after(self.shift_ms);
        told
    }

    fn deliver(&mut self, mut bytes: Vec<u8>, out: &mut Vec<u8>) {
        let number = self.reports;
        let is_bad_second = (self.since_ms() / 1_000).is_multiple_of(2);
        match self.fault {
            LineFault::WrongSeal { every } if number.is_multiple_of(every) => damage(&mut bytes),
            LineFault::EverySecondSecond if is_bad_second => damage(&mut bytes),
            LineFault::Thinned { keep_every } if !number.is_multiple_of(keep_every) => return,
            LineFault::Delayed { ms } => {
                self.waiting.push_back((self.now_ms + ms, bytes));
                return;
            }
            // The first of two waits until the second has come.
            LineFault::Swapped if !number.is_multiple_of(2) => {
                self.waiting.push_back((self.now_ms + 1_000, bytes));
                return;
            }
            LineFault::Repeated { times } => {
                for _ in 1..times {
                    out.extend(&bytes);
                }
            }
            _ => {}
        }
        out.extend(bytes);
        if self.fault == LineFault::Swapped {
            out.extend(self.waiting.drain(..).flat_map(|(_, first)| first));
        }
    }

    fn pass_command(&mut self, mut packet: Packet, out: &mut Vec<u8>) {
        let Content::Command { command, .. } = &mut packet.content else {
            out.extend(packet.bytes);
            return;
        };
        if self.shift_ms != 0 && unshift(command, self.shift_ms) {
            packet.bytes = self.to_robot.write(&packet.content);
        }
        self.commands += 1;
        if let LineFault::WrongCommandSeal { every } = self.fault
            && self.commands.is_multiple_of(every)
        {
            damage(&mut packet.bytes);
        }
        out.extend(packet.bytes);
    }
}

fn shifted(tick: Tick, by_ms: i32) -> Tick {
    Tick(tick.0.wrapping_add_signed(by_ms))
}

/// Gives a command the tick that the robot's own clock has shown; `false` for a command without one.
fn unshift(command: &mut Command, shift_ms: u32) -> bool {
    let tick = match command {
        Command::Drive(drive) => &mut drive.seen_tick,
        Command::Motor(motor) => &mut motor.seen_tick,
        Command::Move(movement) => &mut movement.seen_tick,
        _ => return false,
    };
    *tick = Tick(tick.0.wrapping_sub(shift_ms));
    true
}

/// Changes the last byte of the seal, before the separator, to another one of its kind.
fn damage(bytes: &mut [u8]) {
    if let [.., last, _] = bytes {
        *last = match *last {
            b'0' => b'1',
            digit if digit.is_ascii_hexdigit() => b'0',
            0x20..0x80 => b'0',
            _ => *last ^ 0x40,
        };
    }
}
