//! A robot's description for the simulator, read from `robots/<name>/robot.toml`.

mod catalog;
mod deviation;
mod figure;
mod parse;
mod raw;

use std::path::PathBuf;

pub use catalog::robot_names;
pub use figure::Confidence;

/// A robot: geometry, limits, motors, sensors, battery. SI units, REP-103 axes, poses relative to the centre between
/// the wheels.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotModel {
    /// Short name, as in the handshake: `sr8730`.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// The body.
    pub body: BodyModel,
    /// Wheels as geometry and limits.
    pub drive: DriveModel,
    /// Wheel motors.
    pub wheel_motor: WheelMotor,
    /// What the cleaning motors draw.
    pub cleaners: Cleaners,
    /// The bumper.
    pub bumper: BumperModel,
    /// Cliff sensors: left, middle, right for three; in the order of the file.
    pub cliffs: Vec<CliffMount>,
    /// Wheel drop switches: 2 = one a wheel, 1 = one for all, 0 = none.
    pub wheel_drops: u8,
    /// Infrared proximity sensors from the right side counter-clockwise.
    pub proximity: Option<ProximityModel>,
    /// The gyro.
    pub gyro: Option<GyroModel>,
    /// Dock receivers: left, right, rear left, rear right.
    pub dock_receivers: Vec<ReceiverMount>,
    /// The battery.
    pub battery: BatteryModel,
    /// Number of buttons.
    pub buttons: u8,
    /// A turning lidar.
    pub lidar: Option<LidarModel>,
}

/// The body seen from above: a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyModel {
    /// Radius in metres.
    pub radius_m: f64,
    /// Width that one pass cleans, metres.
    pub swath_m: f64,
    /// Highest step the wheels climb, metres.
    pub climb_m: f64,
}

/// Wheels as geometry and limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveModel {
    /// Distance between the wheels' contact points, metres.
    pub track_m: f64,
    /// Distance of the rim per encoder count, metres.
    pub count_m: f64,
    /// Encoder lines per wheel: 2 give the direction, with 1 every count adds.
    pub encoder_lines: u8,
    /// Usual cleaning speed, m/s.
    pub cruise_m_per_s: f64,
    /// Highest forward speed, m/s.
    pub speed_max_m_per_s: f64,
    /// Highest turn rate, rad/s.
    pub turn_max_rad_per_s: f64,
}

/// A wheel motor with its gear and bridge, referred to the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelMotor {
    /// Rim speed at full drive without load at the nominal battery voltage, m/s.
    pub free_speed_m_per_s: f64,
    /// Force at the rim that stops the motor at full drive, newton.
    pub stall_force_n: f64,
    /// Current at that load, ampere.
    pub stall_current_a: f64,
    /// Current without load, ampere.
    pub idle_current_a: f64,
    /// Share of full drive below which the wheel does not turn, bridge braking in the off-time (slow decay).
    pub dead_band_brake: f64,
    /// The same with the bridge coasting in the off-time (fast decay).
    pub dead_band_coast: f64,
    /// Time constant of the speed under drive, seconds.
    pub lag_s: f64,
    /// Greatest force one wheel brings on a hard floor before it slips, newton.
    pub traction_n: f64,
}

/// What the cleaning motors draw at the nominal voltage, ampere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cleaners {
    /// Main brush at full drive.
    pub main_a: f64,
    /// Side brushes.
    pub sides_a: f64,
    /// Suction.
    pub vacuum_a: f64,
}

/// The bumper: an arc in front on springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BumperModel {
    /// The bumper spans this angle to each side of straight ahead, radians.
    pub half_arc_rad: f64,
    /// A contact within this angle of straight ahead presses both halves, radians.
    pub overlap_rad: f64,
    /// Travel until it is fully pressed, metres.
    pub travel_m: f64,
    /// Travel after which a switch closes, metres.
    pub switch_m: f64,
    /// Force of the springs at full travel, newton.
    pub force_n: f64,
}

/// Place of a downward looking sensor, metres from the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CliffMount {
    /// Forward.
    pub x_m: f64,
    /// Left.
    pub y_m: f64,
}

/// Infrared proximity sensors at the rim, each facing straight outward.
#[derive(Clone, Debug, PartialEq)]
pub struct ProximityModel {
    /// Direction of each sensor from straight ahead, radians, from the right side counter-clockwise.
    pub headings_rad: Vec<f64>,
    /// Distance of the sensors from the centre, metres.
    pub mount_radius_m: f64,
    /// Nothing is seen beyond this distance from the sensor, metres.
    pub range_m: f64,
    /// Half of the beam's opening, radians.
    pub half_angle_rad: f64,
    /// Distance at which a white wall gives half of the full level, metres.
    pub half_level_m: f64,
    /// Distance at which a white wall makes a sensor with one line switch, metres; `None` = it reports levels.
    pub near_m: Option<f64>,
}

/// A gyro around the upward axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroModel {
    /// Smallest step of the integrated heading, radians.
    pub resolution_rad: f64,
}

/// An infrared receiver for the dock's beams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverMount {
    /// Direction from straight ahead, radians.
    pub heading_rad: f64,
    /// It receives up to this angle to each side, radians.
    pub half_angle_rad: f64,
}

/// A NiMH pack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatteryModel {
    /// Cells in series.
    pub cells: u8,
    /// Capacity in ampere hours.
    pub capacity_ah: f64,
    /// Internal resistance of the pack, ohm.
    pub resistance_ohm: f64,
    /// What the electronics draw, ampere.
    pub electronics_a: f64,
    /// Current of the dock when it receives the robot's code, ampere.
    pub charge_a: f64,
    /// Current of the dock when it does not, ampere.
    pub trickle_a: f64,
}

/// A turning lidar above the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LidarModel {
    /// Farthest distance, metres.
    pub range_m: f64,
    /// Beams per turn, evenly spaced, the first straight ahead, counter-clockwise.
    pub beams: u16,
    /// Turns per second.
    pub turns_hz: f64,
    /// Noise of a distance, relative, one standard deviation.
    pub noise: f64,
}

/// Why a robot description cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// No robot has this name.
    #[error("there is no robot called `{name}`; known robots: {known}")]
    Unknown {
        /// The name asked for.
        name: String,
        /// The known names, separated by commas.
        known: String,
    },
    /// The file cannot be read.
    #[error("cannot read the robot description {}: {cause}; check the path", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The text is not a robot description.
    #[error("the robot description {origin} is not valid: {message}; robots/README.md tells the format")]
    Format {
        /// The file, or the name of the built-in robot.
        origin: String,
        /// Where and what.
        message: String,
    },
    /// A value is impossible.
    #[error("in the robot description {origin}, `{key}` {problem}")]
    Value {
        /// The file, or the name of the built-in robot.
        origin: String,
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
}
