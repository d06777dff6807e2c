//! A UART made by software, for microcontrollers whose serial pins have no UART behind them. 8 data bits, no parity, one
//! stop bit, 9600 to 230400 baud. No hardware is known here: times come in as numbers, levels and times go out.
//!
//! # Receiving by edges
//! An interrupt notes for each change of the line *when* it came (a free running counter that wraps at 32 bits) and which
//! level the line has now, as an [`Edge`], in an [`EdgeRing`]. The main loop takes them out:
//!
//! ```
//! use soft_uart::{Edge, EdgeRing, Level, Queued, Received, Receiver};
//!
//! static EDGES: EdgeRing<256> = EdgeRing::new();
//!
//! // In the interrupt:
//! EDGES.push(Edge { at: 1_000, level: Level::Low });
//!
//! // In the main loop, with a counter of 40 MHz. The order matters: `now` is read before the queue is emptied, so that
//! // every edge before `now` has been seen when `poll` decides that a byte has ended.
//! let mut receiver = Receiver::automatic(40_000_000);
//! let mut sink = |received: Received| { /* hand it to the application */ };
//! let now = 2_000;
//! while let Some(queued) = EDGES.pop() {
//!     match queued {
//!         Queued::Edge(edge) => receiver.edge(edge, &mut sink),
//!         Queued::Overrun => receiver.overrun(&mut sink),
//!     }
//! }
//! receiver.poll(now, &mut sink);
//! ```
//!
//! A byte ends by time, in the middle of its stop bit, never by the next edge: the last byte of a packet arrives without
//! anything after it. `poll` must be called at least once in half a turn of the counter (53 s at 40 MHz) and is usually
//! called a thousand times a second.
//!
//! # Noise
//! A pulse shorter than 0.38 bits changes nothing when it is apart: when nothing else changes within its own length before and
//! after it. A pulse nearer to an edge moves that edge by up to twice its length. Two edges in a row may be moved against each
//! other by less than half a bit, the lateness of interrupts and the difference of the clocks over the bits between them
//! included. A pulse of 0.19 bits beside one of them is harmless with clocks 1 % apart, and so is one of 0.09 bits beside each.
//! Beyond that a byte may be wrong or a [`Received::FramingError`], and the next one is well.
//!
//! # Finding the rate
//! The rate is found from the letter `U` (0x55, ten edges one bit apart) and found again when the other side comes back
//! with another rate: see [`Receiver`].
//!
//! # Receiving by samples
//! A pin that can tell nobody that it changed is read by a timer at three times the bit rate: see [`Sampler`].
//!
//! # Sending
//! A timer interrupt sets the pin and is told when to come again: see [`Transmitter`]. It comes once for each change of
//! level, not once a bit.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod baud;
mod decoder;
mod edge;
mod meter;
mod receiver;
mod ring;
mod sampler;
mod transmitter;

pub use baud::{Baud, BitTime};
pub use decoder::{Decoder, Received};
pub use edge::{Edge, Level};
pub use meter::RateMeter;
pub use receiver::{RateTrust, Receiver};
pub use ring::{ByteRing, EdgeRing, Queued};
pub use sampler::Sampler;
pub use transmitter::{Due, Transmitter};
