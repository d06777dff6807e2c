//! The server over real sockets.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

mod attacks;
mod binary;
mod download;
#[path = "../folder/mod.rs"]
mod folder;
mod relay;
mod rig;
