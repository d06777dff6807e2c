//! Charge control for NiMH packs: from raw readings to the duty of the charger's switch. SAFETY.md lists states and stops.
//! All of it runs here, in integers and without access to hardware; the board only measures and switches.
//!
//! Terms: a *charge* begins with the first current and lasts until it has ended, interruptions of up to 31 minutes
//! included. A *phase* is a state of the state machine, see [`ChargePhase`](rvac_protocol::message::ChargePhase). A *stop*
//! is one of eight independent termination criteria of the phase of full current (dT/dt, -dV, 0dV, dT and four limits); an
//! *end* is the stop that applied. A *fault* stops charging until a person clears it. The *window* is the range of
//! temperatures in which a charge may begin. *Slow* current is C/10, a tenth of the capacity per hour.
//!
//! Time is summed up from pass to pass and never compared with a clock, so the wrap of the clock does not matter.

mod cold_rate;
mod controller;
mod current_offset;
mod faults;
mod frozen_sensor;
mod gauge;
mod guard;
mod history;
mod memory;
mod meter;
mod phases;
mod regulate;
mod scale;
mod stops;
mod thermometer;

pub use controller::{ChargeContext, ChargeController, ChargeOutput, Docking, MotorActivity};
pub use memory::ChargeMemory;
pub use stops::{AllStops, Stops};

pub(crate) use thermometer::Thermometer;
