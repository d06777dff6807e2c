//! Start-up code and peripherals of the PIC32MX3xx and MX4xx microcontrollers, written for the PIC32MX360F256L, with the
//! traits of `embedded-hal` 1.0.
//!
//! # A program
//! ```no_run
//! #![no_std]
//! #![no_main]
//! # extern crate std;
//!
//! use embedded_hal::delay::DelayNs;
//! use pic32mx3_hal::configuration::{Configuration, PrimaryOscillator};
//! use pic32mx3_hal::core_timer::Delay;
//! use pic32mx3_hal::gpio::Level;
//! use pic32mx3_hal::{Peripherals, configuration, entry, reset};
//!
//! const CONFIGURATION: Configuration = Configuration::new()
//!     .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
//!     .pll_to_80_mhz();
//! configuration!(CONFIGURATION);
//!
//! fn main() -> ! {
//!     let Some(peripherals) = Peripherals::take() else { reset::software_reset() };
//!     let mut lamp = peripherals.pins.rg7.into_output(Level::Low);
//!     let mut delay = Delay::new(CONFIGURATION.clocks());
//!     loop {
//!         lamp.toggle();
//!         delay.delay_ms(500);
//!     }
//! }
//! entry!(main);
//! # #[cfg(not(target_arch = "mips"))] #[unsafe(no_mangle)] extern "C" fn main_is_elsewhere() {}
//! ```
//! with a `#[panic_handler]`, and a build script that says `cargo:rustc-link-arg=-Tlink.x`. The README describes how it is
//! compiled.
//!
//! # What is where
//! | subject | module | section of the chip's reference |
//! | --- | --- | --- |
//! | configuration words, clocks | [`mod@configuration`], [`clock`], [`oscillator`] | 3, 6 |
//! | pins | [`gpio`], [`change_notice`], [`external`] | 8, 9, 5 |
//! | interrupts, their handlers and what those own | [`mod@interrupt`] | 5 |
//! | time | [`core_timer`], [`timer`], [`calendar`] | 5, 10, 17 |
//! | pulse widths, edges | [`pwm`], [`capture`] | 11, 12 |
//! | ADC, comparators | [`adc`], [`comparator`] | 13, 17 |
//! | UART, SPI, I2C, parallel port | [`uart`], [`spi`], [`i2c`], [`parallel_port`] | 14, 15 |
//! | memory and peripherals without the processor | [`dma`] | 17 |
//! | what can go wrong | [`watchdog`], [`reset`], [`exception`], [`stack`], [`memory`] | 17, 4, 1, 2 |
//! | what stays | [`persistent`], [`flash`] | 16 |
//! | sleeping, sections without interrupts | [`cpu`], [`power`] | 5 |
//!
//! # Safety
//! All functions are safe to call: registers are reached through owners, or through functions whose worst is a wrong level
//! on a pin. The unsafe code is here: register access, coprocessor 0, start-up, the hand-over to handlers, words of memory.
//!
//! # Other machines
//! The crate compiles for every target. Where the processor is no MIPS, registers are plain memory and nothing happens by
//! itself: enough to compile and check programs.
#![no_std]
#![deny(missing_docs)]
#![cfg_attr(target_arch = "mips", feature(asm_experimental_arch))]

#[cfg(test)]
extern crate std;

pub mod adc;
pub mod calendar;
pub mod capture;
pub mod change_notice;
pub mod clock;
pub mod comparator;
pub mod configuration;
pub mod core_timer;
pub mod cpu;
pub mod dma;
pub mod exception;
pub mod external;
pub mod flash;
pub mod gpio;
pub mod i2c;
pub mod interrupt;
pub mod memory;
pub mod oscillator;
pub mod parallel_port;
mod peripherals;
pub mod persistent;
pub mod power;
pub mod pwm;
mod register;
pub mod reset;
pub mod spi;
pub mod stack;
mod start;
pub mod timer;
pub mod uart;
pub mod watchdog;
mod word;

pub use peripherals::Peripherals;
