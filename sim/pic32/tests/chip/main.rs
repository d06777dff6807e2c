//! The chip against the figures of its reference: register by register, through the bus, with small programs where the
//! core takes part.

mod analog;
mod calendar;
mod clock;
mod comparators;
mod compare;
mod dma;
mod flash;
mod halts;
mod i2c;
mod interrupts;
#[path = "../joined/mod.rs"]
mod joined;
mod parallel;
mod pins;
mod power;
mod program;
mod random;
mod reset;
mod serial;
mod spi;
mod timers;
mod trace;
