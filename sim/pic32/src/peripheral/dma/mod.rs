//! The DMA controller: four channels that move bytes between RAM, flash and registers, one access at a time.
//!
//! The chip's tables do not tell how long an access takes; here it is four cycles of the system clock, and the core does not wait.
//! Nor do they tell whether a request that stays up (UART, SPI, change notice) starts cell after cell, or one when it rises;
//! [`DmaRequests`] chooses.

mod channel;
mod crc;
mod moves;

use channel::{ChannelWrite, DmaChannel};
use crc::CrcUnit;

const ON: u32 = 1 << 15;
const SUSPEND: u32 = 1 << 12;
const CONTROL_WRITABLE: u32 = 0xB000;
/// DMASTAT.RDWR.
const READ: u32 = 1 << 3;
/// Registers before those of the channels, and those of a channel.
const GLOBAL_WORDS: u8 = 6;
const CHANNEL_WORDS: u8 = 12;

/// How requests that stay up start cells. No source tells which one the chip does, so programs must work with both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DmaRequests {
    /// Cell after cell while the request is up.
    #[default]
    WhileUp,
    /// One cell for each byte or word that has left or come.
    OncePerEvent,
}

/// What a write was wrong about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DmaWrite {
    /// Nothing.
    Fine,
    /// Addresses or sizes of this channel change while it is on.
    WhileOn(u8),
    /// This channel has auto enable and chaining together.
    Combination(u8),
}

/// The registers.
#[derive(Clone, Debug)]
pub(super) struct Dma {
    control: u32,
    /// DMASTAT and DMAADDR.
    status: u32,
    address: u32,
    crc: CrcUnit,
    channels: [DmaChannel; 4],
    /// The channel that moved last.
    last: u8,
    /// An access is due.
    is_moving: bool,
    requests: DmaRequests,
}

impl Dma {
    pub(super) const fn new(requests: DmaRequests) -> Dma {
        Dma {
            control: 0,
            status: 0,
            address: 0,
            crc: CrcUnit::NEW,
            channels: [DmaChannel::OFF; 4],
            last: 3,
            is_moving: false,
            requests,
        }
    }

    /// As after a reset.
    pub(super) fn reset(&mut self) {
        *self = Dma::new(self.requests);
    }

    pub(super) fn set_requests(&mut self, requests: DmaRequests) {
        self.requests = requests;
    }

    pub(super) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => self.status,
            2 => self.address,
            3..GLOBAL_WORDS => self.crc.read(word - 3),
            _ => {
                let (channel, word) = channel_of(word);
                self.channels.get(channel)?.read(word)
            }
        })
    }

    pub(super) fn write(&mut self, word: u8, value: u32) -> DmaWrite {
        match word {
            0 => self.control = value & CONTROL_WRITABLE,
            1 | 2 => {}
            3..GLOBAL_WORDS => self.crc.write(word - 3, value),
            _ => {
                let (channel, word) = channel_of(word);
                let Some(found) = self.channels.get_mut(channel) else {
                    return DmaWrite::Fine;
                };
                let number = u8::try_from(channel).unwrap_or(0);
                return match found.write(word, value) {
                    ChannelWrite::Fine => DmaWrite::Fine,
                    ChannelWrite::WhileOn => DmaWrite::WhileOn(number),
                    ChannelWrite::Combination => DmaWrite::Combination(number),
                };
            }
        }
        DmaWrite::Fine
    }

    /// The requests that channels listen to.
    pub(super) fn listens_to(&self) -> u64 {
        if self.control & ON == 0 {
            return 0;
        }
        self.channels
            .iter()
            .fold(0, |all, channel| all | channel.listens_to())
    }

    /// Requests that were raised.
    fn hear(&mut self, requests: u64) {
        self.channels
            .iter_mut()
            .for_each(|channel| channel.hear(requests));
    }

    /// Requests that are up end the channels that listen for them, if they count while they are up.
    fn follow(&mut self, lines: u64) {
        if self.requests == DmaRequests::WhileUp {
            self.channels.iter_mut().for_each(|channel| channel.follow(lines));
        }
    }

    /// The channel that moves next: the highest priority, and among equals in turn.
    fn next_mover(&self, lines: u64) -> Option<u8> {
        if self.control & (ON | SUSPEND) != ON {
            return None;
        }
        let lines = match self.requests {
            DmaRequests::WhileUp => lines,
            DmaRequests::OncePerEvent => 0,
        };
        let in_turn = (1..=4).map(|step| (self.last + step) % 4);
        in_turn
            .rev()
            .filter(|&number| self.channels[usize::from(number)].wants_to_move(lines))
            .max_by_key(|&number| self.channels[usize::from(number)].priority())
    }

    fn chain(&mut self, ended: u8) {
        for (number, channel) in (0_u8..).zip(&mut self.channels) {
            if number.abs_diff(ended) == 1 {
                channel.neighbour_ended(ended > number);
            }
        }
    }
}

fn channel_of(word: u8) -> (usize, u8) {
    let word = word - GLOBAL_WORDS;
    (usize::from(word / CHANNEL_WORDS), word % CHANNEL_WORDS)
}
