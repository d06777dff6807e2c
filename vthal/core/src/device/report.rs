//! What a device reports again and again, in SI units.

use brain::Inhibits;
use brain::config::PROXIMITY_MAX;
use brain::observation::{Cliffs, Contacts, MotorCurrents};

/// Most dock receivers that a report holds.
pub const DOCK_RECEIVERS_MAX: usize = 4;

/// Telemetry. Totals, not rates, so that a lost report loses nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Milliseconds since the robot started, by its own clock; `None` without one.
    pub uptime_ms: Option<u32>,
    /// Way of the wheels.
    pub travel: WheelTravel,
    /// Total of its gyro in microradians counter-clockwise, wrapping; `None` without a gyro.
    pub heading_urad: Option<i32>,
    /// Whether a command or a reflex drives the wheels.
    pub is_driven: bool,
    /// Bumper zones that are pressed, or were since the last report; a robot with one zone reports it on the left.
    pub contacts: Contacts,
    /// Cliff sensors that see no floor, or saw none since the last report.
    pub cliffs: Cliffs,
    /// Wheels that hang, or hung since the last report.
    pub wheel_drops: WheelDrops,
    /// Proximity from the right side counter-clockwise, 0..1 (1 = touching); as many count as the description says.
    pub proximity: [f32; PROXIMITY_MAX],
    /// Symbols received by the dock receivers (0 = none); as many count as the description says.
    pub dock_beams: [u8; DOCK_RECEIVERS_MAX],
    /// On the dock's contacts.
    pub docked: bool,
    /// The dust box is in; `None` where nothing watches it.
    pub dust_box: Option<bool>,
    /// What of brushes and suction runs.
    pub cleaners: CleanersRunning,
    /// Buttons that are down, bit by number: 0 starts and stops, 2 sends home, others are the make's own.
    pub buttons: u8,
    /// What the motors draw; `None` where the robot does not measure it.
    pub currents: Option<MotorCurrents>,
    /// What keeps it from moving.
    pub inhibits: Inhibits,
}

/// Distance of the wheels since the robot was first described, forward positive. It goes on when the link was lost and when the
/// robot has started anew.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelTravel {
    /// Rim of the left wheel in metres.
    pub left_m: f64,
    /// Rim of the right wheel in metres.
    pub right_m: f64,
    /// Speeds of the rims, where the make knows them better than the host can compute from two reports.
    pub speeds: Option<WheelSpeeds>,
}

/// Speeds of the wheels' rims.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelSpeeds {
    /// Of the left one, m/s.
    pub left_m_per_s: f64,
    /// Of the right one, m/s.
    pub right_m_per_s: f64,
}

/// Wheels that hang.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WheelDrops {
    /// The left one.
    pub left: bool,
    /// The right one.
    pub right: bool,
}

/// What of brushes and suction runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CleanersRunning {
    /// The main brush.
    pub brush_main: bool,
    /// The side brushes.
    pub brush_sides: bool,
    /// Suction.
    pub vacuum: bool,
}

impl WheelDrops {
    /// Whether any wheel hangs.
    #[must_use]
    pub const fn any(self) -> bool {
        self.left || self.right
    }
}

/// What changes slowly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlowFacts {
    /// Version of the library in the firmware, where it has one.
    pub library: Option<String>,
    /// Passes of the firmware's main loop in the last second, where it counts them.
    pub main_loop_hz: Option<u32>,
    /// The battery, if measured.
    pub battery: Option<Battery>,
}

/// Readings of the battery.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    /// Charge, 0..1.
    pub charge: f64,
    /// Voltage of the pack, volts.
    pub voltage_v: f64,
    /// Into the pack is positive, amperes.
    pub current_a: f64,
    /// Temperature of the pack, degrees Celsius; `None` when it cannot be measured.
    pub temperature_c: Option<f64>,
    /// What the charger does.
    pub state: ChargeState,
    /// More about the charger, where the firmware controls it.
    pub charger: Option<Charger>,
}

/// What the charger does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChargeState {
    /// No current flows in.
    Discharging,
    /// Current flows in.
    Charging,
    /// The pack is full.
    Full,
    /// The charger has stopped for a fault.
    Fault,
}

/// More about a charger, in the words of the make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Charger {
    /// What it does.
    pub phase: &'static str,
    /// Why it last ended.
    pub end: Option<&'static str>,
    /// What is wrong with it.
    pub fault: Option<&'static str>,
    /// It does not charge because of a fault.
    pub has_failed: bool,
}

/// How good the link is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkQuality {
    /// What has come since the line was opened.
    pub arrivals: Arrivals,
    /// Share of the newest packets that were bad, 0..1.
    pub bad_share: f64,
    /// Share of the newest commands that reached the robot damaged, 0..1; 0 where it does not tell, or had few.
    pub lost_share: f64,
    /// Newest round trip of a command in ms, if known.
    pub round_trip_ms: Option<f64>,
    /// Whether telemetry comes in a compact binary form.
    pub is_binary: bool,
}

/// What has come from the robot since the line was opened, as totals that wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrivals {
    /// Reports that are new and undamaged.
    pub reports: u32,
    /// Pieces that are nothing of the robot's.
    pub garbled: u32,
    /// Packets whose check sum is wrong.
    pub corrupted: u32,
    /// Reports with the time of the one before.
    pub repeated: u32,
    /// Reports whose time does not follow from those before.
    pub stray: u32,
    /// Jumps of the robot's clock.
    pub clock_jumps: u32,
}

impl Arrivals {
    /// What came after `earlier`.
    #[must_use]
    pub const fn since(self, earlier: Self) -> Self {
        Self {
            reports: self.reports.wrapping_sub(earlier.reports),
            garbled: self.garbled.wrapping_sub(earlier.garbled),
            corrupted: self.corrupted.wrapping_sub(earlier.corrupted),
            repeated: self.repeated.wrapping_sub(earlier.repeated),
            stray: self.stray.wrapping_sub(earlier.stray),
            clock_jumps: self.clock_jumps.wrapping_sub(earlier.clock_jumps),
        }
    }
}
