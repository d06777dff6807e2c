//! Calibration values and their places in the record. Made by cargo xtask codegen from robots/samsung-sr8730/robot.toml. Do not edit.

/// Number of values in a record.
pub const COUNT: usize = 36;

/// A value that a person measures on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibrated {
    /// Wheel distance per count (nm). Needed for drive and move.
    WheelDistancePerCount,
    /// Wheel track (um). Needed for drive and move.
    WheelTrack,
    /// Wheel left order (1). Needed for drive and move.
    WheelLeftOrder,
    /// Wheel right order (1). Needed for drive and move.
    WheelRightOrder,
    /// Wheel dead band (permille). Needed for drive and move.
    WheelDeadBand,
    /// Wheel free speed (mm/s). Needed for drive and move.
    WheelFreeSpeed,
    /// Wheel left current zero (count). Needed for wheel currents.
    WheelLeftCurrentZero,
    /// Wheel right current zero (count). Needed for wheel currents.
    WheelRightCurrentZero,
    /// Wheel current scale (uA/count). Needed for wheel currents.
    WheelCurrentScale,
    /// Brush main pulse rate (pulse/s). Needed for stall detection of the main brush.
    BrushMainPulseRate,
    /// Brush main dead band (permille). Needed for stall detection of the main brush.
    BrushMainDeadBand,
    /// Button ladder 1 (count). Needed for telling the buttons apart.
    ButtonLadder1,
    /// Button ladder 2 (count). Needed for telling the buttons apart.
    ButtonLadder2,
    /// Button ladder 3 (count). Needed for telling the buttons apart.
    ButtonLadder3,
    /// Cliff emitter line (1). Needed for cliff sensors.
    CliffEmitterLine,
    /// Cliff floor level (count). Needed for cliff sensors.
    CliffFloorLevel,
    /// Cliff drop level (count). Needed for cliff sensors, if cliff-emitter-line is 0.
    CliffDropLevel,
    /// Proximity none (count). Needed for proximity sensors.
    ProximityNone,
    /// Proximity touching (count). Needed for proximity sensors.
    ProximityTouching,
    /// Battery scale (uV/count). Needed for charging; without it voltages are reported with the assumed divider.
    BatteryScale,
    /// Charge current zero (count/100). Needed for charging after a start on the dock; off the dock the robot learns it by itself.
    ChargeCurrentZero,
    /// Battery capacity (mAh). Needed for charging and the state of charge.
    BatteryCapacity,
    /// Charge stage checked (1). Needed for charging.
    ChargeStageChecked,
    /// Dock code ones (1). Needed for nothing; a wrong number only leaves the dock at its trickle current.
    DockCodeOnes,
    /// Dock beam left (1). Needed for finding the dock by its beams.
    DockBeamLeft,
    /// Dock beam right (1). Needed for finding the dock by its beams.
    DockBeamRight,
    /// Dock beam near (1). Needed for finding the dock by its beams.
    DockBeamNear,
    /// Dock beam short (us). Needed for finding the dock by its beams.
    DockBeamShort,
    /// Gyro uart (1). Needed for gyro.
    GyroUart,
    /// Gyro rate (baud). Needed for gyro.
    GyroRate,
    /// Gyro frame (1). Needed for gyro.
    GyroFrame,
    /// Thermistor ice (count/10). Needed for knowing the pack's temperature to three degrees; without it the charger keeps a margin of some ten.
    ThermistorIce,
    /// Thermistor warm (count/10). Needed for as thermistor-ice.
    ThermistorWarm,
    /// Thermistor warm temperature (degree/10). Needed for as thermistor-ice.
    ThermistorWarmTemperature,
    /// Thermistor checked (1). Needed for as thermistor-ice.
    ThermistorChecked,
    /// Wheel stall current (mA). Needed for stopping a wheel by its current in time; it is switched off above three quarters of this.
    WheelStallCurrent,
}

impl Calibrated {
    /// Its place in the record.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// What is known of a value before anybody has measured it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which one.
    pub value: Calibrated,
    /// Least value that can be true.
    pub low: i32,
    /// Greatest value that can be true.
    pub high: i32,
    /// What to take while nobody has measured it; `None` = it is unknown then.
    pub assumed: Option<i32>,
}

/// All values, in the order of the record.
pub const ENTRIES: [Entry; COUNT] = [
    Entry {
        value: Calibrated::WheelDistancePerCount,
        low: 1_000,
        high: 50_000_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelTrack,
        low: 100_000,
        high: 500_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelLeftOrder,
        low: 0,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelRightOrder,
        low: 0,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelDeadBand,
        low: 0,
        high: 900,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelFreeSpeed,
        low: 100,
        high: 2_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelLeftCurrentZero,
        low: 0,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelRightCurrentZero,
        low: 0,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelCurrentScale,
        low: -50_000,
        high: 50_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::BrushMainPulseRate,
        low: 1,
        high: 5_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::BrushMainDeadBand,
        low: 0,
        high: 900,
        assumed: None,
    },
    Entry {
        value: Calibrated::ButtonLadder1,
        low: 0,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::ButtonLadder2,
        low: 0,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::ButtonLadder3,
        low: 0,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::CliffEmitterLine,
        low: 0,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::CliffFloorLevel,
        low: 1,
        high: 1_022,
        assumed: None,
    },
    Entry {
        value: Calibrated::CliffDropLevel,
        low: 0,
        high: 1_022,
        assumed: None,
    },
    Entry {
        value: Calibrated::ProximityNone,
        low: 0,
        high: 1_022,
        assumed: None,
    },
    Entry {
        value: Calibrated::ProximityTouching,
        low: 1,
        high: 1_023,
        assumed: None,
    },
    Entry {
        value: Calibrated::BatteryScale,
        low: 25_000,
        high: 45_000,
        assumed: Some(32_549),
    },
    Entry {
        value: Calibrated::ChargeCurrentZero,
        low: -2_000,
        high: 2_000,
        assumed: Some(0),
    },
    Entry {
        value: Calibrated::BatteryCapacity,
        low: 500,
        high: 5_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::ChargeStageChecked,
        low: 0,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::DockCodeOnes,
        low: 5,
        high: 6,
        assumed: Some(6),
    },
    Entry {
        value: Calibrated::DockBeamLeft,
        low: 1,
        high: 255,
        assumed: None,
    },
    Entry {
        value: Calibrated::DockBeamRight,
        low: 1,
        high: 255,
        assumed: None,
    },
    Entry {
        value: Calibrated::DockBeamNear,
        low: 1,
        high: 255,
        assumed: None,
    },
    Entry {
        value: Calibrated::DockBeamShort,
        low: 100,
        high: 3_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::GyroUart,
        low: 1,
        high: 2,
        assumed: None,
    },
    Entry {
        value: Calibrated::GyroRate,
        low: 1_200,
        high: 1_000_000,
        assumed: None,
    },
    Entry {
        value: Calibrated::GyroFrame,
        low: 1,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::ThermistorIce,
        low: 8_300,
        high: 8_800,
        assumed: None,
    },
    Entry {
        value: Calibrated::ThermistorWarm,
        low: 6_500,
        high: 7_600,
        assumed: None,
    },
    Entry {
        value: Calibrated::ThermistorWarmTemperature,
        low: 350,
        high: 450,
        assumed: None,
    },
    Entry {
        value: Calibrated::ThermistorChecked,
        low: 0,
        high: 1,
        assumed: None,
    },
    Entry {
        value: Calibrated::WheelStallCurrent,
        low: 300,
        high: 4_000,
        assumed: Some(2_000),
    },
];
