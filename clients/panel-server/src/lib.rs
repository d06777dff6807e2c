//! Serves the panel and relays between browsers and vthal.
//!
//! Words used here. A *browser* is one WebSocket connection. Its *upstream* is the Unix socket connection to vthal that belongs to
//! it alone, so that vthal sees each browser as one client with its own lease and its own topics. The *outbox* holds what waits
//! to be sent to the browser. The *rules* say which requests are answered at all.
//!
//! The server decides nothing about the robot: it passes messages on, says `disconnected` while vthal is away, and gives up the
//! driver's seat of a browser that went away. There is no authentication yet, so it stays on loopback unless it is told to
//! open itself to the network.
#![forbid(unsafe_code)]

mod assets;
mod browser;
mod courtesy;
mod outbox;
mod rules;
mod server;
mod settings;
mod upstream;

pub use assets::{Assets, AssetsError};
pub use outbox::{Outbox, Stalled};
pub use rules::{Refusal, Rules};
pub use server::Server;
pub use settings::{NetworkAccess, Settings, StartError};
