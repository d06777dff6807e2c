//! Units of measure shared by the wire, the firmware and the host.
//!
//! A microcontroller without a floating point unit computes in integers, so every quantity that crosses the wire is an
//! integer count of a small SI fraction with the unit in its type. Host code that thinks in `f64` converts at its border
//! with `as_*` and `from_*`. Axes follow REP-103: x forward, y left, angles counter-clockwise positive.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod quantity;
mod tick;

pub use quantity::{
    Angle, AngularSpeed, Current, Frequency, Length, OutOfRange, Ratio, Speed, Temperature, Throttle, Voltage,
};
pub use tick::Tick;
