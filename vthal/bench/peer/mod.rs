//! The world around a daemon under test: a robot at the far end of a pseudo terminal, clients, and the process itself.
#![allow(
    dead_code,
    unused_imports,
    reason = "each program that shares this module uses another part of it"
)]
#![allow(unreachable_pub, reason = "a module of several programs")]

mod client;
mod process;
mod pty;
mod robot;

pub use client::Client;
pub use process::{Daemon, Scratch, built_beside};
pub use pty::Pty;
pub use robot::SyntheticRobot;
