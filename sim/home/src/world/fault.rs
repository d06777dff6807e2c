//! Sensors that lie.

/// A sensor that can be made to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SensorId {
    /// Left half of the bumper.
    BumperLeft,
    /// Right half of the bumper.
    BumperRight,
    /// A cliff sensor by number.
    Cliff(u8),
    /// Left wheel drop switch.
    WheelDropLeft,
    /// Right wheel drop switch.
    WheelDropRight,
    /// A proximity sensor by number.
    Proximity(u8),
    /// Left encoder.
    EncoderLeft,
    /// Right encoder.
    EncoderRight,
    /// Rate and heading of the gyro.
    Gyro,
    /// A dock receiver by number.
    DockReceiver(u8),
    /// The dock's contacts.
    DockContacts,
    /// Battery voltage.
    BatteryVoltage,
    /// Battery temperature.
    BatteryTemperature,
    /// Current of the left wheel motor.
    WheelLeftCurrent,
    /// Current of the right wheel motor.
    WheelRightCurrent,
    /// A button by number.
    Button(u8),
}

/// How a sensor lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorFault {
    /// It shows this count: switches are closed when it is not 0; levels 0..=255; millivolts, milliamperes, tenths of a
    /// degree. A stuck encoder or gyro ignores the number and keeps its last total.
    StuckAt(i32),
    /// Its reading is wrong by a normal random amount of this deviation in its own counts each millisecond; a switch is
    /// inverted with this probability.
    Noisy(f64),
    /// A switch shows the opposite, an encoder or gyro counts backward; levels are mirrored in their range.
    Inverted,
}
