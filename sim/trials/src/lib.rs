//! The robot's real firmware under faults, in the emulated chip: how fast each safety rule reacts, from an event at a
//! pin to the motors' compare registers, at any phase of the firmware's loop and interrupts.
//!
//! A [`Testbed`] is a robot with its image and a host that only implements the protocol. A [`Trial`] is an operating
//! state, an event at a known cycle, and the expected reaction with its time limit. That is the SR8730; [`relax`] does the same
//! with the other robot's chip.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod buses;
mod campaign;
mod catalog;
pub mod charges;
mod draw;
mod ending;
pub mod flips;
pub mod flood;
pub mod limits;
pub mod measured;
pub mod relax;
mod scene;
mod testbed;
mod trial;
pub mod wiring;

pub use campaign::{Campaign, TrialSummary};
pub use catalog::trials;
pub use ending::{CampaignError, conclude};
pub use scene::OperatingState;
pub use testbed::{Fixture, Testbed, TestbedError};
pub use trial::{Allowance, Expectation, MotorGroup, Trial, TrialOutcome};
