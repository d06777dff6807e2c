//! DMA: four channels that move up to 256 bytes each while the processor does something else (section 3 of the peripherals).
//!
//! A channel owns what it works with until it is done or stopped: the memory, which must be there for good
//! ([`ReadBuffer`], [`WriteBuffer`], [`StaticBuffer`], [`FirstOf`]), and the driver of the peripheral. So a [`Transfer`] that is forgotten
//! moves on into memory that nobody else has. There is no cache between the processor and its RAM on these chips.
//!
//! | what | how |
//! | --- | --- |
//! | memory to memory, up to a byte, filling | [`Channel::copy`], [`Channel::copy_until`] |
//! | CRC of memory | [`Channel::feed_crc`] |
//! | UART | [`Transmitter::send_by_dma`](crate::uart::Transmitter::send_by_dma), [`Receiver::receive_by_dma`](crate::uart::Receiver::receive_by_dma), [`Receiver::receive_into_ring`](crate::uart::Receiver::receive_into_ring) |
//! | SPI | [`SpiMaster::exchange_by_dma`](crate::spi::SpiMaster::exchange_by_dma) |
//! | ADC | [`Scanner::sample_by_dma`](crate::adc::Scanner::sample_by_dma) |
//!
//! A channel asks for the interrupt [`Channel::SOURCE`] when its block is over; the handler calls [`Channel::acknowledge`].
//! Leave the interrupts of a peripheral that DMA serves disabled. DMA stands still in Sleep.
//!
//! `unverified`: whether a request that stays up (UART, SPI) starts cell after cell or one when it rises; the drivers here work with
//! both. That a channel whose CHEN is cleared keeps its pointers until they were read; in which order bits enter the CRC; how long an access takes.

#![allow(clippy::type_complexity, reason = "what does not fit comes back whole")]

mod adc;
mod buffer;
mod copy;
mod crc;
mod ring;
mod spi;
mod transfer;
mod uart;

pub use adc::{SampleTrigger, Sampler};
pub use buffer::{Element, FirstOf, ReadBuffer, StaticBuffer, WriteBuffer};
pub use copy::{Copying, Reading};
pub use crc::{CrcError, CrcSettings, CrcUnit};
pub use ring::{RingError, RingReceiver};
pub use spi::{Exchange, Exchanged};
pub use transfer::{Driver, Finished, LengthError, Transfer, TransferError};

#[doc(hidden)]
pub use buffer::Lent;

use crate::interrupt::Source;
use crate::register::map::{DMACON, dma_control, dma_event};

const ON: u32 = 1 << 15;
const SUSPEND: u32 = 1 << 12;

/// CHPRI.
const PRIORITY: u32 = 3;
/// CHEN.
const ENABLE: u32 = 1 << 7;
/// CHAEN.
const AUTO_ENABLE: u32 = 1 << 4;

const ABORT_BY_SOURCE: u32 = 1 << 3;
const START_BY_SOURCE: u32 = 1 << 4;
const STOP_AT_PATTERN: u32 = 1 << 5;
const ABORT: u32 = 1 << 6;
const FORCE: u32 = 1 << 7;
const START_SHIFT: u32 = 8;
const ABORT_SHIFT: u32 = 16;

/// Bytes that a block has at most.
pub const BLOCK_BYTES_MAX: usize = 256;

/// The DMA controller, off.
#[derive(Debug)]
pub struct Dma(());

/// What the controller consists of.
#[derive(Debug)]
#[non_exhaustive]
pub struct DmaChannels {
    /// Channel 0.
    pub channel0: Channel<0>,
    /// Channel 1.
    pub channel1: Channel<1>,
    /// Channel 2.
    pub channel2: Channel<2>,
    /// Channel 3.
    pub channel3: Channel<3>,
    /// The CRC unit, which one channel at a time can use.
    pub crc: CrcUnit,
}

impl Dma {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Turns it on.
    #[must_use]
    pub fn start(self) -> DmaChannels {
        DMACON.set(ON);
        DmaChannels {
            channel0: Channel::new(),
            channel1: Channel::new(),
            channel2: Channel::new(),
            channel3: Channel::new(),
            crc: CrcUnit::new(),
        }
    }
}

