//! The Relax's board: small programs on the emulated chip in a simulated home.

mod line;
mod motion;
mod rig;
mod senses;
