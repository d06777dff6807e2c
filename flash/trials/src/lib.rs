//! Programmers against the simulated chips: the same sequences that drive real lines drive these, on a virtual clock.
//!
//! [`SimulatedIcsp`] joins the lines of `pic32-icsp` to the port of the emulated PIC32, with what can happen on the way: a host that
//! sleeps, wires that are swapped, noise, a supply that fails, a process that is killed. [`SimulatedLine`] does the same for
//! `stc-isp` and the loader of the emulated STC90; [`LoaderTerminal`] puts that loader behind a pseudo terminal, for other flashers.
//! [`update_world`] is a board with a robot for whole updates, whose supply fails at any step ([`update_cuts`]).
//! The program `bench-flash` is the campaign: `cargo xtask test flash`.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod emulated_update;
pub mod fixtures;
mod icsp_pins;
mod isp_line;
mod jtag_server;
mod loader_terminal;
pub mod signed_update;
pub mod update_cuts;
pub mod update_model;
pub mod update_world;

pub use icsp_pins::{Interruption, LinesLost, SimulatedIcsp, WireFaults};
pub use isp_line::{HostFaults, SimulatedLine, SupplyLost};
pub use jtag_server::serve_jtag;
pub use loader_terminal::LoaderTerminal;
