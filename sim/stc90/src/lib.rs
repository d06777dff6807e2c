//! An STC90C58RD+, the 8051 of the Vileda Relax, that runs a firmware image.
//!
//! An [`image::Image`] (Intel HEX) is executed by a [`machine::Machine`]: a [`cpu::Cpu`], which knows only the core, and
//! the peripherals around it ([`peripheral`]), behind the trait [`cpu::Bus`]. A circuit is built around [`pins`] and whole
//! frames of the serial line; [`board`] is that of the Relax in a simulated home, [`hosted`] adds a host. There is no clock, no thread and no
//! randomness of its own: the same image and the same calls give the same bits, and every state can be cloned.
//!
//! # What is followed where sources differ
//!
//! The core is compared with uCsim, instruction by instruction. Facts about the part come from public sources other than
//! its data sheet; what is doubtful is said where it is used. In these places uCsim is not followed:
//!
//! | place | uCsim 0.6 | here |
//! | --- | --- | --- |
//! | an interrupt's call | begins with the cycle in which the flag is set, takes one cycle | begins a cycle later, takes two, as the 8052 is documented |
//! | MOVX with R0 or R1 | upper half of the address from P2 | first 256 bytes of the memory on the chip: P2 drives motors and lamps |
//! | MOVX beyond 0x3FF | more memory | recorded as [`peripheral::Misuse`]; reads 0xFF |
//! | code beyond 0x7FFF | more memory | recorded as misuse; executed as instructions without effect |
//! | stack beyond 0xFF | stops with an error | goes on at 0, as the chip does; recorded as misuse |
//! | PSW | a parity that was written stays until A changes; RS0 and RS1 written as bits change no bank | parity is that of A; banks change |
//! | timer 0 in mode 3 | TR1 starts and stops timer 1 | timer 1 runs on, as documented |
//! | DJNZ on a timer's byte | in the second cycle | in the first, as all other accesses |
//! | AUXR, XICON, P4, WDT_CONTR, ISP registers, SADDR, 6T | plain bytes | modelled |
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
pub mod cpu;
pub mod hosted;
pub mod image;
pub mod loader;
pub mod machine;
pub mod peripheral;
pub mod pins;

/// The part that is emulated.
pub const PART: &str = "STC90C58RD+";
