//! The link as slave on SPI 1: SCK RF6, SDI RF7, SDO RF8.
//!
//! The chip's own select line is the charger's voltage on this board, so the slave is always selected, which the chip offers
//! with data that changes on the leading edge only (modes 1 and 3). RC13 is the master's select line all the same: when it goes
//! high, the next transfer begins with a whole byte, whatever the clock did. RB7 is high while there is something to say. The
//! receiver on RF6 and the switch of the gyro module on RF7 are not there then.
//!
//! The handler of the SPI moves bytes; the main loop takes fill and escapes out and puts them in.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::{Link, Received};
use embedded_hal::spi::Polarity;
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Output, Pin, Port};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::spi::{Spi, SpiSlave};
use rvac_protocol::fill::{FILL, FillDecoder, encode};
use soft_uart::ByteRing;

use super::brush;
use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::interrupt_rate::InterruptRateLimit;
use crate::logic::under_way::UnderWay;

/// Bytes that wait in each direction.
const QUEUE: usize = 512;
/// One byte of the stream is two on the line at most.
const ENCODED_MAX: usize = 2;
/// Interrupts of the SPI in a millisecond: two a byte at 1 MHz, and some.
const INTERRUPTS_PER_MS: u32 = 300;
/// Changes of the select line in a millisecond: twenty transfers.
const SELECTS_PER_MS: u32 = 40;
/// A bus without a slave, or without a master.
const FLOATING: u8 = 0xFF;

const SELECT: u16 = mask(pins::LINK_RECEIVE);
const ATTENTION: u16 = mask(pins::LINK_TRANSMIT);

static HEARD: ByteRing<QUEUE> = ByteRing::new();
static SAID: ByteRing<QUEUE> = ByteRing::new();
static LOST: AtomicU32 = AtomicU32::new(0);
static RATE_LIMIT: InterruptRateLimit = InterruptRateLimit::new(INTERRUPTS_PER_MS);
static SELECT_LIMIT: InterruptRateLimit = InterruptRateLimit::new(SELECTS_PER_MS);
/// Not 0 when the transfer is over.
static IS_OVER: AtomicU32 = AtomicU32::new(0);
/// The select line as the handler of the change notice saw it last.
static SELECT_LEVEL: AtomicU32 = AtomicU32::new(0);
static SLAVE: HandlerCell<vector::SPI_1, SpiSide> = HandlerCell::empty();

type Pins = (Pin<'F', 6, Input>, Pin<'F', 8, Output>, Pin<'F', 7, Input>);

/// What belongs to the handler.
struct SpiSide {
    slave: SpiSlave<1, u8, Pins>,
    under_way: UnderWay,
}

impl SpiSide {
    #[inline(always)]
    fn take(&mut self) {
        for _ in 0..2 {
            let Some(received) = self.slave.try_receive() else {
                return;
            };
            self.under_way.leave();
            match received {
                Ok(FILL | FLOATING) => {}
                Ok(byte) if HEARD.push(&[byte]) == 1 => {}
                Ok(_) | Err(_) => LOST.store(LOST.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed),
            }
        }
    }

    #[inline(always)]
    fn give(&mut self) {
        for _ in 0..2 {
            if !self.slave.has_room() {
                return;
            }
            let byte = self.under_way.give(|| SAID.pop());
            self.slave.try_send(byte);
        }
    }
}

fn on_word(context: &mut Context<vector::SPI_1>) {
    let Some(side) = SLAVE.get(context) else {
        return;
    };
    side.take();
    if IS_OVER.load(Ordering::Relaxed) != 0 {
        IS_OVER.store(0, Ordering::Relaxed);
        side.slave.restart();
        side.under_way.forget();
    }
    side.give();
    if SAID.is_empty() && !side.under_way.says_something() {
        Port::B.clear(ATTENTION);
    }
    for source in SOURCES {
        source.clear();
    }
    if !RATE_LIMIT.spend() {
        SOURCES.into_iter().for_each(Source::disable);
    }
}
interrupt!(SPI_1, on_word);

