//! What lies between the host's bytes and the robot's serial line, millisecond by millisecond.

use std::collections::VecDeque;

use clap::ValueEnum;
use pic32::board::BoardLink;
use robot_link::OneWire;
use rvac_channel::{Channel, FaultRates, Pcg32, ReceivedByte};

/// Bits a second of the robot's line.
pub(crate) const BAUD: u32 = 230_400;
/// Bytes that a line of 230,400 baud passes in a millisecond.
const BYTES_PER_MS: usize = 23;
/// Frames of USB come once a millisecond: what is written waits for the next one.
const USB_MS: u64 = 1;
/// A wireless network as homes have them: two milliseconds there, one time in fifty up to forty more.
const NETWORK_MS: u64 = 2;
const STALL_SHARE: f64 = 0.02;
const STALL_MS: u32 = 40;
/// Damage for the second half of a measurement: a bit in five thousand, a byte in five thousand, and bursts.
pub(crate) const NOISE: FaultRates = FaultRates {
    bit_error: 2e-4,
    lost_byte: 2e-4,
    burst: 1e-4,
    run_bytes_max: 16,
    ..FaultRates::NONE
};

/// What the link is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LinkKind {
    /// Two wires.
    Uart,
    /// One wire for both directions.
    HalfDuplex,
    /// A network, with something beside the robot that passes bytes on.
    Tcp,
    /// USB.
    Usb,
    /// SPI, the host is master.
    Spi,
    /// I2C, the host is master.
    I2c,
}

impl LinkKind {
    /// The link that the firmware must have been built for.
    pub(crate) const fn at_the_board(self) -> BoardLink {
        match self {
            Self::Uart | Self::HalfDuplex | Self::Tcp | Self::Usb => BoardLink::Serial,
            Self::Spi => BoardLink::Spi,
            Self::I2c => BoardLink::I2c,
        }
    }

    /// Its name in the arguments.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Uart => "uart",
            Self::HalfDuplex => "half-duplex",
            Self::Tcp => "tcp",
            Self::Usb => "usb",
            Self::Spi => "spi",
            Self::I2c => "i2c",
        }
    }
}

/// Bytes under way in one direction, each with the millisecond in which it arrives.
#[derive(Debug, Default)]
struct Lane {
    bytes: VecDeque<(u64, u8)>,
}

impl Lane {
    /// What is behind something slow is not faster than it.
    fn push(&mut self, due_ms: u64, bytes: &[u8]) {
        let due_ms = self.bytes.back().map_or(due_ms, |(last, _)| due_ms.max(*last));
        self.bytes.extend(bytes.iter().map(|byte| (due_ms, *byte)));
    }

    fn take(&mut self, now_ms: u64, max: usize) -> Vec<u8> {
        let due = self.bytes.iter().take(max).take_while(|(due, _)| *due <= now_ms);
        let count = due.count();
        self.bytes.drain(..count).map(|(_, byte)| byte).collect()
    }
}

/// A link under way.
#[derive(Debug)]
pub(crate) struct Wire {
    kind: LinkKind,
    down: Lane,
    up: Lane,
    random: Pcg32,
    /// Damage, to the robot and from it.
    noise: Option<[Channel; 2]>,
    turns: OneWire,
    waiting: Vec<u8>,
    /// What the robot said in this millisecond, while both share a wire.
    robot_speaks: bool,
}

impl Wire {
    /// A link on which nothing passes yet.
    pub(crate) fn new(kind: LinkKind, seed: u64) -> Self {
        Self {
            kind,
            down: Lane::default(),
            up: Lane::default(),
            random: Pcg32::new(seed),
            noise: None,
            turns: OneWire::new(true, BAUD),
            waiting: Vec::new(),
            robot_speaks: false,
        }
    }

    /// From now on it is damaged.
    pub(crate) fn make_noisy(&mut self, seed: u64) {
        self.noise = Some([Channel::new(seed, NOISE), Channel::new(seed + 1, NOISE)]);
    }

    fn delay_ms(&mut self) -> u64 {
        match self.kind {
            // What a host clocks has no delay of its own, and passes elsewhere.
            LinkKind::Uart | LinkKind::HalfDuplex | LinkKind::Spi | LinkKind::I2c => 0,
            LinkKind::Usb => USB_MS,
            LinkKind::Tcp if self.random.happens(STALL_SHARE) => {
                NETWORK_MS + u64::from(self.random.below(STALL_MS))
            }
            LinkKind::Tcp => NETWORK_MS,
        }
    }

    /// Takes what the host writes; gives what reaches the robot's line now.
    pub(crate) fn carry_down(&mut self, now_ms: u64, from_host: &[u8]) -> Vec<u8> {
        if self.kind == LinkKind::HalfDuplex {
            self.waiting.extend_from_slice(from_host);
            let count = self.turns.may_send(now_ms * 1_000, self.waiting.len());
            let turn: Vec<u8> = self.waiting.drain(..count).collect();
            if !turn.is_empty() {
                self.turns.sent(now_ms * 1_000, &turn);
                self.down.push(now_ms, &turn);
            }
        } else if !from_host.is_empty() {
            let due_ms = now_ms + self.delay_ms();
            self.down.push(due_ms, from_host);
        }
        let mut bytes = self.down.take(now_ms, BYTES_PER_MS);
        if self.kind == LinkKind::HalfDuplex {
            let echo: Vec<u8> = bytes.iter().map(|byte| self.mixed(*byte)).collect();
            self.up.push(now_ms, &echo);
            bytes = echo;
        }
        damaged(&mut self.noise, 0, &bytes)
    }

    /// On one wire a low level wins: two that speak at once are both misheard.
    const fn mixed(&self, byte: u8) -> u8 {
        if self.robot_speaks { byte & 0x55 } else { byte }
    }

    /// Takes what the robot's line brings; gives what reaches the host now.
    pub(crate) fn carry_up(&mut self, now_ms: u64, from_robot: &[u8]) -> Vec<u8> {
        self.robot_speaks = !from_robot.is_empty();
        if !from_robot.is_empty() {
            let due_ms = now_ms + self.delay_ms();
            let collides = self.kind == LinkKind::HalfDuplex && !self.down.bytes.is_empty();
            let heard: Vec<u8> = from_robot
                .iter()
                .map(|byte| if collides { byte & 0x55 } else { *byte })
                .collect();
            self.up.push(due_ms, &heard);
        }
        let mut bytes = self.up.take(now_ms, usize::MAX);
        if self.kind == LinkKind::HalfDuplex {
            self.turns.receive(now_ms * 1_000, &mut bytes);
        }
        damaged(&mut self.noise, 1, &bytes)
    }
}

fn damaged(noise: &mut Option<[Channel; 2]>, direction: usize, bytes: &[u8]) -> Vec<u8> {
    let Some(channel) = noise.as_mut().and_then(|both| both.get_mut(direction)) else {
        return bytes.to_vec();
    };
    let mut received = Vec::new();
    for byte in bytes {
        channel.pass(*byte, &mut received);
    }
    received
        .into_iter()
        .filter_map(|received| match received {
            ReceivedByte::Byte(byte) => Some(byte),
            ReceivedByte::FramingError => Some(0),
            ReceivedByte::Overrun => None,
        })
        .collect()
}
