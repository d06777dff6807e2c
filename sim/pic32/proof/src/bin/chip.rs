//! The work on the chip: rounds without end, each told by a system call that the emulator's caller answers.
#![no_std]
#![no_main]
#![feature(asm_experimental_arch)]

use core::arch::global_asm;

#[path = "../tell.rs"]
mod tell;

global_asm!(
    ".section .reset, \"ax\", @progbits",
    ".set noreorder",
    ".globl __start",
    "__start:",
    "la $sp, __stack_top",
    "la $t9, chip_main",
    "jr $t9",
    "nop",
    ".section .librervac.part, \"\", @progbits",
    ".asciz \"PIC32MX360F256L\"",
    ".text",
);

#[unsafe(no_mangle)]
extern "C" fn chip_main() -> ! {
    let mut number = 0_u32;
    loop {
        tell::round(number);
        number = number.wrapping_add(1);
    }
}
