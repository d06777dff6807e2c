//! The battery and its charger.

mod gauge;

pub(crate) use gauge::charge_of;
