//! Figures of the machine. Made by cargo xtask codegen from robots/samsung-sr8730/robot.toml. Do not edit.

/// The machine's name.
pub const DEVICE: &str = "sr8730";
/// The machine's title.
pub const TITLE: &str = "Samsung Navibot SR8730";
/// Radius of the body, µm.
pub const RADIUS_UM: i32 = 175_000;
/// Width that one pass cleans, µm.
pub const SWATH_UM: i32 = 300_000;
/// Usual cleaning speed, µm/s.
pub const CRUISE_UM_PER_S: i32 = 250_000;
/// Highest speed, µm/s.
pub const SPEED_MAX_UM_PER_S: i32 = 350_000;
/// Highest turn rate, µrad/s.
pub const TURN_MAX_URAD_PER_S: i32 = 1_500_000;
/// Cells of the battery in series.
pub const BATTERY_CELLS: i32 = 12;
/// Charging current of a dock that hears the robot, mA.
pub const CHARGE_MA: i32 = 1_000;
/// Number of buttons.
pub const BUTTONS: i32 = 3;
