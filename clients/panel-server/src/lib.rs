//! Serves the panel and relays between browsers and vthal.
//!
//! Words used here. A *browser* is one WebSocket connection. Its *upstream* is the Unix socket connection to vthal that belongs to
//! it alone, so that each browser is one client of vthal with its own lease and its own topics. The *outbox* holds what waits
//! to be sent to the browser. The *rules* say which requests are answered. The *gate* protects a robot on a
//! network: TLS under the robot's own certificate authority, and the list of paired clients with their roles.
//!
//! The server decides nothing about the robot: it passes messages on, says `disconnected` while vthal is away, and gives up the
//! driver's seat of a browser that went away. On loopback there is no gate; beyond it nothing bypasses it.
#![forbid(unsafe_code)]

mod announcement;
mod api;
mod assets;
mod browser;
mod buttons;
mod courtesy;
mod download;
#[cfg(test)]
#[path = "../tests/folder/mod.rs"]
mod folder;
mod gate;
mod guarded;
mod identity;
mod matter;
mod outbox;
mod pace;
mod page;
mod pass;
mod reset_file;
mod rules;
mod seats;
mod server;
mod settings;
mod software;
mod system;
mod upstream;
mod write_deadline;

pub use assets::{Assets, AssetsError};
pub use gate::GateError;
pub use guarded::{ClientsError, unix_s};
pub use identity::IdentityError;
pub use outbox::{Outbox, Stalled};
pub use rules::{Refusal, Rules, Scheme};
pub use server::Server;
pub use settings::{Guard, Settings, StartError};
pub use software::free_bytes;
