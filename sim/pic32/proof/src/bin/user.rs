//! The work as a process of Linux: sixteen rounds, then the end.
#![no_std]
#![no_main]
#![feature(asm_experimental_arch)]

use core::arch::global_asm;

#[path = "../tell.rs"]
mod tell;

/// Rounds that are told.
const ROUNDS: u32 = 16;

global_asm!(
    ".section .reset, \"ax\", @progbits",
    ".set noreorder",
    ".globl __start",
    "__start:",
    "la $sp, __stack_top",
    "la $t9, user_main",
    "jr $t9",
    "nop",
    ".text",
);

#[unsafe(no_mangle)]
extern "C" fn user_main() -> ! {
    (0..ROUNDS).for_each(tell::round);
    loop {
        tell::exit();
    }
}