/// Which channel goes first when several have something to move; equal ones take turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
#[repr(u8)]
pub enum ChannelPriority {
    /// After all others.
    #[default]
    Lowest = 0,
    /// Before the lowest.
    Low = 1,
    /// After the highest.
    High = 2,
    /// Before all others.
    Highest = 3,
}

/// Channel `NUMBER`, 0 to 3, that moves nothing.
#[derive(Debug)]
pub struct Channel<const NUMBER: u8>(());

impl<const NUMBER: u8> Channel<NUMBER> {
    /// Its source of interrupts.
    pub const SOURCE: Source = match NUMBER {
        0 => Source::Dma0,
        1 => Source::Dma1,
        2 => Source::Dma2,
        3 => Source::Dma3,
        _ => panic!("channels are 0 to 3"),
    };

    const fn new() -> Self {
        Self(())
    }

    /// Its place among the channels, from now on.
    pub fn set_priority(&mut self, priority: ChannelPriority) {
        dma_control(NUMBER).clear(PRIORITY);
        dma_control(NUMBER).set(priority as u32);
    }

    /// Lets a request of this source end each transfer from now on, or none: for instance a timer that gives a peripheral so long.
    pub fn set_abort(&mut self, source: Option<Source>) {
        let events = match source {
            Some(source) => (source as u32) << ABORT_SHIFT | ABORT_BY_SOURCE,
            None => 0,
        };
        dma_event(NUMBER).write(events);
    }
}

/// Runs a function while no channel moves anything. What was started goes on after it.
pub fn suspended<R>(function: impl FnOnce() -> R) -> R {
    let moves = DMACON.read() & (ON | SUSPEND) == ON;
    if moves {
        DMACON.set(SUSPEND);
        while !DMACON.has(SUSPEND) {}
    }
    let result = function();
    if moves {
        DMACON.clear(SUSPEND);
    }
    result
}

#[cfg(test)]
pub(crate) mod tests {
    use super::{Channel, ChannelPriority, Dma, suspended};
    use crate::interrupt::Source;
    use crate::register::map::{DMACON, dma_control, dma_event};
    use std::sync::{Mutex, MutexGuard, PoisonError};

    /// The registers are one memory for all tests: each that uses the same channel takes this.
    pub(crate) fn alone() -> MutexGuard<'static, ()> {
        static TURN: Mutex<()> = Mutex::new(());
        TURN.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What a channel does at the end of a block.
    pub(crate) fn end_block(number: u8, flags: u32) {
        crate::register::map::dma_interrupt(number).set(flags);
        dma_control(number).clear(super::ENABLE);
    }

    #[test]
    fn priorities_and_aborts_are_their_bits() {
        let _alone = alone();
        DMACON.write(0);
        let mut channels = Dma::new().start();
        assert_eq!(DMACON.read(), 1 << 15);
        channels.channel3.set_priority(ChannelPriority::Highest);
        assert_eq!(dma_control(3).read(), 3);
        channels.channel3.set_priority(ChannelPriority::Low);
        assert_eq!(dma_control(3).read(), 1);
        channels.channel3.set_priority(ChannelPriority::Lowest);
        channels.channel3.set_abort(Some(Source::Timer4));
        assert_eq!(dma_event(3).read(), 16 << 16 | 1 << 3);
        channels.channel3.set_abort(None);
        assert_eq!(dma_event(3).read(), 0);
        assert_eq!(
            [
                Channel::<0>::SOURCE,
                Channel::<1>::SOURCE,
                Channel::<2>::SOURCE,
                Channel::<3>::SOURCE
            ],
            [Source::Dma0, Source::Dma1, Source::Dma2, Source::Dma3]
        );
    }

    #[test]
    fn everything_stands_still_while_suspended() {
        let _alone = alone();
        DMACON.write(1 << 15);
        assert_eq!(suspended(|| DMACON.read()), 1 << 15 | 1 << 12);
        assert_eq!(DMACON.read(), 1 << 15);
        assert_eq!(
            suspended(|| suspended(|| 0) + DMACON.read()),
            1 << 15 | 1 << 12,
            "the outer one ends it"
        );
        DMACON.write(0);
        assert_eq!(suspended(|| DMACON.read()), 0, "it is off");
    }
}