const SOURCES: [Source; 3] = [Spi::<1>::RECEIVED, Spi::<1>::SENT, Spi::<1>::FAULT];

/// The levels of port C at a change notice: the master may have let go of the select line. It and the SPI's handler are of one
/// level, so neither interrupts the other.
#[inline(always)]
pub(super) fn note_select(levels: u16) {
    let level = u32::from(levels & SELECT);
    if level == SELECT_LEVEL.load(Ordering::Relaxed) {
        return;
    }
    SELECT_LEVEL.store(level, Ordering::Relaxed);
    if !SELECT_LIMIT.spend() {
        // The brush is on the same interrupt and waits as well, until the next millisecond.
        Source::ChangeNotice.disable();
    }
    if level != 0 {
        IS_OVER.store(1, Ordering::Relaxed);
        Spi::<1>::RECEIVED.request();
    }
}

/// The levels of port C. Reading the port updates the reference of the change notice, which could hide a change of the select
/// line at this moment; so the interrupt is requested if there was one.
#[must_use]
pub fn port_c() -> u16 {
    let word = Port::C.read();
    if u32::from(word & SELECT) != SELECT_LEVEL.load(Ordering::Relaxed) {
        Source::ChangeNotice.request();
    }
    word
}

/// What the link is made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct SpiParts {
    pub spi: Spi<1>,
    pub pins: Pins,
    pub select: Pin<'C', 13, Input>,
    pub attention: Pin<'B', 7, Output>,
    pub brush: Pin<'B', 5, Input>,
    pub notice: ChangeNotice,
}

/// The link.
#[derive(Debug)]
pub struct SpiLink {
    decoder: FillDecoder,
    lost: u32,
}

impl SpiLink {
    /// Waits for the master.
    #[must_use]
    pub fn take(mut parts: SpiParts) -> Self {
        parts.attention.set_low();
        let slave = parts
            .spi
            .into_slave_without_select::<u8, _, _, _>(parts.pins, Polarity::IdleLow);
        let mut side = SpiSide {
            slave,
            under_way: UnderWay::new(),
        };
        side.give();
        // Given once, because `Peripherals` gives the SPI once.
        SLAVE.hand_over(side).ok();
        interrupt::set_priority(Vector::Spi1, Priority::Level6, SubPriority::Sub3).ok();
        parts.select.enable_pull_up();
        parts.select.enable_notice();
        brush::watch(parts.brush, parts.notice);
        SELECT_LEVEL.store(u32::from(Port::C.read() & SELECT), Ordering::Relaxed);
        Source::ChangeNotice.clear();
        Source::ChangeNotice.enable();
        SOURCES.into_iter().for_each(Source::enable);
        Self {
            decoder: FillDecoder::default(),
            lost: 0,
        }
    }

    /// Called once a millisecond: gives the interrupts their room for the next one. What was lost without it is out of step.
    pub fn service(&mut self) {
        if RATE_LIMIT.renew() {
            IS_OVER.store(1, Ordering::Relaxed);
            SOURCES.into_iter().for_each(Source::enable);
            Spi::<1>::RECEIVED.request();
        }
        if SELECT_LIMIT.renew() {
            Source::ChangeNotice.enable();
            Source::ChangeNotice.request();
        }
        brush::service();
    }
}

impl Link for SpiLink {
    fn receive(&mut self) -> Option<Received> {
        while let Some(byte) = HEARD.pop() {
            if let Some(byte) = self.decoder.push(byte) {
                return Some(Received::Byte(byte));
            }
        }
        let lost = LOST.load(Ordering::Relaxed);
        if lost != self.lost {
            self.lost = lost;
            return Some(Received::Overrun);
        }
        None
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let mut taken = 0;
        for byte in bytes {
            if QUEUE - SAID.len() < ENCODED_MAX {
                break;
            }
            for on_line in encode(*byte) {
                SAID.push(&[on_line]);
            }
            taken += 1;
        }
        if taken > 0 {
            Port::B.set(ATTENTION);
        }
        taken
    }
}
