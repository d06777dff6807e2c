//! The board between chip and home, signal by signal, with programs of a few instructions instead of a firmware.

mod analog;
mod link;
mod motion;
mod people;
#[path = "../chip/program.rs"]
#[allow(dead_code, reason = "the tests of the chip use the rest of it")]
mod program;
mod rig;
