//! The C cord beside the Rust reference: golden vectors, verdicts on valid and broken packets, damaged packets to an armed
//! cord, and whole sessions.

mod bench;
mod compiled;
mod corrupted;
mod expected;
mod parser;
mod random;
mod reference;
mod sessions;
