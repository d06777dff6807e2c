//! Fuzz target: both sessions, fed with anything.
#![no_main]

#[path = "../bodies.rs"]
mod bodies;

libfuzzer_sys::fuzz_target!(|input: &[u8]| bodies::sessions(input));
