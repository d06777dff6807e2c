//! Facts about the board as constants. Made by cargo xtask codegen. Do not edit.

pub mod calibration;
pub mod machine;
pub mod pins;
pub mod variant;
