//! The charger: from raw readings of the pack to the duty of the switch. The table of states and stops is that of
//! SAFETY.md; all of it runs here, pure and in integers, and the board only measures and gates.
//!
//! Words: a *charge* begins with the first current and lasts until it has ended, interruptions of up to ten minutes
//! included. A *phase* is a state of the machine, see [`ChargePhase`](rvac_protocol::message::ChargePhase). A *stop* is
//! one of eight independent conditions that end the phase of full current, an *end* is the stop that did. A *fault*
//! stops for good, until a person clears it. The *window* is the range of temperatures in which current may begin.
//! *Slow* current is a tenth of the capacity an hour.
//!
//! Time is counted in spans between passes, never by comparing clocks: nothing here knows that the clock wraps.

mod controller;
mod faults;
mod gauge;
mod guard;
mod history;
mod meter;
mod phases;
mod regulate;
mod scale;
mod stillness;
mod stops;
mod thermometer;
mod zero;

pub use controller::{ChargeContext, ChargeController, ChargeOutput, Motors};
pub use stops::{AllStops, Stops};

pub(crate) use thermometer::Thermometer;
