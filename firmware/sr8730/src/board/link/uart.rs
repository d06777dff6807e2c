//! The serial link to the Linux board, a software UART: it receives on RC13 by change notice and sends on RB7 by
//! Timer4.
//!
//! Both interrupts are in `link.S`. They exchange data with the main loop through [`by_edges::EDGES`] and [`RUNS`]; the
//! main loop decodes and encodes. If a board's RC13 does not reach the connector, the feature `link-sampled` receives
//! on RB6 instead ([`by_samples`]).

pub mod by_edges;
#[cfg(feature = "link-sampled")]
pub mod by_samples;

use cordlib::board::{Link, Received};
use pic32mx3_hal::cpu;
#[cfg(feature = "link-rs485")]
use pic32mx3_hal::gpio::Port;
use pic32mx3_hal::gpio::{Output, Pin};
use pic32mx3_hal::interrupt::{self, Priority, Source, SubPriority, Vector};
use pic32mx3_hal::timer::{Prescaler, Timer};
use soft_uart::{Baud, BitTime, Transmitter};

use super::brush;
use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::runs::RunRing;

#[cfg(not(feature = "link-sampled"))]
use by_edges::EdgeInput as Input;
#[cfg(not(feature = "link-sampled"))]
pub use by_edges::EdgeParts as InputParts;
#[cfg(feature = "link-sampled")]
use by_samples::SampledInput as Input;
#[cfg(feature = "link-sampled")]
pub use by_samples::SampledParts as InputParts;

/// Rate until the other side's `U` shows another one: the daemon's default.
#[cfg(not(feature = "link-sampled"))]
const BAUD: Baud = Baud::B230400;
/// The fixed rate of a sampled input.
#[cfg(feature = "link-sampled")]
const BAUD: Baud = by_samples::BAUD;
/// Counts of Timer4 a second, prescaler 2: nine equal bits at 9600 baud are 37,500 counts then, which fit into 16 bits.
const TIMER_HZ: u32 = 40_000_000;
/// Counts until the first bit of a message: the shortest possible time.
const BEGIN_COUNTS: u32 = 100;

/// Levels and times of the output, from the main loop to the interrupt in `link.S`.
pub static RUNS: RunRing = RunRing::new();

// The interrupt is written for this pin.
const _: () = assert!(mask(pins::LINK_TRANSMIT) == 1 << 7);

/// Switches the driver of an RS-485 pair on. The interrupt is written for this pin, too.
#[cfg(feature = "link-rs485")]
const DRIVER: u16 = mask(pins::SPARE_RG2);
#[cfg(feature = "link-rs485")]
const _: () = assert!(DRIVER == 1 << 2);

/// The link.
#[derive(Debug)]
pub struct SerialLink {
    input: Input,
    transmitter: Transmitter,
    baud: Baud,
    timer: Timer<4>,
}

impl SerialLink {
    /// Starts receiving. From here on the interrupt sets the output.
    #[must_use]
    pub fn take(input: InputParts, mut transmit: Pin<'B', 7, Output>, timer: Timer<4>) -> Self {
        transmit.set_high();
        interrupt::set_priority(Vector::Timer4, Priority::Level6, SubPriority::Sub1).ok();
        Source::Timer4.clear();
        Source::Timer4.enable();
        Self {
            input: Input::take(input, BAUD),
            transmitter: Transmitter::new(BitTime::new(BAUD, TIMER_HZ)),
            baud: BAUD,
            timer,
        }
    }

    /// Called once a millisecond.
    pub fn service(&mut self) {
        self.input.service();
        brush::service();
    }

    /// Applies a new rate between two messages, so that none is damaged.
    fn follow_rate(&mut self) {
        if let Some(baud) = self.input.rate()
            && baud != self.baud
            && RUNS.is_quiet()
        {
            self.baud = baud;
            self.transmitter.set_bit_time(BitTime::new(baud, TIMER_HZ));
        }
    }
}

impl Link for SerialLink {
    fn receive(&mut self) -> Option<Received> {
        let event = self.input.next_event();
        if event.is_none() {
            self.follow_rate();
        }
        event
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let taken = RUNS.push(&mut self.transmitter, bytes);
        // If the interrupt comes in between, it finds nothing and stops the timer, or continues with the pushed words.
        if cpu::without_interrupts(|| RUNS.must_start()) {
            // The interrupt that finds nothing more to send switches it off.
            #[cfg(feature = "link-rs485")]
            Port::G.set(DRIVER);
            self.timer.start(Prescaler::By2, BEGIN_COUNTS);
        }
        taken
    }
}
