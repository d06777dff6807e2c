//! The firmware's shared logic on a board of plain values; one program, so that it is linked once.

mod absence;
mod arming;
mod charge_faults;
mod charging;
mod dock;
mod gate;
mod housekeeping;
mod latches;
mod minimal_board;
mod motion;
mod panic;
mod power;
mod probing;
mod reverse;
mod rig;
mod stopping;
mod thermistor;
mod wire;
