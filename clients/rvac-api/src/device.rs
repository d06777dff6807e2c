//! The readings of the robot's parts, as a table.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::Versions;

/// The device information table of the panel. What is not measured is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct DeviceTable {
    /// Versions of all parts.
    pub versions: Versions,
    /// Battery.
    #[serde(default)]
    pub battery: Option<BatteryReading>,
    /// Passes of the firmware's main loop per second.
    #[serde(default)]
    pub main_loop_hz: Option<u32>,
    /// Bytes per second, Linux board to robot.
    pub bytes_out_per_s: f64,
    /// Bytes per second, robot to Linux board.
    pub bytes_in_per_s: f64,
    /// Link quality.
    pub link: LinkReading,
    /// Speed of the left wheel, m/s.
    pub wheel_left_m_per_s: f64,
    /// Speed of the right wheel, m/s.
    pub wheel_right_m_per_s: f64,
    /// Left and right bumper pressed.
    pub bumpers: [bool; 2],
    /// Left, middle and right cliff sensors see no floor.
    pub cliffs: [bool; 3],
    /// Left and right wheel hang.
    pub wheel_drops: [bool; 2],
    /// Proximity 0..1 from the right side counter-clockwise.
    pub proximity: Vec<f32>,
    /// Motor currents in amperes: left wheel, right wheel, main brush. One that the robot lists as `unmeasured` is 0.
    #[serde(default)]
    pub currents_a: Option<[f32; 3]>,
    /// Main brush, side brushes, suction run.
    pub cleaners: [bool; 3],
    /// Dust box is in; `null` where nothing watches it.
    #[serde(default)]
    pub dust_box: Option<bool>,
    /// On the dock.
    pub docked: bool,
    /// What the daemon takes of its computer; absent in its first second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub daemon: Option<DaemonLoad>,
}

/// What the daemon takes of its computer, measured once a second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct DaemonLoad {
    /// Memory in use, bytes; absent where the system does not tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<u64>,
    /// Seconds for which its loop has worked since its start: the brain, and all else between two waits.
    pub busy_s: f64,
    /// The longest that it worked at one thing in the last second, ms. Nothing else is answered meanwhile.
    pub longest_turn_ms: f64,
}

/// Battery readings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct BatteryReading {
    /// 0..1.
    pub charge: f64,
    /// Volts.
    pub voltage_v: f64,
    /// Amperes, into the pack positive.
    pub current_a: f64,
    /// Degrees Celsius; absent when it cannot be measured.
    pub temperature_c: Option<f64>,
    /// `discharging`, `charging`, `full`, `fault`.
    pub state: String,
    /// The charger, where the firmware controls it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub charger: Option<ChargerReading>,
}

/// What the charger does. Names are those of the protocol.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct ChargerReading {
    /// `idle`, `precharge`, `fast`, `top-off`, `maintain`, `fault`.
    pub phase: String,
    /// How the last charge ended, for example `slope`.
    pub end: Option<String>,
    /// What is wrong, for example `thermistor-open`.
    pub fault: Option<String>,
}

/// Link quality.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct LinkReading {
    /// Telemetry is fresh.
    pub up: bool,
    /// Age of the newest telemetry in ms.
    pub age_ms: u32,
    /// Share of bad packets over the last 5 s, both directions, 0..1.
    pub bad_share: f64,
    /// Median round trip in ms.
    #[serde(default)]
    pub round_trip_ms: Option<f64>,
    /// Robot resets since the daemon's start.
    pub resets: u32,
    /// Cause of the robot's last reset.
    #[serde(default)]
    pub reset_cause: Option<String>,
    /// Times the serial device was lost and found again.
    pub reconnects: u32,
    /// Binary telemetry is in use.
    pub binary: bool,
}
