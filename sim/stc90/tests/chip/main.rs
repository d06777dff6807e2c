//! The chip's peripherals, each with small programs.

mod core;
mod flash;
mod interrupts;
mod memory;
mod pins;
mod power;
mod random;
mod rig;
mod serial;
mod timers;
mod watchdog;
