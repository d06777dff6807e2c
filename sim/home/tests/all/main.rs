//! Homes and what happens in them; one program, so that it is linked once.

#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

mod determinism;
mod foreign_files;
mod generated;
mod hostile_files;
mod hostile_seeds;
mod loaders;
mod maps;
mod odd_things;
mod physics;
mod scene;
mod traps;
