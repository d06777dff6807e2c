//! The C cord beside the Rust reference: golden vectors, and verdicts on valid and broken packets.

mod compiled;
mod parser;
mod random;
