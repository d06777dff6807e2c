//! The link as slave on I2C 1: SDA RG3, SCL RG2, which resistors of the Linux board hold high. RB7 is high while there is something
//! to say.
//!
//! The chip holds the clock until its handler has served a byte, so nothing is late; the handler moves bytes between the two
//! registers of the link and the main loop.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::{Link, Received};
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Output, Pin, Port};
use pic32mx3_hal::i2c::{Address, Answers, I2c, I2cSlave, SlaveEvent};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use soft_uart::ByteRing;

use super::brush;
use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::interrupt_rate::InterruptRateLimit;
use crate::logic::link_registers::{LinkRegisters, Wanted, told};

/// The slave's address.
const ADDRESS: Address = Address::Seven(0x2A);
/// Bytes that wait in each direction.
const QUEUE: usize = 512;
/// Interrupts in a millisecond: a byte each at 1 MHz.
const INTERRUPTS_PER_MS: u32 = 120;
/// A transfer in which nothing has happened for so long is over, with its stop or without: the cable was pulled within a byte,
/// and the line that this side holds would keep the bus from working (SMBus gives up after 25 ms, too).
const SILENT_MS: u32 = 25;

const ATTENTION: u16 = mask(pins::LINK_TRANSMIT);

static HEARD: ByteRing<QUEUE> = ByteRing::new();
static SAID: ByteRing<QUEUE> = ByteRing::new();
static LOST: AtomicU32 = AtomicU32::new(0);
static RATE_LIMIT: InterruptRateLimit = InterruptRateLimit::new(INTERRUPTS_PER_MS);
/// Bytes of all transfers, wrapping.
static EVENTS: AtomicU32 = AtomicU32::new(0);
/// Not 0 when the handler shall look whether a transfer hangs.
static IS_SILENT: AtomicU32 = AtomicU32::new(0);
static SLAVE: HandlerCell<vector::I2C_1, I2cSide> = HandlerCell::empty();

/// What belongs to the handler.
struct I2cSide {
    slave: I2cSlave<1, Pin<'G', 3, Input>, Pin<'G', 2, Input>>,
    registers: LinkRegisters,
}

impl I2cSide {
    fn serve(&mut self, event: SlaveEvent) {
        match event {
            SlaveEvent::Begins => self.registers.begin(),
            SlaveEvent::Received(byte) => {
                if let Some(byte) = self.registers.receive(byte)
                    && HEARD.push(&[byte]) == 0
                {
                    add_one(&LOST);
                }
            }
            SlaveEvent::Wanted { .. } => {
                let byte = match self.registers.want() {
                    Wanted::Waiting => told(SAID.len()),
                    Wanted::Room => told(QUEUE - HEARD.len()),
                    Wanted::Stream => SAID.pop().unwrap_or(0),
                    Wanted::Nothing => 0,
                };
                self.slave.answer(byte);
                if SAID.is_empty() {
                    Port::B.clear(ATTENTION);
                }
            }
            SlaveEvent::Lost => add_one(&LOST),
            SlaveEvent::Called => {}
        }
    }
}

fn add_one(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

fn on_byte(context: &mut Context<vector::I2C_1>) {
    let Some(side) = SLAVE.get(context) else {
        return;
    };
    if IS_SILENT.load(Ordering::Relaxed) != 0 {
        IS_SILENT.store(0, Ordering::Relaxed);
        if !side.slave.has_stopped() {
            side.slave.restart();
            side.registers = LinkRegisters::new();
        }
        // A byte that came at this moment would have begun with a start, which takes the stop away.
        I2c::<1>::SLAVE.clear();
        return;
    }
    if let Some(event) = side.slave.take_event() {
        add_one(&EVENTS);
        side.serve(event);
    }
    if !RATE_LIMIT.spend() {
        I2c::<1>::SLAVE.disable();
    }
}
interrupt!(I2C_1, on_byte);

/// The levels of port C.
#[must_use]
pub fn port_c() -> u16 {
    Port::C.read()
}

/// What the link is made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct I2cParts {
    pub i2c: I2c<1>,
    pub lines: (Pin<'G', 3, Input>, Pin<'G', 2, Input>),
    pub attention: Pin<'B', 7, Output>,
    pub brush: Pin<'B', 5, Input>,
    pub notice: ChangeNotice,
}

/// The link.
#[derive(Debug)]
pub struct I2cLink {
    lost: u32,
    events: u32,
    silent_ms: u32,
}

impl I2cLink {
    /// Waits for the master.
    #[must_use]
    pub fn take(mut parts: I2cParts) -> Self {
        parts.attention.set_low();
        if let Ok(slave) = parts.i2c.into_slave(parts.lines, ADDRESS, Answers::default()) {
            let registers = LinkRegisters::new();
            // Given once, because `Peripherals` gives the I2C once.
            SLAVE.hand_over(I2cSide { slave, registers }).ok();
        }
        interrupt::set_priority(Vector::I2c1, Priority::Level3, SubPriority::Sub1).ok();
        brush::watch(parts.brush, parts.notice);
        Source::ChangeNotice.clear();
        Source::ChangeNotice.enable();
        I2c::<1>::SLAVE.enable();
        Self {
            lost: 0,
            events: 0,
            silent_ms: SILENT_MS,
        }
    }

    /// Called once a millisecond: gives the interrupt its room for the next one, and ends a transfer that hangs.
    pub fn service(&mut self) {
        let events = EVENTS.load(Ordering::Relaxed);
        if events != self.events {
            self.events = events;
            self.silent_ms = 0;
        } else if self.silent_ms < SILENT_MS {
            self.silent_ms += 1;
            if self.silent_ms == SILENT_MS {
                IS_SILENT.store(1, Ordering::Relaxed);
                I2c::<1>::SLAVE.request();
            }
        }
        if RATE_LIMIT.renew() {
            I2c::<1>::SLAVE.enable();
        }
        brush::service();
    }
}

impl Link for I2cLink {
    fn receive(&mut self) -> Option<Received> {
        if let Some(byte) = HEARD.pop() {
            return Some(Received::Byte(byte));
        }
        let lost = LOST.load(Ordering::Relaxed);
        if lost != self.lost {
            self.lost = lost;
            return Some(Received::Overrun);
        }
        None
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let taken = SAID.push(bytes);
        if taken > 0 {
            Port::B.set(ATTENTION);
        }
        taken
    }
}
