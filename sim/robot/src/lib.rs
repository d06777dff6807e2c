//! cordlib on simulated pins
