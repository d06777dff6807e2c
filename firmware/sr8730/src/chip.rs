//! Entry points of the chip: start-up before memory is initialised, the program, and the handlers for panics and
//! exceptions.

use core::arch::global_asm;
use core::panic::PanicInfo;

use pic32mx3_hal::configuration::{Configuration, PrimaryOscillator};
use pic32mx3_hal::exception::{Exception, ExceptionKind};
use pic32mx3_hal::{Peripherals, configuration, entry, exception_hook, image_crc, reset};

use sr8730::board::off;
use sr8730::generated::pins;
use sr8730::logic::image_check::NO_CRC;
use sr8730::logic::reset_log::FatalCause;
use sr8730::robot::{self, RobotProgram};

/// 8 MHz crystal, 80 MHz for processor and peripherals, clock monitor, and a watchdog of 128 ms that runs from the
/// first instruction and cannot be stopped by a flipped bit.
const CONFIGURATION: Configuration = Configuration::new()
    .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
    .pll_to_80_mhz()
    .clock_monitor(true)
    .watchdog_period_ms(128)
    .watchdog_always();
configuration!(CONFIGURATION);
image_crc!(NO_CRC);
entry!(main);
exception_hook!(on_exception);

fn main() -> ! {
    match Peripherals::take() {
        Some(chip) => RobotProgram::new(chip).run(),
        None => reset::software_reset(),
    }
}

fn on_exception(exception: &Exception) -> ! {
    robot::fail_safe_reset(match exception.kind() {
        ExceptionKind::UnhandledInterrupt => FatalCause::StrayInterrupt,
        _ => FatalCause::Exception,
    })
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    robot::fail_safe_reset(FatalCause::Panic)
}

#[cfg(serial_link)]
global_asm!(
    ".set push",
    ".set noreorder",
    ".set noat",
    ".set mips32r2",
    ".set nomips16",
    include_str!("link.S"),
    ".set pop",
    ".text",
    edges = sym sr8730::board::link::uart::by_edges::EDGES,
    runs = sym sr8730::board::link::uart::RUNS,
    rs485 = const cfg!(feature = "link-rs485") as u32,
);

// Before variables are initialised: the levels of all outputs, then a march test of memory (S21). It runs in registers
// only, because it overwrites all memory that it tests, the stack included. Memory that survives a reset is left out.
//
// Up with 0 written; up reading 0 writing 1; up reading 1 writing 0; down reading 0 writing 1; down reading 1 writing
// 0; reading 0 (March C-). A faulty cell stops the start here, with all outputs safe, until the watchdog resets the
// chip.
global_asm!(
    ".set push",
    ".set noreorder",
    ".section .text.pre_init, \"ax\"",
    ".globl __pre_init",
    ".type __pre_init, @function",
    "__pre_init:",
    "move $s0, $ra",
    "jal __default_pre_init",
    "nop",
    "jal sr8730_safe_outputs",
    "nop",
    "lui $a0, 0x8000",
    "lui $a1, %hi(__bss_end)",
    "addiu $a1, $a1, %lo(__bss_end)",
    "jal sr8730_march",
    "nop",
    "lui $a0, %hi(__stack_bottom)",
    "addiu $a0, $a0, %lo(__stack_bottom)",
    "lui $a1, %hi(__stack_top)",
    "addiu $a1, $a1, %lo(__stack_top)",
    "jal sr8730_march",
    "nop",
    "jr $s0",
    "nop",
    ".size __pre_init, . - __pre_init",
    // One region, from a0 up to a1.
    ".type sr8730_march, @function",
    "sr8730_march:",
    "li $t1, -1",
    "move $t0, $a0",
    "2: addiu $t0, $t0, 4",
    "bne $t0, $a1, 2b",
    "sw $zero, -4($t0)",
    "move $t0, $a0",
    "3: lw $t2, 0($t0)",
    "bnez $t2, 9f",
    "sw $t1, 0($t0)",
    "addiu $t0, $t0, 4",
    "bne $t0, $a1, 3b",
    "nop",
    "move $t0, $a0",
    "4: lw $t2, 0($t0)",
    "bne $t2, $t1, 9f",
    "sw $zero, 0($t0)",
    "addiu $t0, $t0, 4",
    "bne $t0, $a1, 4b",
    "nop",
    "move $t0, $a1",
    "5: addiu $t0, $t0, -4",
    "lw $t2, 0($t0)",
    "bnez $t2, 9f",
    "sw $t1, 0($t0)",
    "bne $t0, $a0, 5b",
    "nop",
    "move $t0, $a1",
    "6: addiu $t0, $t0, -4",
    "lw $t2, 0($t0)",
    "bne $t2, $t1, 9f",
    "sw $zero, 0($t0)",
    "bne $t0, $a0, 6b",
    "nop",
    "move $t0, $a0",
    "7: lw $t2, 0($t0)",
    "addiu $t0, $t0, 4",
    "bnez $t2, 9f",
    "nop",
    "bne $t0, $a1, 7b",
    "nop",
    "jr $ra",
    "nop",
    "9: b 9b",
    "nop",
    ".size sr8730_march, . - sr8730_march",
    ".set pop",
    ".text",
    options(raw)
);

/// Pins that are outputs of the board and inputs of a link by SPI, whose master may drive them already.
const fn link_inputs(port: pins::Port) -> u16 {
    match port {
        pins::Port::F if cfg!(feature = "link-spi") => off::mask(pins::GYRO_POWER),
        _ => 0,
    }
}

/// Called first by the code above: sets every output to its safe level, then sets its direction.
#[unsafe(no_mangle)]
extern "C" fn sr8730_safe_outputs() {
    for start in pins::START {
        let port = off::port_of(start.port);
        port.write(u16::MAX, start.lat as u16);
        port.release(start.tris as u16);
        port.drive(!(start.tris as u16) & !link_inputs(start.port));
    }
}
