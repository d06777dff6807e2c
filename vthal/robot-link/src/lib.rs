//! The links that may join a robot's two computers: how one line of a configuration names them ([`LinkAddress`]), what each can
//! ([`Abilities`]), and how bytes pass over those that are more than a pair of wires: one wire for both directions ([`OneWire`]), SPI
//! and I2C, which only the host clocks ([`SpiHost`], [`I2cHost`]).
//!
//! Nothing here opens a device or knows a clock: buses are traits, time is an argument.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod abilities;
mod address;
mod clocked;
mod gpio_line;
mod i2c;
mod one_wire;
mod pace;
mod spi;
mod turn;

pub use abilities::{Abilities, Clocking, Duplex, Idle};
pub use address::{
    AddressError, Direction, I2cAddress, LinkAddress, NetworkAddress, SecureAddress, SpiAddress, UartAddress,
    Wires,
};
pub use clocked::{ClockedHost, TransfersOver};
pub use gpio_line::GpioLine;
pub use i2c::{I2cBus, I2cHost};
pub use one_wire::OneWire;
pub use pace::PollPace;
pub use spi::{SpiBus, SpiHost};
pub use turn::ClockedEnd;
