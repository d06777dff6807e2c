//! Inputs of the firmware from the simulated pins.

use rvac_units::{Angle, AngularSpeed, Current, Temperature, Voltage};

/// Readings after the last [`super::World::step`], faults included. Arrays hold as many valid entries as the robot has
/// sensors of the kind, the rest stays 0 or false.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensors {
    /// Left encoder total, forward positive, wraps. With one encoder line every count adds.
    pub count_left: i32,
    /// Right encoder total, forward positive, wraps. With one encoder line every count adds.
    pub count_right: i32,
    /// Gyro, if the robot has one.
    pub gyro: Option<GyroReading>,
    /// Left half of the bumper pressed.
    pub bumper_left: bool,
    /// Right half of the bumper pressed.
    pub bumper_right: bool,
    /// Light that each cliff sensor gets, 0..=255, in the order of the model. About 180 on a floor with the emitter on,
    /// about 10 over a drop, about 10 (the room's light) with the emitter off.
    pub cliff_levels: [u8; 4],
    /// The same with the emitters off, even if they are on now: for circuits that sample within a millisecond.
    pub cliff_dark: [u8; 4],
    /// Left wheel hangs.
    pub wheel_drop_left: bool,
    /// Right wheel hangs.
    pub wheel_drop_right: bool,
    /// Infrared proximity, from the right side counter-clockwise, 0 = nothing, 255 = touching.
    pub proximity: [u8; 8],
    /// Symbols of each dock receiver: the sum of [`DOCK_LEFT`], [`DOCK_RIGHT`] and [`DOCK_NEAR`]; 0 = nothing.
    pub dock_receivers: [u8; 4],
    /// The dock's contacts touch and carry voltage.
    pub dock_contacts: bool,
    /// At the pack's terminals.
    pub battery_voltage: Voltage,
    /// Into the pack positive.
    pub battery_current: Current,
    /// Of the pack.
    pub battery_temperature: Temperature,
    /// Current of the left wheel motor, never negative.
    pub wheel_left_current: Current,
    /// Current of the right wheel motor, never negative.
    pub wheel_right_current: Current,
    /// Current of the main brush motor, never negative.
    pub brush_main_current: Current,
    /// The dust box is in.
    pub dust_box: bool,
    /// Buttons that are down, bit by number.
    pub buttons: u8,
}

/// What the gyro module reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GyroReading {
    /// Integrated heading since switch-on, in whole steps of the module's resolution; wraps through the whole range.
    pub heading: Angle,
    /// Present rate.
    pub rate: AngularSpeed,
}

/// One turn of the lidar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LidarScan {
    /// Counts the turns.
    pub turn: u32,
    /// Distances in metres, the first straight ahead, counter-clockwise; 0 = nothing within range.
    pub ranges_m: Vec<f32>,
}

/// Symbol of the beam that fills the left half as seen by a robot that approaches the dock.
pub const DOCK_LEFT: u8 = 1;
/// Symbol of the beam that fills the right half.
pub const DOCK_RIGHT: u8 = 2;
/// Symbol of the weak beam that reaches half a metre to all sides.
pub const DOCK_NEAR: u8 = 4;
