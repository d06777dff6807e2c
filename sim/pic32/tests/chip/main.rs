//! The chip against the figures of its reference: register by register, through the bus, with small programs where the
//! core takes part.

mod analog;
mod clock;
mod compare;
mod flash;
mod halts;
mod interrupts;
mod pins;
mod program;
mod random;
mod reset;
mod serial;
mod timers;
mod trace;
