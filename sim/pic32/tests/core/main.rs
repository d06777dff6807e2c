//! What qemu-user cannot show: privileged instructions, exceptions, interrupts, the map of memory, time.

mod bench;
mod breakpoints;
mod exceptions;
mod interrupts;
mod memory;
mod registers;
mod timer;
mod timing;
