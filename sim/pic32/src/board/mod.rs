//! The board of the SR8730: what stands between the microcontroller's pins and the simulated home.
//!
//! Which pin does what is read from `robots/samsung-sr8730/pinout.toml`, what nobody has measured yet from the
//! calibration table of `robot.toml` beside it.
