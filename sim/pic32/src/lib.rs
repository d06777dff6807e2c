//! A PIC32MX360F256L that runs a firmware image, and the board of the SR8730 around it.
//!
//! An [`image::Image`] (ELF or Intel HEX) is put into a [`memory::Memory`] and executed by a [`cpu::Cpu`], which knows the
//! M4K core and nothing else of the chip: peripherals are behind the trait [`cpu::Bus`]. Time is counted in cycles of the
//! 80 MHz system clock since power-on. There is no clock, no thread and no randomness of its own: the same image and the
//! same calls give the same bits, and every state can be cloned.
//!
//! Facts about the chip come from public sources other than its data sheet; what is doubtful is said where it is used.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
pub mod cpu;
pub mod gdb;
pub mod icsp;
pub mod image;
pub mod machine;
pub mod memory;
pub mod peripheral;
pub mod pins;
pub mod trace;
