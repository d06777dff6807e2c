//! The serial line between host and robot: whole frames, and the damage between.

use super::{CYCLES_PER_MS, CYCLES_PER_S};
use crate::machine::Machine;
use crate::peripheral::{LineFrame, SentFrame, TICKS_PER_CYCLE};
use rvac_channel::{Channel, FaultRates, ReceivedByte};
use std::collections::VecDeque;

/// Bytes the host's driver holds at most; what comes while it is full is the host's to keep.
const QUEUE_MAX: usize = 4096;
/// Bits of a byte on the line: start, eight, stop.
const FRAME_BITS: u64 = 10;
/// A host hears a rate that differs by so much, in thousandths: half a bit at the tenth.
const HEARD_PERMILLE: u64 = 45;
/// A line at rest.
const REST: u16 = u16::MAX;

/// How fast the host's UART runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostRate {
    /// Bits per second, 300 to 1,000,000.
    pub baud: u32,
}

impl HostRate {
    /// Length of a bit in sixths of a machine cycle.
    #[must_use]
    pub fn bit_ticks(self) -> u64 {
        CYCLES_PER_S * TICKS_PER_CYCLE / u64::from(self.baud.max(1))
    }
}

/// Both ways of the line.
#[derive(Clone, Debug)]
pub(super) struct Line {
    bit_ticks: u64,
    to_robot: VecDeque<u8>,
    /// Frames of ten levels that follow next.
    frames: VecDeque<u16>,
    /// Tick at which the next frame may begin.
    free: u64,
    channels: [Channel; 2],
    is_faulty: bool,
    held_until: u64,
    cut_until: u64,
    /// What the host's driver has not given out yet.
    waiting: Vec<u8>,
}

/// Bytes that a perfect receiver hears in a millisecond; nothing for one with a wrong stop bit.
pub(super) type Heard = Vec<Option<u8>>;

impl Line {
    /// An idle line; damage follows from `seed`.
    pub(super) fn new(rate: HostRate, seed: u64) -> Self {
        let channel = |seed| Channel::new(seed, FaultRates::NONE);
        Self {
            bit_ticks: rate.bit_ticks(),
            to_robot: VecDeque::new(),
            frames: VecDeque::new(),
            free: 0,
            channels: [channel(seed), channel(seed.wrapping_add(1))],
            is_faulty: false,
            held_until: 0,
            cut_until: 0,
            waiting: Vec::new(),
        }
    }

    /// Everything waits until `cycle`, both ways.
    pub(super) fn hold_until(&mut self, cycle: u64) {
        self.held_until = self.held_until.max(cycle);
    }

    /// Everything that is sent before `cycle` is lost, both ways.
    pub(super) fn cut_until(&mut self, cycle: u64) {
        self.cut_until = self.cut_until.max(cycle);
    }

    /// Sets how often what goes wrong from now on, both ways.
    pub(super) fn set_rates(&mut self, rates: FaultRates) {
        for channel in &mut self.channels {
            channel.set_rates(rates);
        }
        self.is_faulty = rates != FaultRates::NONE;
    }

    /// Bytes that [`Self::send`] would take now.
    pub(super) fn room(&self) -> usize {
        QUEUE_MAX - self.to_robot.len()
    }

    /// Bytes that the host's driver holds.
    pub(super) fn waiting(&self) -> usize {
        self.to_robot.len()
    }

    /// Hands bytes to the host's driver and returns how many it took.
    pub(super) fn send(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.room());
        self.to_robot.extend(&bytes[..taken]);
        taken
    }

    /// Forgets what the host's driver holds.
    pub(super) fn flush(&mut self) {
        self.to_robot.clear();
    }

    /// Hands the frames that begin in this millisecond to the chip.
    pub(super) fn pass_ms(&mut self, from: u64, machine: &mut Machine) -> Heard {
        let mut heard = Heard::new();
        if from < self.held_until {
            return heard;
        }
        let [begin, end] = [from, from + CYCLES_PER_MS].map(|cycle| cycle * TICKS_PER_CYCLE);
        self.free = self.free.max(begin);
        while self.free < end {
            let Some(levels) = self.next_frame() else {
                break;
            };
            let cycle = self.free / TICKS_PER_CYCLE;
            let levels = if cycle < self.cut_until { REST } else { levels };
            if let Some(frame) = LineFrame::of_levels(cycle, self.bit_ticks, levels) {
                machine.hear(frame);
                heard.push(byte_of(levels));
            }
            self.free += FRAME_BITS * self.bit_ticks;
        }
        heard
    }

    fn next_frame(&mut self) -> Option<u16> {
        if self.frames.is_empty() {
            let byte = self.to_robot.pop_front();
            if byte.is_none() && !self.is_faulty {
                return None;
            }
            let mut drawn = Vec::new();
            self.channels[0].carry(byte, &mut drawn);
            self.frames.extend(drawn);
        }
        Some(self.frames.pop_front().unwrap_or(REST))
    }

    /// What a perfect receiver hears of the frames that the robot has sent up to `end`.
    pub(super) fn take(&mut self, sent: &[SentFrame], end: u64) -> Heard {
        let mut heard = Heard::new();
        for frame in sent.iter().filter(|frame| frame.line_is_free) {
            let byte = self.is_heard(frame.bit_ticks).then_some(frame.byte);
            heard.push(byte);
            if end <= self.cut_until {
                continue;
            }
            let mut damaged = Vec::new();
            match byte {
                Some(byte) if self.is_faulty => self.channels[1].pass(byte, &mut damaged),
                Some(byte) => damaged.push(ReceivedByte::Byte(byte)),
                None => damaged.push(ReceivedByte::FramingError),
            }
            self.waiting
                .extend(damaged.into_iter().filter_map(|received| match received {
                    ReceivedByte::Byte(byte) => Some(byte),
                    ReceivedByte::FramingError => Some(0),
                    ReceivedByte::Overrun => None,
                }));
        }
        heard
    }

    /// Appends what the host's driver gives out now. A byte with a wrong stop bit is handed over as NUL.
    pub(super) fn give_out(&mut self, end: u64, to_host: &mut Vec<u8>) {
        if end > self.held_until {
            to_host.append(&mut self.waiting);
        }
    }

    fn is_heard(&self, bit_ticks: u64) -> bool {
        bit_ticks.abs_diff(self.bit_ticks) * 1000 <= self.bit_ticks * HEARD_PERMILLE
    }
}

/// What ten levels mean, the start bit lowest.
fn byte_of(levels: u16) -> Option<u8> {
    let is_whole = levels & 0x201 == 0x200;
    is_whole.then_some((levels >> 1) as u8)
}
