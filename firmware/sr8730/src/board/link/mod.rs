//! The link to the Linux board. What it is made of is chosen at build time, one of these:
//!
//! | feature | link |
//! | --- | --- |
//! | none | a software UART: it receives on RC13 by change notice and sends on RB7 ([`uart`]) |
//! | `link-sampled` | the same, receiving on RB6 by samples, for a board on which RC13 does not reach the connector |
//! | `link-rs485` | either of them, with RG2 to switch the driver of a pair on while something is sent |
//! | `link-spi` | slave on SPI 1 ([`spi`]) |
//! | `link-i2c` | slave on I2C 1 ([`i2c`]) |

pub mod brush;
#[cfg(feature = "link-i2c")]
pub mod i2c;
#[cfg(feature = "link-spi")]
pub mod spi;
#[cfg(serial_link)]
pub mod uart;

#[cfg(feature = "link-i2c")]
pub use i2c::{I2cLink as BoardLink, port_c};
#[cfg(feature = "link-spi")]
pub use spi::{SpiLink as BoardLink, port_c};
#[cfg(serial_link)]
pub use uart::SerialLink as BoardLink;
#[cfg(serial_link)]
pub use uart::by_edges::port_c;
