//! The deterministic core of the vthal daemon
